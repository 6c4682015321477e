#pragma once
#include <array>
#include <vector>

#include "flow/boundary.hpp"
#include "flow/cut_cells.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/poisson/fast_diagonal.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The pressure equation with faces that solids close,
///
///   sum A_f (phi_n - phi) / distance = rhs      A_f: open part of the area
///
/// by conjugate gradients with the equation of the whole grid as preconditioner, which is solved exactly.
/// Small cells are one with their carrier: they share its phi, and the balance is that of both together. What
/// the two matrices differ in lives on the faces of cut cells, so all that iterates are a few thousand
/// numbers: the flows w that sources in and beside the solids must add so that nothing passes closed faces
/// and nothing holds apart what is one.
class CutPressure {
 public:
  CutPressure(const Grid& grid, FastDiagonalPoisson& whole, const std::array<PoissonBoundary, 6>& boundary);

  /// The faces of this step: what bodies close, and where an open boundary prescribes the velocity.
  void begin(const CutCells& cut, const Boundaries& boundaries);
  /// phi, given as the right-hand side (volume flow over dt, m3/s2), becomes the solution; stops when what
  /// still passes closed faces is `tolerance` of what would without them; false where that is not reached.
  bool solve(const CutCells& cut, FieldView phi, double tolerance);
  /// On the faces of small cells, from q -= dt grad phi with a phi that has been extended to them to what the
  /// solution balances, which shares that of their carrier.
  void balance(const CutCells& cut, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q) const;
  int iterations() const { return iterations_; }  ///< of the last solve

 private:
  /// A face on which the two matrices differ.
  struct Coupling {
    int below, above;  ///< entries; -1: phi = 0 on a face of the box
    Real whole, open;  ///< area over distance, m
  };
  struct Entry {
    int i, j, k;
    int one_with;  ///< entry whose phi it shares: itself, or its carrier
  };
  void add_entry(int i, int j, int k);
  void add_coupling(int d, std::array<int, 3> face, Real closed);
  /// out = what passes faces in the whole grid, but not between these cells: (L - P^T A P) f, P: what is one
  /// shares phi.
  void too_much(const std::vector<Real>& f, std::vector<Real>& out);
  /// out = inverse of the whole grid's operator on r, entry by entry.
  void invert(const std::vector<Real>& r, std::vector<Real>& out);
  void scatter(const std::vector<Real>& r);
  void to_window(const std::vector<Real>& r);
  void from_window(std::vector<Real>& out);
  void gather(ConstFieldView f, std::vector<Real>& out) const;
  double product(const std::vector<Real>& a, const std::vector<Real>& b) const;

  const Grid& grid_;
  GridMetrics metrics_;
  FastDiagonalPoisson& whole_;
  std::array<PoissonBoundary, 6> boundary_;
  std::vector<Entry> entries_;
  std::vector<Coupling> couplings_;
  Array3<int> entry_;  // of every cell of the grid, -1: none
  std::vector<Real> phi_, closed_, residual_, z_, direction_, whole_direction_, source_;
  Field work_, sources_;
  FastDiagonalPoisson::Window window_;
  int iterations_ = 0;
};

}  // namespace ejecta
