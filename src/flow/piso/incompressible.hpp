#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "flow/boundary.hpp"
#include "flow/cut_cells.hpp"
#include "flow/fluid_fraction.hpp"
#include "flow/increment_smoother.hpp"
#include "flow/piso/cut_flow.hpp"
#include "flow/piso/cut_pressure.hpp"
#include "flow/piso/fraction_step.hpp"
#include "flow/piso/momentum.hpp"
#include "flow/poisson/fast_diagonal.hpp"
#include "flow/turbulence/two_equation.hpp"
#include "grid/grid.hpp"

namespace ejecta {

struct IncompressibleSetup {
  double density = 1.2;                        ///< kg/m3
  double viscosity = 1.5e-5;                   ///< m2/s, kinematic
  std::optional<TwoEquationModel> turbulence;  ///< empty: laminar
  bool round_jet_correction = true;
  int corrections = 2;         ///< pressure corrections a step, at least 2
  Vec3 acceleration{0, 0, 0};  ///< m/s2
  /// Manufactured momentum source (position, time) -> m/s2; empty: none.
  std::function<Vec3(const Vec3&, double)> source;
};

/// Seconds spent in each operator since construction.
struct FlowTimes {
  double boundaries = 0, momentum = 0, faces = 0, pressure = 0, correction = 0, turbulence = 0, ledger = 0;
};

/// Totals of the fluid in the box, times density: kg m/s, and what crossed its boundaries, for the ledger.
struct FlowLedger {
  Vec3 momentum_through_boundaries{0, 0, 0};  ///< N s since construction, positive into the box
  double mass_through_boundaries = 0;         ///< kg since construction, net, positive into the box
  double mass_in = 0;                         ///< kg since construction, what came in
  Vec3 impulse_on_solids{0, 0, 0};            ///< N s
  /// N s, what moving solids take from and add to the fluid in the box by changing its volume cell by cell:
  /// the error of their geometry in time, but for what the first step takes out where solids stand.
  Vec3 displaced{0, 0, 0};
};

/// Incompressible flow by PISO (Issa 1986) on a collocated graded grid. One step:
///
///   stage 1:  u*  = u + dt N(u)                        N = -div(q u) + div(2 nu S) - grad p + g
///             u1  = project(force(u*))                  first pressure correction
///   stage 2:  u** = (u + u1 + dt N(u1)) / 2             H(u) of Issa evaluated again with the corrected
///   velocity
///             u'  = project(force(u**))                 second pressure correction (more: repeated here)
///
/// which is Heun's method: second order in time, stable to a Courant number of 1. Solids cut cells
/// (cut_flow.hpp): the corrections know the open part of every face, so that nothing ever passes a surface.
class Incompressible {
 public:
  Incompressible(const Grid& grid, std::array<Boundary, 6> boundaries, const IncompressibleSetup& setup);

  /// Sets velocity and p / rho everywhere, then makes the velocity divergence-free.
  void initialise(const std::function<Vec3(const Vec3&)>& velocity,
                  const std::function<double(const Vec3&)>& pressure, double time);
  /// The largest step for a Courant number (sum over directions of |u| dt / h, Eq. 6 of the paper) and for
  /// the explicit viscous terms; after a step of `last_dt`, also with what u gains if it accelerates as it
  /// did in that one (dt (r + g dt) = courant), and at most `most` times as long. NaN where the flow holds
  /// one.
  double stable_dt(double courant, double last_dt = 0.0, double most = 2.0);
  /// The same before anything has moved: what pressure, forces and boundaries will do is tried.
  double first_step(double time, double courant, double longest);
  /// The Courant number that a step without solids would reach; the flow stays as it is.
  double try_step(double time, double dt);
  double courant(double dt) const;
  void advance(double time, double dt, CutCells& cut);
  /// The same with grains in the fluid (model A). Where bodies are in it too, grains drag it but take none of
  /// its room. Fills the results of `grains`.
  void advance(double time, double dt, CutCells& cut, FluidFraction& grains);

  std::array<ConstFieldView, 3> velocity() const { return {u_[0].view(), u_[1].view(), u_[2].view()}; }
  const Field& velocity_field(int c) const { return u_[static_cast<std::size_t>(c)]; }
  const Field& pressure_field() const { return p_; }  ///< p / rho, m2/s2
  const TwoEquation* turbulence() const { return turbulence_.get(); }
  TwoEquation* turbulence() { return turbulence_.get(); }
  const Boundaries& boundaries() const { return boundaries_; }
  const IncompressibleSetup& setup() const { return setup_; }
  const Grid& grid() const { return grid_; }

