#pragma once
#include "flow/gas/gas_flow.hpp"

namespace ejecta::gas {

/// Compressible flow, explicit in time: finite volumes, MUSCL, HLLC with a cure for the carbuncle, SSP
/// Runge-Kutta (Gottlieb, Shu & Tadmor 2001).
class Solver : public GasFlow {
 public:
  Solver(const Grid& grid, const Options& options) : GasFlow(grid, options), start_(make_block(grid)) {}

  /// courant / max over cells of sum over axes of (|u| + c)/h + 2 nu/h^2
  double stable_dt(double courant) override;
  using GasFlow::advance;
  void advance(double dt, CutCells& solids) override;  ///< knows no solids: there must be none

 private:
  template <class P>
  void run_stages(double dt);
  /// Anew through the faces of the box where walls are (WallConvection).
  template <class P>
  void wall_fluxes();
  Block start_;
};

}  // namespace ejecta::gas
