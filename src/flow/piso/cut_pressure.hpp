#pragma once
#include <array>
#include <vector>

#include "flow/cut_cells.hpp"
#include "flow/poisson/fast_diagonal.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The pressure equation with faces that solids close,
///
///   sum A_f (phi_n - phi) / distance = rhs      A_f: open part of the area
///
/// by conjugate gradients with the equation of the whole grid as preconditioner, which is solved exactly.
/// What the two matrices differ in lives on the faces of cut cells, so all that iterates are a few thousand
/// numbers: the flows w that sources in and beside the solids must add so that nothing passes closed faces.
/// For a sphere the eigenvalues lie between 1/2 and 1 whatever the grid.
class CutPressure {
 public:
  CutPressure(const Grid& grid, FastDiagonalPoisson& whole, const std::array<PoissonBoundary, 6>& boundary);

  /// The faces of this step.
  void begin(const CutCells& cut);
  /// phi, given as the right-hand side (volume flow over dt, m3/s2), becomes the solution; stops when what
  /// still passes closed faces is `tolerance` of what would without them.
  void solve(const CutCells& cut, FieldView phi, double tolerance);
  int iterations() const { return iterations_; }  ///< of the last solve

 private:
  struct Coupling {
    int below, above;  ///< entries; -1: phi = 0 on a face of the box
    Real strength;     ///< closed area over distance, m
  };
  struct Entry {
    int i, j, k;
  };
  /// out = what closed faces would let pass of f, entry by entry.
  void through_closed(const std::vector<Real>& f, std::vector<Real>& out);
  /// out = inverse of the whole grid's operator on r, entry by entry.
  void invert(const std::vector<Real>& r, std::vector<Real>& out);
  void scatter(const std::vector<Real>& r);
  void to_window(const std::vector<Real>& r);
  void from_window(std::vector<Real>& out);
  void gather(ConstFieldView f, std::vector<Real>& out) const;
  double product(const std::vector<Real>& a, const std::vector<Real>& b) const;

  const Grid& grid_;
  FastDiagonalPoisson& whole_;
  std::array<PoissonBoundary, 6> boundary_;
  std::vector<Entry> entries_;
  std::vector<Coupling> couplings_;
  std::vector<Real> phi_, closed_, residual_, z_, direction_, whole_direction_, source_;
  Field work_, sources_;
  FastDiagonalPoisson::Window window_;
  int iterations_ = 0;
};

}  // namespace ejecta
