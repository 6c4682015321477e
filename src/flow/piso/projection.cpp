#include "flow/piso/projection.hpp"

#include <cmath>
#include <type_traits>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// What the smooth gradient of p, interpolated between cells, has over that of the two cells beside a face.
EJECTA_KERNEL Real roughness_of(const Real* pc, std::ptrdiff_t s, const Metrics& m, int at) {
  const Real w = m.weight[at];
  const Real smooth = w * cell_gradient(pc - s, s, m, at - 1) + (Real(1) - w) * cell_gradient(pc, s, m, at);
  return smooth - (pc[0] - pc[-s]) * m.inv_distance[at];
}

/// Face velocities along D of row (., j, k), the last face of a row in x included. On the faces of the box, which
/// only periodic ones keep, there are not enough ghosts to look one face further.
template <int D>
void faces_along(const Grid& grid, const Metrics& m, ConstFieldView u, ConstFieldView p, Real filter_time, FieldView q,
                 int j, int k) {
  const std::ptrdiff_t s = stride(p, D);
  const Real *p_row = p.row(j, k), *u_row = u.row(j, k);
  Real* q_row = q.row(j, k);
  const auto face = [=](int i, auto inner) __attribute__((always_inline)) {
    const int at = D == 0 ? i : D == 1 ? j : k;
    const Real *pc = p_row + i, *uc = u_row + i;
    const Real w = m.weight[at];
    Real filter = roughness_of(pc, s, m, at);
    if constexpr (inner)
      filter = Real(0.5) * filter - Real(0.25) * (roughness_of(pc - s, s, m, at - 1) + roughness_of(pc + s, s, m, at + 1));
    q_row[i] = w * uc[-s] + (Real(1) - w) * uc[0] + filter_time * filter;
  };
  const int n = grid.n(D), index = D == 1 ? j : k;
  if (D == 0) {
    for_each_lane(1, n, [=](int i) __attribute__((always_inline)) { face(i, std::true_type{}); });
    face(0, std::false_type{});
    face(n, std::false_type{});
  } else if (index > 0 && index < n) {
    for_each_lane(0, grid.nx(), [=](int i) __attribute__((always_inline)) { face(i, std::true_type{}); });
  } else {
    for_each_lane(0, grid.nx(), [=](int i) __attribute__((always_inline)) { face(i, std::false_type{}); });
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

/// Net volume flow out of cell (i, j, k), m3/s.
struct Outflow {
  std::array<ConstFieldView, 3> q;
  Metrics m[3];
  Real operator()(int i, int j, int k) const {  // q is zero along directions of a single cell
    return face_area<0>(m, i + 1, j, k) * q[0](i + 1, j, k) - face_area<0>(m, i, j, k) * q[0](i, j, k) +
           face_area<1>(m, i, j, k) * (q[1](i, j + 1, k) - q[1](i, j, k)) +
           face_area<2>(m, i, j, k) * (q[2](i, j, k + 1) - q[2](i, j, k));
  }
};

Outflow outflow(const Grid& grid, const std::array<ConstFieldView, 3>& q) {
  return {q, {grid.metrics(0), grid.metrics(1), grid.metrics(2)}};
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

double largest_divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q) {
  const Outflow out = outflow(grid, q);
  const auto speed = [&](int d) {
    return reduce_max(grid.range(), [=, v = q[d]](int i, int j, int k) { return std::abs(v(i, j, k)); });
  };
  const Real fastest = std::max({speed(0), speed(1), speed(2), Real(1e-30)});
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  return reduce_max(grid.range(), [=](int i, int j, int k) {
    const Real volume = m[0].volume[i] * m[1].volume[j] * m[2].volume[k];
    const Real width = std::min({m[0].width[i], m[1].width[j], m[2].width[k]});
    return std::abs(out(i, j, k)) * width / volume / fastest;  // at rest their product would be 0
  });
}

}  // namespace ejecta
