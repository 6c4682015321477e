#pragma once
#include <array>

#include "flow/stencil.hpp"
#include "grid/grid.hpp"

/// The collocated projection: u_star -> face velocities -> pressure increment -> divergence-free faces and
/// corrected cells. p is pressure over density throughout, m2/s2.
namespace ejecta {

/// q = interpolated u_star + filter_time r on all inner (and periodic) faces. r filters the pressure that
/// alternates from cell to cell: with R = interpolated cell gradient of p - face gradient of p (Rhie & Chow
/// 1983), r = R/2 - (R_below + R_above)/4 along the face's axis. R alone damps with h^2 p'''. `filter_time`,
/// at most the step, must not depend on it, or the steady flow around an edge does (the force on a body of
/// ten cells by 5 %).
void face_velocities(const Grid& grid, const std::array<ConstFieldView, 3>& u_star, ConstFieldView p,
                     Real filter_time, const std::array<FieldView, 3>& q);

/// Net volume flow out of cell (i, j, k), m3/s.
struct Outflow {
  std::array<ConstFieldView, 3> q;
  Metrics m[3];
  EJECTA_KERNEL Real operator()(int i, int j, int k) const {  // q is zero along directions of a single cell
    return face_area<0>(m, i + 1, j, k) * q[0](i + 1, j, k) - face_area<0>(m, i, j, k) * q[0](i, j, k) +
           face_area<1>(m, i, j, k) * (q[1](i, j + 1, k) - q[1](i, j, k)) +
           face_area<2>(m, i, j, k) * (q[2](i, j, k + 1) - q[2](i, j, k));
  }
};

inline Outflow outflow(const Grid& grid, const std::array<ConstFieldView, 3>& q) {
  return {q, {grid.metrics(0), grid.metrics(1), grid.metrics(2)}};
}

/// rhs = net volume flow out of each cell / dt.
void divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q, Real dt, FieldView rhs);

/// q -= dt grad phi on faces, u = u_star - dt grad phi in cells, p += phi. phi has filled ghosts.
void apply_correction(const Grid& grid, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
                      const std::array<FieldView, 3>& u, FieldView p);

/// Largest |net volume flow out of a cell| / (volume * velocity / width): relative divergence of q. outflow:
/// m3/s of every cell.
double largest_divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q, ConstFieldView outflow);

}  // namespace ejecta
