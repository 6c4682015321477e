#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/state_reader.hpp"
#include "base/text.hpp"
#include "case/case.hpp"
#include "jet/profile.hpp"

namespace ejecta {

class JetModel;

/// Height above the orifice at which an ejection box begins in the paper, m: where a jet is stored when
/// nobody asks for another plane.
inline constexpr double kBoxHeight = 40e-3;

/// The file of a jet, by name: the hash of everything the jet depends on (what its case changes of the
/// defaults, without title and outputs; the valve's trace; height, precision, version of the numerics).
std::string jet_file_name(const Case& jet, double height);
/// The same in the cache of the user.
std::filesystem::path jet_file(const Case& jet, double height);
/// The same in the folder "jets" beside the case: jets that come with it, which nothing writes or clears.
std::filesystem::path shipped_jet_file(const Case& jet, double height);

/// Profile of the jet across the plane at which an ejection box begins. Its velocities are those of air of
/// ambient density with the momentum of the jet: w sqrt(rho/rho_a).
JetProfile::Moment profile_moment(const JetModel& jet, double height, const std::vector<double>& radii);

/// Collects the profile of a running jet at the plane `height`, every 50 us and at the valve's events.
class ProfileRecorder {
 public:
  ProfileRecorder(const JetModel& jet, double height);
  void advance(const JetModel& jet);
  const JetProfile& profile() const { return profile_; }
  void save(std::vector<double>& out) const;
  void load(StateReader& in);

 private:
  JetProfile profile_;
  double next_ = 0.0;
};

/// The jet of a case at a plane: the one that comes with the case, else from the cache, else computed and
/// stored. A damaged file is named through `note` and passed over.
JetProfile stored_or_computed_jet(const Case& jet, double height, const Note& note);

}  // namespace ejecta
