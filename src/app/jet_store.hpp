#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "case/case.hpp"
#include "sorter/jet_profile.hpp"

namespace ejecta {

class JetModel;

/// Height above the orifice at which an ejection box begins in the paper, m: where a jet is stored when
/// nobody asks for another plane.
inline constexpr double kBoxHeight = 40e-3;

/// The file of a jet in the cache: its name is the hash of everything the jet depends on (case without its
/// title and outputs, height, precision, version of the numerics).
std::filesystem::path jet_file(const Case& jet, double height);

/// Collects the profile of a running jet at the plane `height`, every 50 us and at the valve's events.
class ProfileRecorder {
 public:
  ProfileRecorder(const JetModel& jet, double height);
  void advance(const JetModel& jet);
  const JetProfile& profile() const { return profile_; }

 private:
  JetProfile profile_;
  double next_ = 0.0;
};

/// The jet of a case at a plane: from the cache, else computed and stored. A damaged file is named through
/// `note` and computed again.
JetProfile stored_or_computed_jet(const Case& jet, double height,
                                  const std::function<void(const std::string&)>& note);

}  // namespace ejecta
