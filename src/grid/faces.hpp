#pragma once
#include <cstddef>
#include <utility>

#include "base/parallel.hpp"
#include "grid/grid.hpp"

/// Loops over the faces of cells.
namespace ejecta {

/// The cells whose lower faces are all faces along axis d: one more than there are cells.
inline Range3 faces_along(const Grid& grid, int d) {
  Range3 faces = grid.range();
  (d == 0 ? faces.i1 : d == 1 ? faces.j1 : faces.k1) += 1;
  return faces;
}

/// visit(cell, at) for the cells of a face of the box (0..5 = x_min, x_max, y_min, ...), row by row on this
/// thread: `cell` counts them along the face's axes in ascending order, `at` the index of the cell whose
/// lower face it is.
template <class Visit>
void for_each_face_cell(const Grid& grid, int face, const Visit& visit) {
  const int d = face / 2, a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
  int at[3]{};
  at[d] = face % 2 ? grid.n(d) : 0;
  std::size_t cell = 0;
  for (int q = 0; q < grid.n(b); ++q)
    for (int p = 0; p < grid.n(a); ++p) {
      at[a] = p;
      at[b] = q;
      visit(cell++, std::as_const(at));
    }
}

}  // namespace ejecta
