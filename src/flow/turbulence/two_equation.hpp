#pragma once
#include <array>
#include <vector>

#include "flow/boundary.hpp"
#include "flow/cut_cells.hpp"
#include "flow/increment_smoother.hpp"
#include "flow/turbulence/solid_distance.hpp"
#include "grid/grid.hpp"

namespace ejecta {

enum class TwoEquationModel { k_epsilon, k_omega_sst };
class GridWalls;

/// Transport of k and epsilon (or omega) with an incompressible flow, once a step: limited upwind convection
/// in time-centred (Lax-Wendroff) form, explicit diffusion, implicit sinks, so that both stay positive.
class TwoEquation {
 public:
  TwoEquation(const Grid& grid, TwoEquationModel model, bool round_jet_correction, double viscosity);

  void initialise(double k, double dissipation);
  void set_at(int i, int j, int k_index, double k, double dissipation);
  using WallDistance = std::array<std::vector<Real>, 3>;

  /// One step; u and q are the velocities at its end, with filled ghosts. dt = 0 only sets nu_t.
  void advance(const Boundaries& b, const std::array<ConstFieldView, 3>& u, const std::array<FieldView, 3>& q,
               const CutCells& cut, Real dt, const IncrementSmoother* smoother = nullptr);

  ConstFieldView eddy_viscosity() const { return nut_.view(); }
  const Field& k() const { return k_; }
  const Field& dissipation() const { return dissipation_; }
  /// Everything a resume needs.
  std::array<NamedField, 4> state() {
    return {{{"k", &k_}, {"e", &dissipation_}, {"eddy_viscosity", &nut_}, {"blending", &f1_}}};
  }

 private:
  void apply_walls(const GridWalls& walls);
  /// Cut cells: what passes their open faces, and walls with the law of the wall.
  void advance_cut_cells(const CutCells& cut, const std::array<ConstFieldView, 3>& u,
                         const std::array<FieldView, 3>& q, Real dt, bool increments);
  void finish_cut_cells(const CutCells& cut);
  void measure_walls(const Boundaries& b);

  const Grid& grid_;
  TwoEquationModel model_;
  bool round_jet_;
  Real nu_;
  Field k_, dissipation_, nut_, f1_, k_new_, dissipation_new_, nut_new_, f1_new_;
  std::array<bool, 6> is_wall_{};
  std::vector<Real> ghost_values_;  // scratch
  SolidDistance solid_distance_;    // SST
  WallDistance wall_distance_;      // to the nearest wall normal to each axis, m
};

}  // namespace ejecta
