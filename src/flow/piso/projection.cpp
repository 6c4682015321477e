#include "flow/piso/projection.hpp"

#include <cmath>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

template <int D>
void faces_along(const Grid& grid, ConstFieldView u, ConstFieldView p, Real dt, FieldView q) {
  const Metrics m = grid.metrics(D);
  const std::ptrdiff_t s = stride(p, D);
  Range3 range = grid.range();
  (D == 0 ? range.i1 : D == 1 ? range.j1 : range.k1) += 1;
  for_each_cell(range, [=](int i, int j, int k) {
    const int at = D == 0 ? i : D == 1 ? j : k;
    const Real *pc = p.row(j, k) + i, *uc = u.row(j, k) + i;
    const Real w = m.weight[at];
    const Real velocity = w * uc[-s] + (Real(1) - w) * uc[0];
    const Real smooth = w * cell_gradient(pc - s, s, m, at - 1) + (Real(1) - w) * cell_gradient(pc, s, m, at);
    q(i, j, k) = velocity + dt * (smooth - (pc[0] - pc[-s]) * m.inv_distance[at]);
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

void face_velocities(const Grid& grid, const std::array<ConstFieldView, 3>& u_star, ConstFieldView p, Real dt,
                     const std::array<FieldView, 3>& q) {
  if (grid.active(0)) faces_along<0>(grid, u_star[0], p, dt, q[0]);
  if (grid.active(1)) faces_along<1>(grid, u_star[1], p, dt, q[1]);
  if (grid.active(2)) faces_along<2>(grid, u_star[2], p, dt, q[2]);
}

void divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q, Real dt, FieldView rhs) {
  const Outflow out = outflow(grid, q);
  const Real inv_dt = Real(1) / dt;
  for_each_cell(grid.range(), [=](int i, int j, int k) { rhs(i, j, k) = inv_dt * out(i, j, k); });
}

void apply_correction(const Grid& grid, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
                      const std::array<FieldView, 3>& u, FieldView p) {
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  const auto along = [&](auto direction) {
    constexpr int D = decltype(direction)::value;
    if (!grid.active(D)) return;
    const std::ptrdiff_t s = stride(phi, D);
    const Metrics md = m[D];
    const FieldView qd = q[D], ud = u[D];
    for_each_cell(grid.range(), [=](int i, int j, int k) {
      const int at = D == 0 ? i : D == 1 ? j : k;
      const Real* pc = phi.row(j, k) + i;
      qd(i, j, k) -= dt * (pc[0] - pc[-s]) * md.inv_distance[at];
      ud(i, j, k) -= dt * cell_gradient(pc, s, md, at);
    });
    Range3 upper = grid.range();  // the faces behind the last cells
    if (D == 0) upper.i0 = grid.nx(), upper.i1 = grid.nx() + 1;
    if (D == 1) upper.j0 = grid.ny(), upper.j1 = grid.ny() + 1;
    if (D == 2) upper.k0 = grid.nz(), upper.k1 = grid.nz() + 1;
    for_each_cell(upper, [=](int i, int j, int k) {
      const int at = D == 0 ? i : D == 1 ? j : k;
      const Real* pc = phi.row(j, k) + i;
      qd(i, j, k) -= dt * (pc[0] - pc[-s]) * md.inv_distance[at];
    });
  };
  along(std::integral_constant<int, 0>{});
  along(std::integral_constant<int, 1>{});
  along(std::integral_constant<int, 2>{});
  for_each_cell(grid.range(), [=](int i, int j, int k) { p(i, j, k) += phi(i, j, k); });
}

double largest_divergence(const Grid& grid, const std::array<ConstFieldView, 3>& q) {
  const Outflow out = outflow(grid, q);
  const auto speed = [&](int d) {
    return reduce_max(grid.range(), Real(0),
                      [=, v = q[d]](int i, int j, int k) { return std::abs(v(i, j, k)); });
  };
  const Real fastest = std::max({speed(0), speed(1), speed(2), Real(1e-30)});
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  return reduce_max(grid.range(), Real(0), [=](int i, int j, int k) {
    const Real volume = m[0].volume[i] * m[1].volume[j] * m[2].volume[k];
    const Real width = std::min({m[0].width[i], m[1].width[j], m[2].width[k]});
    return std::abs(out(i, j, k)) * width / (volume * fastest);
  });
}

}  // namespace ejecta
