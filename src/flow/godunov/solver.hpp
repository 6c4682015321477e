#pragma once
#include <memory>

#include "flow/godunov/boundary.hpp"
#include "flow/godunov/flux_kernel.hpp"
#include "flow/godunov/geometry.hpp"

namespace ejecta::godunov {

/// What the compressible solver is asked to solve.
struct Options {
  Gas gas;
  double reference_pressure = 0.0;  ///< Pa, that of the gas at rest (see state.hpp)
  double viscosity = 0.0;           ///< Pa s, dynamic; 0: inviscid
  double prandtl = 0.71, prandtl_turbulent = 0.9;
  TurbulenceModel turbulence = TurbulenceModel::laminar;
  bool round_jet_correction = true, compressibility_correction = true;
  bool keep_ledger = false;  ///< sum up what crosses the boundaries
  int stages = 2;            ///< 2: Heun's method, 3: third order (both strong-stability preserving)
};

/// What has entered through the boundaries since the start (axisymmetric: the full circle). Momentum counts
/// the pressure from the reference.
struct BoundaryLedger {
  double mass = 0.0;         ///< kg
  double mass_inward = 0.0;  ///< kg, inflow alone
  double energy = 0.0;       ///< J
  Vec3 momentum{0, 0, 0};    ///< N s
};

/// Compressible flow of an ideal gas, explicit in time: finite volumes, MUSCL, HLLC with a cure for the
/// carbuncle, SSP Runge-Kutta (Gottlieb, Shu & Tadmor 2001), on Cartesian and axisymmetric grids.
class Solver {
 public:
  Solver(const Grid& grid, const Options& options);

  Boundaries& boundaries() { return boundaries_; }
  const Grid& grid() const { return grid_; }
  const Options& options() const { return options_; }

  /// Initial state of a cell. `e` is epsilon or omega.
  void set(int i, int j, int k, const GasState& state);
  GasState at(int i, int j, int k) const;

  /// Largest stable step: courant / max over cells of sum over axes of (|u| + c)/h + 2 nu/h^2. Throws
  /// DivergedError with place and state when a cell holds no number.
  double stable_dt(double courant) const;
  /// One step of all stages. Allocates nothing.
  void advance(double dt);

  /// Integral of a conserved component over the box (axisymmetric: the full circle).
  double total(Component c) const;
  /// Primitive variables with ghosts, pressure relative to the reference.
  const Block& primitive() const { return w_; }
  /// Fluxes per area of the last stage through the lower faces along x (0) or z (2), pressure counted from
  /// the reference.
  const Block& flux(int axis) const { return axis == 0 ? fx_ : axis == 1 ? fy_ : fz_; }
  const Field& eddy_viscosity() const { return eddy_viscosity_; }  ///< Pa s
  void keep_ledger() { options_.keep_ledger = true; }
  const BoundaryLedger& ledger() const { return ledger_; }
  BoundaryLedger& ledger() { return ledger_; }
  /// Everything a resume needs besides the ledger.
  std::vector<Field*> state();

 private:
  template <class P>
  void run_stages(double dt);
  template <class P>
  void fluxes();
  void add_to_ledger(double seconds);
  template <bool Sst, bool RoundJet>
  void turbulence(double dt);
  void set_turbulence_constants();
  void measure_walls();
  const Grid& grid_;
  Options options_;
  GasConstants gas_;
  Diffusion diffusion_;
  Geometry geometry_;
  Boundaries boundaries_;
  Block u_, start_, w_, next_, fx_, fy_, fz_;
  Field eddy_viscosity_, f1_;
  std::array<std::vector<Real>, 3> wall_distance_;
  bool started_ = false;
  BoundaryLedger ledger_;
};

}  // namespace ejecta::godunov
