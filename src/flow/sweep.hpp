#pragma once
#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/parallel.hpp"
#include "base/simd.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// One sweep of a finite-volume balance over all cells. Every face flux is computed once, row by row, and
/// kept in scratch that stays in cache until both neighbours have used it.
///
///   face.template flux<D>(j, k, i0, i1, out)   writes out[n][i], n < kN: flux times area through the lower
///                                              D-face of cell (i, j, k), for i in [i0, i1)
///   update(j, k, balance)                      balance[n][i] = sum of what leaves cell (i, j, k)
///   edge(D, side, j, k, row)                   sees the fluxes through the boundaries of the box: along x
///   the
///                                              faces 0 and nx of the row, else nx faces; side 0 lower, 1
///                                              upper
///
/// Fluxes must be pure functions of their arguments: chunks of planes run in parallel and recompute the plane
/// they share, so any number of threads gives the same bits.
template <int kN, class Face, class Update, class Edge>
void sweep(const Grid& grid, const Face& face, const Update& update, const Edge& edge) {
  constexpr std::integral_constant<int, 0> x{};
  constexpr std::integral_constant<int, 1> y{};
  constexpr std::integral_constant<int, 2> z{};
  const int nx = grid.nx(), ny = grid.ny(), nz = grid.nz();
  const bool in_x = grid.active(0), in_y = grid.active(1), in_z = grid.active(2);
  const int ld =
      (nx + 1 + kRealLanes) / kRealLanes * kRealLanes;  // one lane more is read than a row of faces has
  for_each_chunk(nz, [&](int k0, int k1) {
    const std::size_t rows_needed = static_cast<std::size_t>(kN) * static_cast<std::size_t>(2 * ny + 5);
    Real* scratch = thread_scratch(rows_needed * static_cast<std::size_t>(ld), 1);
    const auto rows = [&](int slot, Real*(&out)[kN]) {
      for (int n = 0; n < kN; ++n) out[n] = scratch + (static_cast<std::ptrdiff_t>(slot) * kN + n) * ld;
    };
    const auto swap_rows = [](Real*(&a)[kN], Real*(&b)[kN]) {
      for (int n = 0; n < kN; ++n) std::swap(a[n], b[n]);
    };
    Real *zero[kN], *balance[kN], *through_x[kN], *low_y[kN], *high_y[kN], *low_z[kN], *high_z[kN];
    for (int slot : {0, 1, 2, 3, 4}) {  // all zero: what directions of a single cell carry
      rows(slot, zero);
      for (Real* row : zero) std::fill_n(row, ld, Real(0));
    }
    rows(0, balance);
    rows(1, through_x);
    rows(2, low_y);
    rows(3, high_y);
    rows(4, zero);
    int low = 5, high = 5 + ny;  // slots of the fluxes through the lower and the upper faces of the plane
    for (int j = 0; in_z && j < ny; ++j) {
      rows(low + j, low_z);
      face.template flux<2>(j, k0, 0, nx, low_z);
      if (k0 == 0) edge(z, 0, j, 0, low_z);
    }
    for (int k = k0; k < k1; ++k) {
      if (in_y) {
        face.template flux<1>(0, k, 0, nx, low_y);
        edge(y, 0, 0, k, low_y);
      }
      for (int j = 0; j < ny; ++j) {
        if (in_x) {
          face.template flux<0>(j, k, 0, nx + 1, through_x);
          edge(x, 0, j, k, through_x);
          edge(x, 1, j, k, through_x);
        }
        if (in_y) face.template flux<1>(j + 1, k, 0, nx, high_y);
        if (in_y && j + 1 == ny) edge(y, 1, ny, k, high_y);
        rows(in_z ? low + j : 4, low_z);
        rows(in_z ? high + j : 4, high_z);
        if (in_z) face.template flux<2>(j, k + 1, 0, nx, high_z);
        if (in_z && k + 1 == nz) edge(z, 1, j, nz, high_z);
        for (int n = 0; n < kN; ++n)
          for_each_lane(
              0, nx,
              [b = balance[n], x0 = through_x[n], y0 = low_y[n], y1 = high_y[n], z0 = low_z[n],
               z1 = high_z[n]](int i) { b[i] = x0[i + 1] - x0[i] + (y1[i] - y0[i]) + (z1[i] - z0[i]); });
        update(j, k, balance);
        swap_rows(low_y, high_y);
      }
      std::swap(low, high);
    }
  });
}

template <int kN, class Face, class Update>
void sweep(const Grid& grid, const Face& face, const Update& update) {
  sweep<kN>(grid, face, update, [](auto, int, int, int, Real* const(&)[kN]) {});
}

}  // namespace ejecta
