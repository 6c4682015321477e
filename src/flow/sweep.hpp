#pragma once
#include <algorithm>

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
///
/// Fluxes must be pure functions of their arguments: chunks of planes run in parallel and recompute the plane
/// they share, so any number of threads gives the same bits.
template <int kN, class Face, class Update>
void sweep(const Grid& grid, const Face& face, const Update& update) {
  const int nx = grid.nx(), ny = grid.ny();
  const bool in_x = grid.active(0), in_y = grid.active(1), in_z = grid.active(2);
  const int ld = (nx + 1 + kLanes - 1) / kLanes * kLanes;
  for_each_chunk(grid.nz(), [&](int k0, int k1) {
    Real* scratch = thread_scratch(
        static_cast<std::size_t>(kN) * static_cast<std::size_t>(ld) * static_cast<std::size_t>(ny + 4), 1);
    const auto rows = [&](int slot, Real*(&out)[kN]) {
      for (int n = 0; n < kN; ++n) out[n] = scratch + (static_cast<std::ptrdiff_t>(slot) * kN + n) * ld;
    };
    Real *balance[kN], *fresh[kN], *below_y[kN], *through_x[kN], *below_z[kN];
    rows(0, balance);
    rows(1, fresh);
    rows(2, below_y);
    rows(3, through_x);
    if (in_z)
      for (int j = 0; j < ny; ++j) {
        rows(4 + j, below_z);
        face.template flux<2>(j, k0, 0, nx, below_z);
      }
    for (int k = k0; k < k1; ++k) {
      if (in_y) face.template flux<1>(0, k, 0, nx, below_y);
      for (int j = 0; j < ny; ++j) {
        if (in_x) {
          face.template flux<0>(j, k, 0, nx + 1, through_x);
          for (int n = 0; n < kN; ++n)
            for_each_lane(0, nx, [b = balance[n], f = through_x[n]](int i) { b[i] = f[i + 1] - f[i]; });
        } else {
          for (int n = 0; n < kN; ++n) std::fill_n(balance[n], nx, Real(0));
        }
        const auto add = [&](Real*(&below)[kN]) {
          for (int n = 0; n < kN; ++n)
            for_each_lane(0, nx, [b = balance[n], up = fresh[n], low = below[n]](int i) {
              b[i] += up[i] - low[i];
              low[i] = up[i];
            });
        };
        if (in_y) {
          face.template flux<1>(j + 1, k, 0, nx, fresh);
          add(below_y);
        }
        if (in_z) {
          rows(4 + j, below_z);
          face.template flux<2>(j, k + 1, 0, nx, fresh);
          add(below_z);
        }
        update(j, k, balance);
      }
    }
  });
}

}  // namespace ejecta
