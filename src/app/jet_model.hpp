#pragma once
#include <memory>
#include <vector>

#include "app/jet_drive.hpp"
#include "base/clock.hpp"
#include "case/case.hpp"
#include "flow/godunov/from_case.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// What the air does at a point of a jet.
struct JetSample {
  Vec3 velocity{0, 0, 0};    ///< m/s
  double pressure = 0.0;     ///< Pa absolute, static
  double density = 0.0;      ///< kg/m3
  double temperature = 0.0;  ///< K
  double mach = 0.0;
  double k = 0.0, epsilon = 0.0;
  double total_gauge = 0.0;  ///< Pa above ambient: isentropic stagnation of the axial flow
  double pitot_gauge = 0.0;  ///< Pa above ambient: what a Pitot tube along the axis reads (behind its shock)
};

/// Flow of one conserved quantity through a plane across the jet.
struct JetFlow {
  double mass = 0.0;      ///< kg/s
  double momentum = 0.0;  ///< N: of rho w^2 + (p - pa) less the axial stress
};

/// The jet of a valve computed from its orifice: the compressible solver of a case whose boundary has a patch
/// of type "jet", driven by the valve.
class JetModel {
 public:
  /// Throws InputError when the case has no compressible jet, the supply cannot blow, or the orifice is not
  /// resolved by the grid.
  explicit JetModel(const Case& c);

  double time() const { return clock_.time(); }
  std::int64_t steps() const { return clock_.step(); }
  Clock& clock() { return clock_; }
  /// Advances by one stable step that does not pass the next event; returns it, s.
  double step();

  JetSample sample(const Vec3& position) const;
  /// Through the z-plane of lower face k, whole jet (symmetry planes and the axis made up for).
  JetFlow through(int k) const;
  /// Through the cells of the orifice alone.
  JetFlow orifice_flow() const;
  /// Exact one-dimensional state the orifice should have now.
  NozzleExit ideal_exit() const { return drive_.exit(time()); }

  const Grid& grid() const { return grid_; }
  const Case& scenario() const { return case_; }
  const Valve& valve() const { return drive_.valve(); }
  const godunov::Solver& solver() const { return *solver_; }
  double ambient_pressure() const { return case_.environment.pressure; }
  double orifice_diameter() const { return case_.valve.orifice_diameter; }
  double cells_across_orifice() const;
  /// Share of the jet inside the box is 1/fold: 4 for a quarter domain.
  double fold() const { return fold_; }

 private:
  JetFlow sum_flow(int k, double within) const;
  Case case_;
  Grid grid_;
  JetDrive drive_;
  Gas gas_;
  std::vector<godunov::DrivenInlet> inlets_;
  std::unique_ptr<godunov::Solver> solver_;
  Clock clock_;
  double fold_ = 1.0;
};

}  // namespace ejecta
