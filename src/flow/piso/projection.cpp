#include "flow/piso/projection.hpp"

#include <cmath>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// r of face_velocities() on a face with two cells and a ghost or more on either side: `pc` points to the
/// cell above it.
EJECTA_KERNEL Real filtered_roughness(const Real* pc, std::ptrdiff_t s, const Metrics& m, int at) {
  // Differences at the faces at - 2 ... at + 2, gradients of the cells between them, roughness of the inner
  // three faces
  const Real d0 = pc[-2 * s] - pc[-3 * s], d1 = pc[-s] - pc[-2 * s], d2 = pc[0] - pc[-s], d3 = pc[s] - pc[0],
             d4 = pc[2 * s] - pc[s];
  const auto gradient = [&](int cell, Real low, Real high) __attribute__((always_inline)) {
    return (m.weight[cell] * low + (Real(1) - m.weight[cell + 1]) * high) * m.inv_width[cell];
  };
  const Real g0 = gradient(at - 2, d0, d1), g1 = gradient(at - 1, d1, d2), g2 = gradient(at, d2, d3),
             g3 = gradient(at + 1, d3, d4);
  const auto rough = [&](int face, Real low, Real high, Real d) __attribute__((always_inline)) {
    return high + m.weight[face] * (low - high) - d * m.inv_distance[face];
  };
  return Real(0.5) * rough(at, g1, g2, d2) -
         Real(0.25) * (rough(at - 1, g0, g1, d1) + rough(at + 1, g2, g3, d3));
}

/// Face velocities along D of row (., j, k), the last face of a row in x included. On the faces of the box,
/// which only periodic ones keep, there are not enough ghosts for the filter.
template <int D>
void faces_along(const Grid& grid, const Metrics& m, ConstFieldView u, ConstFieldView p, Real filter_time,
                 FieldView q, int j, int k) {
  const std::ptrdiff_t s = stride(p, D);
  const Real *p_row = p.row(j, k), *u_row = u.row(j, k);
  Real* q_row = q.row(j, k);
  const int n = grid.n(D), index = D == 1 ? j : k;
  const auto mean = [=](int i) __attribute__((always_inline)) {
    const Real w = m.weight[D == 0 ? i : index];
    return w * u_row[i - s] + (Real(1) - w) * u_row[i];
  };
  const auto filtered = [=](int i) __attribute__((always_inline)) {
    q_row[i] = mean(i) + filter_time * filtered_roughness(p_row + i, s, m, D == 0 ? i : index);
  };
  if (D == 0) {
    for_each_lane(1, n, filtered);
    q_row[0] = mean(0);
    q_row[n] = mean(n);
  } else if (index > 0 && index < n) {
    for_each_lane(0, grid.nx(), filtered);
  } else {
    for_each_lane(
        0, grid.nx(), [=](int i) __attribute__((always_inline)) { q_row[i] = mean(i); });
  }
}

/// q -= dt grad phi on the lower D-faces of row (., j, k), and u -= dt grad phi in its cells where `cells`.
template <int D>
void correct_along(const Grid& grid, const Metrics& m, ConstFieldView phi, Real dt, FieldView q, FieldView u,
                   int j, int k, bool cells) {
  const std::ptrdiff_t s = stride(phi, D);
  const Real* phi_row = phi.row(j, k);
  Real *q_row = q.row(j, k), *u_row = u.row(j, k);
  for_each_lane(0, grid.nx() + (D == 0), [=](int i) {
    const int at = D == 0 ? i : D == 1 ? j : k;
    q_row[i] -= dt * (phi_row[i] - phi_row[i - s]) * m.inv_distance[at];
  });
  if (!cells) return;
  for_each_lane(0, grid.nx(), [=](int i) {
    u_row[i] -= dt * cell_gradient(phi_row + i, s, m, D == 0 ? i : D == 1 ? j : k);
  });
}

}  // namespace

void face_velocities(const Grid& grid, const std::array<ConstFieldView, 3>& u_star, ConstFieldView p,
                     Real filter_time, const std::array<FieldView, 3>& q) {
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  for_each_index(grid.nz() + 1, [&](int k) {
    for (int j = 0; j <= grid.ny(); ++j) {
      if (grid.active(0) && j < grid.ny() && k < grid.nz())
        faces_along<0>(grid, m[0], u_star[0], p, filter_time, q[0], j, k);
      if (grid.active(1) && k < grid.nz()) faces_along<1>(grid, m[1], u_star[1], p, filter_time, q[1], j, k);
      if (grid.active(2) && j < grid.ny()) faces_along<2>(grid, m[2], u_star[2], p, filter_time, q[2], j, k);
    }
  });
}

void divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q, Real dt, FieldView rhs) {
  const Outflow out = outflow(grid, q);
  const Real inv_dt = Real(1) / dt;
  for_each_cell(grid.range(), [=](int i, int j, int k) { rhs(i, j, k) = inv_dt * out(i, j, k); });
}

void apply_correction(const Grid& grid, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
                      const std::array<FieldView, 3>& u, FieldView p) {
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  for_each_index(grid.nz() + 1, [&](int k) {
    for (int j = 0; j <= grid.ny(); ++j) {
      const bool cells = j < grid.ny() && k < grid.nz();
      if (grid.active(0) && cells) correct_along<0>(grid, m[0], phi, dt, q[0], u[0], j, k, true);
      if (grid.active(1) && k < grid.nz()) correct_along<1>(grid, m[1], phi, dt, q[1], u[1], j, k, cells);
      if (grid.active(2) && j < grid.ny()) correct_along<2>(grid, m[2], phi, dt, q[2], u[2], j, k, cells);
      if (!cells) continue;
      for_each_lane(0, grid.nx(), [to = p.row(j, k), from = phi.row(j, k)](int i) { to[i] += from[i]; });
    }
  });
}

double largest_divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q, ConstFieldView outflow) {
  const auto speed = [&](int d) {
    return reduce_max(grid.range(), [=, v = q[d]](int i, int j, int k) { return std::abs(v(i, j, k)); });
  };
  const Real fastest = std::max({speed(0), speed(1), speed(2), Real(1e-30)});
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  return reduce_max(grid.range(), [=](int i, int j, int k) {
    const Real volume = m[0].volume[i] * m[1].volume[j] * m[2].volume[k];
    const Real width = std::min({m[0].width[i], m[1].width[j], m[2].width[k]});
    return std::abs(outflow(i, j, k)) * width / volume / fastest;  // at rest their product would be 0
  });
}

}  // namespace ejecta
