#include "flow/piso/variable_poisson.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/row_sum.hpp"
#include "flow/stencil.hpp"

namespace ejecta {
namespace {

constexpr int kMostSteps = 200;

/// The sum over the faces of a cell. Along an axis of one cell the coefficient is nothing.
struct FlowInto {
  std::array<ConstFieldView, 3> c;
  ConstFieldView f;
  Metrics m[3];
  template <int D>
  EJECTA_KERNEL Real through(const Real* at, const Real* coefficient, std::ptrdiff_t s, int n) const {
    return m[D].inv_distance[n + 1] * coefficient[s] * (at[s] - at[0]) -
           m[D].inv_distance[n] * coefficient[0] * (at[0] - at[-s]);
  }
  EJECTA_KERNEL Real operator()(int i, int j, int k) const {
    const Real *at = f.row(j, k) + i, *cx = c[0].row(j, k) + i;
    const Real x = face_area<0>(m, i + 1, j, k) * m[0].inv_distance[i + 1] * cx[1] * (at[1] - at[0]) -
                   face_area<0>(m, i, j, k) * m[0].inv_distance[i] * cx[0] * (at[0] - at[-1]);
    const Real y = face_area<1>(m, i, j, k) * through<1>(at, c[1].row(j, k) + i, f.sy, j);
    const Real z = face_area<2>(m, i, j, k) * through<2>(at, c[2].row(j, k) + i, f.sz, k);
    return x + y + z;
  }
};

}  // namespace

VariablePoisson::VariablePoisson(const Grid& grid, const Boundaries& boundaries,
                                 FastDiagonalPoisson& constant)
    : grid_(grid), boundaries_(boundaries), constant_(constant) {
  for (Field* f : {&z_, &direction_, &image_}) *f = grid.make_field();
}

/// Whole registers are computed, and what is in cells is added up while the row is at hand.
template <class Compute, class Value>
double VariablePoisson::sum_rows(const Compute& compute, const Value& value) const {
  const int nx = grid_.nx();
  return reduce_sum({0, 1, 0, grid_.ny(), 0, grid_.nz()}, [&](int, int j, int k) {
    for_each_lane(
        0, nx, [&](int i) __attribute__((always_inline)) { compute(i, j, k); });
    return row_sum(
        0, nx, [&](int i) __attribute__((always_inline)) { return value(i, j, k); });
  });
}

/// z = c^-1/2 L^-1 c^-1/2 r; returns -r z.
double VariablePoisson::precondition(ConstFieldView inverse_roots, ConstFieldView r) {
  const FieldView z = z_.view();
  for_each_cell(grid_.range(),
                [=](int i, int j, int k) { z(i, j, k) = r(i, j, k) * inverse_roots(i, j, k); });
  constant_.solve(z, z);
  return -sum_rows([=](int i, int j, int k) { z(i, j, k) *= inverse_roots(i, j, k); },
                   [=](int i, int j, int k) { return double(r(i, j, k)) * double(z(i, j, k)); });
}

/// Puts into image_ what the equation makes of the direction; returns the negative product of the two.
double VariablePoisson::apply(const std::array<ConstFieldView, 3>& faces) {
  const FlowInto inflow{faces, direction_.view(), {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)}};
  const FieldView out = image_.view();
  return -sum_rows(
      [=](int i, int j, int k) __attribute__((always_inline)) { out(i, j, k) = inflow(i, j, k); },
      [=](int i, int j, int k) { return double(inflow.f(i, j, k)) * double(out(i, j, k)); });
}

int VariablePoisson::solve(const std::array<ConstFieldView, 3>& faces, ConstFieldView inverse_roots,
                           FieldView r, double size, double tolerance, const std::array<FieldView, 3>& q,
                           FieldView phi) {
  double before = 0, least = 1e300;
  left_ = size;
  for (int n = 0; n < kMostSteps; ++n) {
    // Where nothing but round-off is left the residual grows again.
    const bool done = !(left_ > tolerance) || left_ > 2 * least;
    const double now = done ? 0.0 : precondition(inverse_roots, r);
    least = std::min(least, left_);
    if (n == 0 && !(now > 0)) for_each_cell(grid_.range(), [=](int i, int j, int k) { phi(i, j, k) = 0; });
    if (!(now > 0)) return n;
    if (n == 0) std::swap(direction_, z_);
    const FieldView d = direction_.view();
    if (n > 0)
      for_each_cell(grid_.range(), [=, z = z_.view(), beta = static_cast<Real>(now / before)](
                                       int i, int j, int k) { d(i, j, k) = z(i, j, k) + beta * d(i, j, k); });
    boundaries_.fill_pressure(d, q, false);
    const double curvature = apply(faces);
    const Real alpha = curvature > 0 ? static_cast<Real>(now / curvature) : Real(0);
    if (n > 0 && alpha == 0) return n;
    left_ = std::sqrt(sum_rows(
        [=, image = image_.view(), first = n == 0](int i, int j, int k) {
          phi(i, j, k) = (first ? Real(0) : phi(i, j, k)) + alpha * d(i, j, k);
          r(i, j, k) -= alpha * image(i, j, k);
        },
        [=](int i, int j, int k) { return double(r(i, j, k)) * double(r(i, j, k)); }));
    before = now;
  }
  return kMostSteps;
}

}  // namespace ejecta
