#pragma once
#include <array>
#include <vector>

#include "flow/cut_cells.hpp"
#include "flow/fluid_fraction.hpp"
#include "flow/gas/boundary.hpp"
#include "flow/gas/flux_kernel.hpp"
#include "flow/gas/geometry.hpp"
#include "flow/gas/turbulence_kernel.hpp"
#include "flow/turbulence/solid_distance.hpp"
#include "grid/faces.hpp"

namespace ejecta::gas {

/// What the compressible solver is asked to solve.
struct Options {
  Gas gas;
  double reference_pressure = 0.0;  ///< Pa, that of the gas at rest (see state.hpp)
  double viscosity = 0.0;           ///< Pa s, dynamic; 0: inviscid
  double prandtl = 0.71, prandtl_turbulent = 0.9;
  TurbulenceModel turbulence = TurbulenceModel::laminar;
  bool round_jet_correction = true, compressibility_correction = true;
  bool keep_ledger = false;  ///< sum up what crosses the boundaries
  int stages = 2;            ///< Godunov. 2: Heun's method, 3: third order (both strong-stability preserving)
};

/// What gas holds.
struct Contents {
  double mass = 0.0;       ///< kg
  Vec3 momentum{0, 0, 0};  ///< N s
  double energy = 0.0;     ///< J

  Contents& operator+=(const Contents& o) {
    mass += o.mass;
    momentum += o.momentum;
    energy += o.energy;
    return *this;
  }
  Contents operator-(const Contents& o) const {
    return {mass - o.mass, momentum - o.momentum, energy - o.energy};
  }
};

/// What has entered through the boundaries since the start (axisymmetric: the full circle). Momentum counts
/// the pressure from the reference.
struct BoundaryLedger {
  double mass = 0.0;                 ///< kg
  double mass_inward = 0.0;          ///< kg, inflow alone
  double energy = 0.0;               ///< J
  Vec3 momentum{0, 0, 0};            ///< N s
  Vec3 momentum_of_solids{0, 0, 0};  ///< N s, what solids in the flow gave it
  double work_of_solids = 0.0;       ///< J
  Contents displaced;  ///< what the geometry of solids put into the sums; first of all, their own volume
};

/// Compressible flow of an ideal gas in conservative finite volumes, on Cartesian and axisymmetric grids: the
/// state, its boundaries, fluxes, sources of turbulence and ledger, which every solver shares. A solver says
/// how far and how a step goes.
class GasFlow {
 public:
  virtual ~GasFlow() = default;
  GasFlow(const GasFlow&) = delete;
  GasFlow& operator=(const GasFlow&) = delete;

  Boundaries& boundaries() { return boundaries_; }
  const Grid& grid() const { return grid_; }
  const Options& options() const { return options_; }

  /// Initial state of a cell. `e` is epsilon or omega.
  void set(int i, int j, int k, const GasState& state);
  GasState at(int i, int j, int k) const;

  /// Largest stable step for a Courant number, s. Throws DivergedError with place and state when a cell holds
  /// no number.
  virtual double stable_dt(double courant) = 0;
  /// One step, around `solids`.
  virtual void advance(double dt, CutCells& solids) = 0;
  /// The same with grains smaller than a cell among them, after expect_grains(). Throws Error where the
  /// solver knows none.
  virtual void advance(double dt, CutCells& solids, FluidFraction& grains);
  /// density: kg/m3, with which their FluidFraction is normalised.
  virtual void expect_grains(double density);
  /// One step without solids.
  void advance(double dt) { advance(dt, no_solids_); }

