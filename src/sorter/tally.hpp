#pragma once
#include <array>
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// What became of a particle, and why.
enum class Fate {
  ejected,              ///< rightly
  kept,                 ///< rightly
  missed_not_seen,      ///< to be ejected, and not: the camera made nothing of it
  missed_misread,       ///< read as to be kept
  missed_agglomerated,  ///< with others in one object, which was read as to be kept or shot at another place
  missed_dead_valve,    ///< the valves that are dead would have done it
  missed_late,          ///< it did not come when and where it was seen to come
  missed_pushed,        ///< others, near it in the air, pushed it or took its air
  missed_struck_plate,  ///< its body met the edge of the plate
  missed_too_weak,      ///< shot at as it should be, and not lifted enough
  taken_pushed,         ///< to be kept, and pushed over the plate by another body
  taken_in_window,      ///< to be kept, and ejected by a shot at another
  taken_misread,        ///< read as to be ejected
  taken_agglomerated    ///< in one object with one to be ejected
};
inline constexpr std::size_t kFates = 14;
const char* word(Fate fate);
inline bool goes_to_ejects(Fate f) { return f == Fate::ejected || f >= Fate::taken_pushed; }

/// Of a piece of the belt, or of all of it.
struct Tally {
  struct Kind {
    std::array<double, kFates> number{}, mass{};  ///< by fate; kg
    double alone = 0.0;                           ///< particles with no other within the camera's gap
    double alone_seen = 0.0;                      ///< whose object is theirs alone
    double area = 0.0;                            ///< m2, of outlines from above
    double slipping = 0.0;                        ///< particles that slip on the belt as they are seen
    double met = 0.0;                             ///< particles that touched another in the air
    double in_another = 0.0;                      ///< that lay in another as they came, and flew as if alone
    double late_squares = 0.0;  ///< s2, of how much later than it was seen to come each comes
  };
  std::vector<Kind> kinds;
  double length = 0.0;  ///< m, of belt
  double objects = 0.0, shots = 0.0;
  double openings = 0.0, air = 0.0;  ///< of valves; kg
  double cut = 0.0;                  ///< objects longer than what is looked at in one piece

  void add(const Tally& other);
  double number(std::size_t kind) const;
  double mass(std::size_t kind) const;
  std::vector<double> values() const;
  static Tally of_values(const std::vector<double>& values, std::size_t kinds);
};

/// A share with its interval of 95 %.
struct Share {
  double value = 0.0, low = 0.0, high = 1.0;
  bool known = false;  ///< false: of nothing
};

/// Sums of what a share is made of over the pieces of the belt: neighbours share their fate, so that the
/// scatter from piece to piece, not the number of particles, says how sure it is.
struct ShareSums {
  double a = 0.0, b = 0.0, aa = 0.0, ab = 0.0, bb = 0.0, pieces = 0.0;
  double count = 0.0;  ///< particles in b
  void add(double part, double whole, double particles);
  /// a/b with Wilson's interval (1927) for as many independent particles as the scatter of the pieces allows,
  /// widened by Student's factor for few pieces; of one piece 0 to 1.
  Share share() const;
};

/// All the sums of a sorter's products.
struct Products {
  Tally total;
  enum Ratio : std::size_t {
    recovery,
    purity,
    loss,
    recovery_mass,
    purity_mass,
    loss_mass,
    yield_mass,
    alone,
    alone_seen,
    ratios
  };
  std::array<ShareSums, ratios> sums;
  void add(const Tally& piece, const std::vector<ParticleClassSpec>& classes);
};

}  // namespace ejecta