  double largest_divergence(const CutCells& cut);
  /// Of grains: N s, what the fluid gave them in the last step by drag, pressure and friction.
  /// Sums over the fluid count it as a part of the cells from now on.
  void set_fraction(const FluidFraction& f) { fraction_ = f.acts ? &f : nullptr; }
  const Vec3& impulse_on_grains() const { return impulse_on_grains_; }
  /// Iterations of the last pressure equation with grains.
  int fraction_iterations() const { return fraction_step_ ? fraction_step_->iterations() : 0; }
  Vec3 momentum() const;  ///< kg m/s in the box (axisymmetric: per radian)
  double kinetic_energy() const;
  const FlowTimes& times() const { return times_; }
  const FlowLedger& ledger() const { return ledger_; }
  FlowLedger& ledger() { return ledger_; }
  /// False as soon as any velocity is not finite; `where` gets the first such cell.
  bool finite(Vec3* where = nullptr) const;
  /// To be called after `state()` has been filled again: brings boundary states to `time`, and what is read
  /// off it.
  void resume(double time) {
    boundaries_.update(time);
    cut_flow_.resume();
    superficial_ = true;  // where there were grains; else it does not matter
  }
  /// Everything a resume needs.
  std::vector<NamedField> state();

 private:
  /// What each of the two stages of Heun's method counts in a step.
  static constexpr double kStageWeight = 0.5;
  MomentumTerms momentum_terms();
  void advance_through_grains(double time, double dt, CutCells& cut, FluidFraction& f);
  BoundaryFlow predict_increment(double time, double h);
  void make_superficial(FluidFraction& f);
  void drag_cells(double h);
  void find_results(FluidFraction& f);
  void gather_momentum(FluidFraction& f, double h, bool first);
  void book_grains(const FluidFraction& f, double dt);
  void book_through(const BoundaryFlow& through, double dt);
  BoundaryFlow predict(double a, double b, double time, Real dt, CutCells& cut, double weight);
  void move_displaced(const Vec3& momentum) { ledger_.displaced += setup_.density * momentum; }
  WallTurbulence wall_turbulence() const;
  void correct(const CutCells& cut, Real dt);
  /// Throws where boundaries push fluid into a part of the box that has no open face.
  void refuse_sealed(const CutCells& cut) const;
  void book_boundaries(const BoundaryFlow& through, double dt);
  void book_pressure(ConstFieldView p, double weight, double dt);
  void evaluate_source(double time);
  std::array<FieldView, 3> views(std::array<Field, 3>& f);
  std::array<ConstFieldView, 3> views(const std::array<Field, 3>& f) const;

  const Grid& grid_;
  IncompressibleSetup setup_;
  Boundaries boundaries_;
  FastDiagonalPoisson poisson_;
  CutFlow cut_flow_;
  CutPressure cut_pressure_;
  std::unique_ptr<TwoEquation> turbulence_;
  std::array<Field, 3> u_, u_star_, q_, source_;
  std::array<Field, 3> u_old_;  // velocity at the beginning of the step, also after it (stable_dt)
  Field p_, phi_;
  IncrementSmoother smoother_;
  bool smoothing_ = false;
  Real filter_time_ = Real(1e30);                       // s, of the pressure
  double explicit_dt_ = 1e300, largest_viscosity_ = 0;  // of the last stable_dt()
  double convection_ = -1;                              // largest sum |u| / h, 1/s; negative: not known
  std::vector<BoundaryFlow> boundary_sums_;             // scratch
  double box_volume_ = 0;
  std::unique_ptr<FractionStep> fraction_step_;  // once there are grains
  FluidFraction* grains_ = nullptr;              // that drag the fluid in this step
  const FluidFraction* fraction_ = nullptr;      // of which the fluid is a part since the last step
  bool superficial_ = false;                     // q_ is that of the fluid times its fraction
  double fraction_dt_ = 0;
  Vec3 impulse_on_grains_{0, 0, 0};
  FlowTimes times_;
  FlowLedger ledger_;
};

}  // namespace ejecta
