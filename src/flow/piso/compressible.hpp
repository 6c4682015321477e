#pragma once
#include <optional>

#include "flow/gas/gas_flow.hpp"
#include "flow/increment_smoother.hpp"
#include "flow/piso/acoustic.hpp"
#include "flow/piso/cut_gas.hpp"
#include "flow/piso/gas_grains.hpp"

namespace ejecta::gas {

/// Compressible flow at the pace of the flow, for Mach numbers up to about 0.8: a step is limited by |u|
/// alone. One step, conservative and centred in time:
///
///   w*      = w - dt/2 u grad w + diffusion         Hancock's predictor, without the pressure
///   q, dp   = implicit in sound                     one Helmholtz equation (Acoustic)
///   w_mid   = w* - dt/2 grad(p* + dp)/rho
///   U      += -dt div(q U_up + pressure - viscous)  the fluxes of w_mid
///
/// Splitting of the pressure from what is carried: Kwatra et al. 2009 (J. Comput. Phys. 228:4146); predictor
/// and one implicit solve for the velocities of the faces: Bell, Colella & Glaz 1989 (J. Comput. Phys.
/// 85:257).
class Compressible : public GasFlow {
 public:
  Compressible(const Grid& grid, const Options& options);

  /// courant / max over cells of sum over axes of |u|/h, with the speed that the present pressure, or as much
  /// as acted in the last step, can add; laminar: and 2 nu/h^2
  double stable_dt(double courant) override;
  using GasFlow::advance;
  void advance(double dt, CutCells& cut) override;
  void expect_grains(double density) override { grains_.emplace(grid_, gas_, density); }
  /// Where no body cuts cells grains take room of the gas; else they drag it alone.
  void advance(double dt, CutCells& cut, FluidFraction& grains) override;
  std::vector<NamedField> state() override;
  std::vector<double*> state_numbers() override;
  void resume() override;
  int iterations() const { return acoustic_.iterations(); }  ///< of the last step's pressure equation

 private:
  template <class P>
  void step(double dt, CutCells& cut);
  void fill_ghosts(Block& w) const;
  /// What crosses the faces in a step, from its middle.
  template <class P>
  void find_fluxes();
  void find_results(FluidFraction& f);
  void book_grains(const FluidFraction& f, double dt);
  void measure_growth();
  void smooth_increments(double dt, bool across, const CutCells& cut);
  bool takes_room() const { return fraction_ && in_room_ > 0.0; }  ///< grains, in this step
  const Field* eddies() const { return turbulent() ? &eddy_viscosity_ : nullptr; }
  Acoustic acoustic_;
  CutGas cut_gas_;
  std::optional<GasGrains> grains_;
  FluidFraction* fraction_ = nullptr;  // of the grains that act in this step
  double in_room_ = 0.0;               // 1: the gas is what grains leave of cells
  IncrementSmoother smoother_;
  Block start_, middle_;
  bool had_solids_ = true;
  double growth_ = 0.0;  ///< 1/s, rate of GrowthKernel after the last step; negative: not known yet
  double largest_nu_ = 0.0, explicit_dt_ = 1e300;  ///< m2/s, s: of the last stable_dt()
};

}  // namespace ejecta::gas
