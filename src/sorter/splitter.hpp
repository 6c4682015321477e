#pragma once
#include <optional>
#include <span>
#include <vector>

#include "case/case.hpp"
#include "dem/body.hpp"

namespace ejecta {

/// What became of a body.
struct Verdict {
  bool ejected = false;
  double clearance = 0.0;        ///< m, of the centre above the edge as it passes (negative: below)
  double velocity_margin = 0.0;  ///< m/s: gain of vertical velocity at the jet beyond what just clears the
                                 ///< edge, from the flight before the plate could touch the body
  double time = 0.0;             ///< s, of passing
  bool thrown_back = false;      ///< by the plate, and fallen below its edge
};

/// The dividing plate: its edge lies where the machine has it (`edge`, from the nozzle), or `distance` behind
/// the jet's axis and `height` above the path of the body that no air touches. Watches every body until its
/// centre passes the edge, or until the plate has thrown it back below the edge.
class Splitter {
 public:
  Splitter(const SplitterSpec& spec, const Vec3& nozzle, double undisturbed_height, double gravity_z);

  const Vec3& edge() const { return edge_; }
  static constexpr double kWidth = 1.0;  ///< m: the plate spans the belt and more
  /// The plate as bodies hit it: it lies level behind its edge.
  WallSpec wall() const;
  /// To be called after every step, with the positions before it and the time after it.
  void watch(std::span<const Body> bodies, std::span<const Vec3> before, double time, double dt);
  const std::optional<Verdict>& verdict(std::size_t body) const { return verdicts_.at(body); }
  /// m, of the centre above the edge had the body flown on as it came within its own size of the plate, which
  /// may have struck it since; nothing of a body that never came that way.
  std::optional<double> flight_clearance(std::size_t body) const;
  /// Of the bodies that are judged; false of none.
  bool all_passed() const;
  void resize(std::size_t bodies);
  /// A body that stays where it is never comes to the plate, and nobody waits for it.
  void leave_out(std::size_t body) { judged_.at(body) = false; }
  bool judges(std::size_t body) const { return judged_.at(body); }
  std::vector<double> state() const;
  void restore(std::span<const double> state);

 private:
  SplitterSpec spec_;
  Vec3 edge_;
  double from_jet_;  ///< m, from the jet's axis to the edge
  double gravity_z_;
  /// The free flight of a body as it came within its own size of the plate: what a plate that throws it back
  /// kept it from.
  struct Approach {
    double velocity = 0.0;   ///< m/s, along x
    double clearance = 0.0;  ///< m, of the centre above the edge, had it flown on
    bool near = false;       ///< has come within its own size of the plate
  };
  std::vector<Approach> approach_;
  std::vector<std::optional<Verdict>> verdicts_;
  std::vector<bool> judged_;
};

}  // namespace ejecta