  /// False as soon as a cell holds what no gas can be, or eddies faster than sound; `where` gets the first
  /// such.
  bool finite(Vec3* where = nullptr) const;
  /// Integral of a conserved component over the gas in the box (axisymmetric: the full circle).
  double total(Component c) const;
  Contents contents() const;
  /// Part of every cell's volume whose gas it keeps: solids have none. Origin null: all of it.
  ConstFieldView part() const { return part_ ? part_->view() : ConstFieldView{}; }
  /// Primitive variables with ghosts, pressure relative to the reference.
  const Block& primitive() const { return w_; }
  /// Fluxes per area of the last stage through the lower faces along x (0), y (1) or z (2), pressure counted
  /// from the reference.
  const Block& flux(int axis) const { return flux_[static_cast<std::size_t>(axis)]; }
  const Field& eddy_viscosity() const { return eddy_viscosity_; }  ///< Pa s
  void keep_ledger() { options_.keep_ledger = true; }
  const BoundaryLedger& ledger() const { return ledger_; }
  BoundaryLedger& ledger() { return ledger_; }
  /// Everything a resume needs besides the ledger.
  virtual std::vector<NamedField> state();
  virtual std::vector<double*> state_numbers() { return {}; }
  /// To be called after `state()` has been filled again.
  virtual void resume() {}

 protected:
  GasFlow(const Grid& grid, const Options& options);
  static Block make_block(const Grid& grid);
  std::array<AxisLengths, 3> axes() const {
    return {geometry_.axis(0), geometry_.axis(1), geometry_.axis(2)};
  }
  bool turbulent() const { return options_.turbulence != TurbulenceModel::laminar; }
  /// visit(Physics<...>{}) with what this flow carries.
  template <class Visit>
  void with_physics(const Visit& visit) const {
    const bool across = grid_.active(1);
    if (turbulent()) across ? visit(Physics<true, true, true>{}) : visit(Physics<true, true, false>{});
    else if (options_.viscosity > 0.0)
      across ? visit(Physics<true, false, true>{}) : visit(Physics<true, false, false>{});
    else across ? visit(Physics<false, false, true>{}) : visit(Physics<false, false, false>{});
  }
  /// As below, of the faces in a range across axis D alone.
  template <int D, class P, class Convection>
  void sweep(const Range3& faces, const Block& primitive, const Convection& convection);
  /// flux_ = what `convection` and diffusion carry through every face, from primitive variables with ghosts.
  template <class P, class Convection>
  void fluxes(const Block& primitive, const Convection& convection);
  /// k, e and the eddy viscosity after their sources over dt.
  void advance_turbulence(double dt, const Dilatation& dilatation, const CutCells& cut);
  void add_to_ledger(double seconds, const CutCells& cut);
  /// Throws DivergedError that names a cell which is no gas.
  [[noreturn]] void report_divergence() const;

  const Grid& grid_;
  Options options_;
  GasConstants gas_;
  Diffusion diffusion_;
  Geometry geometry_;
  Boundaries boundaries_;
  Block u_, w_, next_;  ///< conserved; primitive; scratch of the primitive ones
  std::array<Block, 3> flux_;
  Field eddy_viscosity_, f1_;
  const Field* part_ = nullptr;  ///< of part(), that of a solver which knows solids

 private:
  template <bool Sst, bool RoundJet>
  void run_turbulence(double dt, const Dilatation& dilatation);
  template <bool Sst>
  void apply_walls(Real dt);
  void set_turbulence_constants();
  void measure_walls();
  std::array<bool, 6> has_law_of_wall_{};  ///< beside the edge of a disc it is the jet that shears
  std::array<std::vector<Real>, 3> wall_distance_;
  SolidDistance solid_distance_;  ///< SST
  bool started_ = false;
  BoundaryLedger ledger_;
  CutCells no_solids_;
};

template <int D, class P, class Convection>
void GasFlow::sweep(const Range3& faces, const Block& primitive, const Convection& convection) {
  for_each_cell(faces, FluxKernel<D, P, Convection>{view_block<const Real>(primitive),
                                                    view_block<Real>(flux_[D]), eddy_viscosity_.view().origin,
                                                    f1_.view().origin, gas_, diffusion_, axes(), convection});
}

template <class P, class Convection>
void GasFlow::fluxes(const Block& primitive, const Convection& convection) {
  if (grid_.active(0)) sweep<0, P>(faces_along(grid_, 0), primitive, convection);
  if constexpr (P::across) sweep<1, P>(faces_along(grid_, 1), primitive, convection);
  if (grid_.active(2)) sweep<2, P>(faces_along(grid_, 2), primitive, convection);
}

}  // namespace ejecta::gas
