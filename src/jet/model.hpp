#pragma once
#include <memory>
#include <vector>

#include "base/clock.hpp"
#include "case/case.hpp"
#include "flow/ideal_gas.hpp"
#include "grid/grid.hpp"
#include "jet/air.hpp"
#include "jet/drive.hpp"

namespace ejecta {

/// What the air does at a point of a jet.
struct JetSample : JetPoint {
  double temperature = 0.0;  ///< K
  double mach = 0.0;         ///< incompressible: on the speed of sound of the ambient
  double total_gauge = 0.0;  ///< Pa above ambient: isentropic stagnation of the axial flow
  double pitot_gauge = 0.0;  ///< Pa above ambient: what a Pitot tube along the axis reads (behind its shock)
};

/// The case; throws InputError when it is none of such a jet (see JetModel). Computes nothing.
const Case& require_jet_case(const Case& c);

/// The jet of a valve computed from its orifice, a patch of type "jet" on the lower z-face, and driven by the
/// valve: compressible, or incompressible at the momentum-equivalent velocity.
class JetModel {
 public:
  /// Throws InputError when the case has no such jet, the supply cannot blow, or the orifice is not the one
  /// of the valve.
  explicit JetModel(const Case& c);
  JetModel(const JetModel&) = delete;  // the air refers to case and grid
  JetModel& operator=(const JetModel&) = delete;

  double time() const { return time_; }  ///< s
  /// The longest stable step from `time` on, s.
  double stable_dt(double time);
  void advance(const Step& step);
  /// What the steps must land on: the valve's events and the end.
  Clock clock() const;
  /// Advances by one step of the clock.
  Step step(Clock& clock);

  JetSample sample(const Vec3& position) const;
  /// Through the z-plane of lower face k, whole jet (symmetry planes and the axis made up for).
  JetFlow through(int k) const;
  /// Through the cells of the orifice alone.
  JetFlow orifice_flow() const;
  /// Exact one-dimensional state the orifice should have now.
  NozzleExit ideal_exit() const { return drive_.orifice(time()); }

  JetAir& air() { return *air_; }
  const JetAir& air() const { return *air_; }
  /// Takes the air back to what its fields hold.
  void restore(std::span<const double> numbers, double time);

  const Grid& grid() const { return grid_; }
  const Case& scenario() const { return case_; }
  const Valve& valve() const { return drive_.valve(); }
  double ambient_pressure() const { return case_.environment.pressure; }
  double orifice_diameter() const { return case_.valve.orifice_diameter; }
  double cells_across_orifice() const;
  /// Whole jet over the part inside the box: 4 for a quarter domain, 2 pi for the wedge of one radian.
  double whole_jet() const { return whole_jet_; }

 private:
  JetFlow sum_flow(int k, double within) const;
  Case case_;
  Grid grid_;
  JetDrive drive_;
  Gas gas_;
  PatchSpec orifice_;
  std::unique_ptr<JetAir> air_;
  double whole_jet_ = 1.0, time_ = 0.0;
};

}  // namespace ejecta
