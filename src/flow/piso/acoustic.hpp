#pragma once
#include "flow/cut_cells.hpp"
#include "flow/gas/boundary.hpp"
#include "flow/gas/geometry.hpp"
#include "flow/piso/gas_grains.hpp"

namespace ejecta::gas {

/// The implicit part of a step of the compressible PISO. From the middle of the step as flow and friction
/// alone make it, velocities q of the faces and the change dp of the pressure such that
///
///   q  = mean(u) - dt/2 grad p / rho - dt grad dp / rho,      dp = -dt K div q,      K = gamma p_ref +
///   (gamma - 1) p'
///
/// The flow is centred in the step, sound is implicit (Euler backward in its own change alone): where
/// pressure only travels with the flow dp is zero and nothing is damped. On a boundary q = q0 + admittance
/// dp: none where the velocity is given, half a cell of gas where the pressure is, 1/(rho c) where sound
/// leaves.
class Acoustic {
 public:
  Acoustic(const Grid& grid, const GasConstants& gas);

  /// `middle`: primitive variables with ghosts. Conjugate gradients from the change of the step before. Of
  /// faces that solids close in part `velocity` is that of the gas through their open part, of closed ones
  /// that of the solid. Small cells share the change of their carrier. `grains` that take room; null: none.
  /// Allocates nothing once it has met as many faces.
  void solve(const Boundaries& boundaries, const Block& middle, double dt, const CutCells& cut,
             const GasGrains* grains = nullptr);

  /// Ghost pressures of the finished middle on transmissive faces, such that the mean with the cell inside is
  /// the pressure of a wave that leaves.
  void let_waves_out(const Boundaries& boundaries, Block& middle) const;

  const Field& velocity(int axis) const { return velocity_[static_cast<std::size_t>(axis)]; }  ///< m/s
  const Field& change() const { return change_; }  ///< dp, Pa; one layer of ghosts
  Field& change() { return change_; }
  double& last_dt() { return last_dt_; }          ///< s, of change()
  int iterations() const { return iterations_; }  ///< of the last solve

 private:
  /// A face of a cell on the boundary of the box.
  struct BoundaryCell {
    BoundaryType type;
    std::size_t face, cell;  ///< of Boundaries::at
    int axis;
    Real outward;                              ///< 1 or -1
    Real area;                                 ///< m2
    Real inv_width;                            ///< of the cell, 1/m
    std::ptrdiff_t at, inside, ghost, stride;  ///< offsets of the face and of the cells on its sides
  };
  static Real leaving(const BlockView<const Real>& w, const BoundaryCell& b, Real impedance);
  void measure_faces(const Block& middle, Real dt);
  void move_to_open(const CutCells& cut, const Block& middle);
  void close_faces(const CutCells& cut);
  void leave_to_fluid(const CutCells& cut, const Block& middle, Real dt);
  void reopen_faces(const CutCells& cut);
  /// `since`: this step over the one before
  void open_boundaries(const Boundaries& boundaries, const Block& middle, Real since);
  void measure_cells(const Block& middle, Real dt);
  void share(const CutCells& cut, FieldView f) const;
  void conjugate_gradients(const Boundaries& boundaries, const CutCells& cut, double enough);
  double square_of_flow() const;
  void correct_faces();
  template <class Visit>
  void for_each_boundary_cell(const Boundaries& boundaries, const Visit& visit) const;

  const Grid& grid_;
  GasConstants gas_;
  Metrics metrics_[3];
  std::array<Field, 3> velocity_, conductance_;  ///< m/s; m3/s/Pa
  std::array<std::vector<Real>, 6> admittance_;  ///< per cell of a face of the box, m3/s/Pa
  struct OpenFace {
    Real velocity, conductance;
  };
  std::vector<OpenFace> open_;  ///< faces of the cut cells as if they were open
  Field diagonal_, change_, residual_, search_, product_;
  int iterations_ = 0;
  double last_dt_ = 0.0;  ///< s, of change_
};

}  // namespace ejecta::gas
