#pragma once
#include <array>
#include <vector>

#include "flow/gas/gas_flow.hpp"
#include "flow/piso/cut_flow.hpp"

namespace ejecta::gas {

/// What a step of gas does in the cells that solids cut, after the kernels have treated the whole grid as
/// gas. A carrier balances mass, momentum and energy over the fluid of itself and of the small cells it
/// carries,
///
///   V dU/dt = -sum A_f F - walls - U sum A_c u_s
///
/// A_f, A_c: open and closed parts of faces, F what passes the open ones, u_s the velocity of the solid; the
/// last term leaves alone what moves with the solid. Walls take pressure, with its work, and friction
/// (CutFlow). Small cells have the state of their carrier, and its pressure extended to them.
class CutGas {
 public:
  /// viscosity: Pa s
  CutGas(const Grid& grid, const GasConstants& gas, double viscosity);

  /// New cells. One that lost its gas to a carrier brings it along.
  void begin(const CutCells& cut, Block& u, Block& w, double dt);
  /// Part of a cell's volume whose gas it keeps: 1 in plain fluid, 0 in solids.
  Field& carried() { return flow_.carried_field(); }
  /// To be called after the carried field has been filled from elsewhere.
  void resume() { flow_.resume(); }

  /// Ghosts of the primitive variables, pressure apart, take what the stencils should see. eddy_viscosity:
  /// Pa s; null: laminar.
  void extend(const CutCells& cut, Block& w, const Field* eddy_viscosity);
  /// The pressure of small cells and of solids.
  void extend_pressure(const CutCells& cut, Field& p) {
    flow_.extend_to_small(cut, p.view());
    flow_.extend_to_solids(cut, p.view());
  }
  /// Sources of turbulence in carriers over dt by the law of the wall; `before`: k and e before any sources.
  void advance_turbulence(const CutCells& cut, bool sst, const Block& before, Block& w, Block& u,
                          Field& eddy_viscosity, Field& f1, Real dt);

  /// Remembers density and velocity of carriers, which the pressure's kernel would spoil, and what the
  /// pressure of `middle` makes of them within half a step.
  void keep(const CutCells& cut, const Block& middle);
  void push(const CutCells& cut, Block& middle, Real half_dt) const;

  /// Conserved values of carriers after dt: `flux` per area of the lower faces, from `start`; `middle` has
  /// the pressure. Of ghosts nothing changes.
  void balance(CutCells& cut, const std::array<Block, 3>& flux, const Block& start, const Block& middle,
               const Field* eddy_viscosity, Block& u, Block& w, Real dt);
  /// Ghosts at the end of a step, from the primitive variables of the cells that keep theirs.
  void settle(const CutCells& cut, const Field* eddy_viscosity, Block& u, Block& w);
  /// What the last step of dt gave to the gas: walls by their pressure and friction, and by moving surfaces
  /// its geometry, which begin() takes back as cells change.
  struct Given {
    Contents by_walls, displaced;
  };
  Given given(const CutCells& cut, const Block& start, double dt) const;

 private:
  void merge(const CutCells& cut, Block& u, Block& w);
  WallTurbulence turbulence_of(const Block& w, const Field* eddy_viscosity) const;

  const Grid& grid_;
  GasConstants gas_;
  Real viscosity_;
  CutFlow flow_;
  struct Kept {
    Real rho;
    std::array<Real, 3> u;
  };
  std::vector<Kept> kept_;         // of cut.cells
  std::vector<double> swept_;      // of cut.cells: volume that moving solids clear in a carrier, m3/s
  std::vector<Contents> shifted_;  // of cut.cells: what the movement of their middles gave in the last step
  std::vector<Real> scratch_;
};

}  // namespace ejecta::gas
