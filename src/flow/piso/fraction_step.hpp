#pragma once
#include <array>
#include <vector>

#include "flow/boundary.hpp"
#include "flow/fluid_fraction.hpp"
#include "flow/piso/variable_poisson.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The end of a stage of the flow with grains in it (paper Eqs 1, 2; model A): pressure and drag, implicit,
/// so that no loading is too stiff. With e the fluid's fraction, q = e u on faces, m what the fluid's
/// momentum over density and volume would be without the two,
///
///   e u = m + h (S - D u - e grad p)          on faces: q = e (m + h S) / A - (h e^2 / A) grad p, A = e + h
///   D div q + de/dt = 0                         div((h e^2 / A) grad p) = div(e (m + h S) / A) + de/dt
///
/// and cells take the mean of what their faces gained, q - m, so that drag and pressure balance where e
/// jumps. Averages on faces are those for which the drag that the fluid feels is the sum over cells of volume
/// (S - D seen): what grains gather is what the fluid lost.
class FractionStep {
 public:
  FractionStep(const Grid& grid, const Boundaries& boundaries, FastDiagonalPoisson& poisson);

  /// m in `u`, which becomes the velocity; p, m2/s2, is the pressure before and then after, guessed to change
  /// as in this stage of the last step; q m/s through whole faces. f.seen and f.push gain half of this
  /// stage's velocity and force, f.seen from nothing in the first stage. `h`, s: of the stage, `dt` of the
  /// step. Ghosts of p by `boundaries`.
  void project(FluidFraction& f, bool first, double h, double dt, const std::array<FieldView, 3>& u,
               FieldView p, const std::array<FieldView, 3>& q);
  /// div q + de/dt, m3/s
  void imbalance(const FluidFraction& f, double dt, const std::array<FieldView, 3>& q, FieldView out) const;
  int iterations() const { return iterations_; }  ///< of the last solution

 private:
  /// How cells and faces share along an axis.
  struct Shares {
    std::vector<Real> below;      // of face i: weight of cell i - 1
    std::vector<Real> low, high;  // of cell i: weights of its faces i and i + 1
  };
  /// Roots of sums of squares over the cells, m3/s.
  struct Sizes {
    double flow = 0, imbalance = 0;
  };
  template <int D>
  void predict_faces(const FluidFraction& f, Real h, ConstFieldView m, ConstFieldView p, FieldView q, int j,
                     int k);
  template <int D>
  void correct_faces(FieldView q, int j, int k) const;
  template <int D>
  void correct_cells(FluidFraction& f, Real kept, FieldView u, ConstFieldView p, ConstFieldView q, int j,
                     int k) const;
  void find_roots(const FluidFraction& f, Real h, int j, int k);
  void guess(FieldView change, FieldView p) const;
  Sizes find_imbalance(const FluidFraction& f, double dt, const std::array<FieldView, 3>& q);
  void close_faces(const std::array<FieldView, 3>& q);

  const Grid& grid_;
  const Boundaries& boundaries_;
  VariablePoisson poisson_;
  std::array<Shares, 3> shares_;
  std::array<Field, 3> coefficient_;
  std::array<Field, 3> gain_;  // q - m of every face
  Field inverse_root_, rhs_, correction_;
  std::vector<std::array<double, 2>> squares_;  // of each plane
  bool floats_;                                 // no boundary says what the pressure is
  int iterations_ = 0;
};

}  // namespace ejecta
