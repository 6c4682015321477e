#include "flow/piso/variable_poisson.hpp"

#include <cmath>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

constexpr int kMostSteps = 200;

double inner_product(const Grid& grid, ConstFieldView a, ConstFieldView b) {
  return reduce_sum(grid.range(),
                    [=](int i, int j, int k) { return double(a(i, j, k)) * double(b(i, j, k)); });
}

}  // namespace

VariablePoisson::VariablePoisson(const Grid& grid, const Boundaries& boundaries,
                                 FastDiagonalPoisson& constant)
    : grid_(grid), boundaries_(boundaries), constant_(constant) {
  for (Field* f : {&residual_, &z_, &direction_, &image_}) *f = grid.make_field();
}

void VariablePoisson::apply(const std::array<ConstFieldView, 3>& faces, ConstFieldView f,
                            FieldView out) const {
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  const bool x = grid_.active(0), y = grid_.active(1), z = grid_.active(2);
  for_each_cell(
      grid_.range(), [=](int i, int j, int k) __attribute__((always_inline)) {
        const Real here = f(i, j, k);
        Real sum = 0;
        if (x)
          sum +=
              face_area<0>(m, i + 1, j, k) * m[0].inv_distance[i + 1] * faces[0](i + 1, j, k) *
                  (f(i + 1, j, k) - here) -
              face_area<0>(m, i, j, k) * m[0].inv_distance[i] * faces[0](i, j, k) * (here - f(i - 1, j, k));
        if (y)
          sum += face_area<1>(m, i, j, k) *
                 (m[1].inv_distance[j + 1] * faces[1](i, j + 1, k) * (f(i, j + 1, k) - here) -
                  m[1].inv_distance[j] * faces[1](i, j, k) * (here - f(i, j - 1, k)));
        if (z)
          sum += face_area<2>(m, i, j, k) *
                 (m[2].inv_distance[k + 1] * faces[2](i, j, k + 1) * (f(i, j, k + 1) - here) -
                  m[2].inv_distance[k] * faces[2](i, j, k) * (here - f(i, j, k - 1)));
        out(i, j, k) = sum;
      });
}

/// z = c^-1/2 L^-1 c^-1/2 r
void VariablePoisson::precondition(ConstFieldView cells) {
  const FieldView z = z_.view();
  const ConstFieldView r = residual_.view();
  for_each_cell(grid_.range(),
                [=](int i, int j, int k) { z(i, j, k) = r(i, j, k) / std::sqrt(cells(i, j, k)); });
  constant_.solve(z, z);
  for_each_cell(grid_.range(), [=](int i, int j, int k) { z(i, j, k) /= std::sqrt(cells(i, j, k)); });
}

int VariablePoisson::solve(const std::array<ConstFieldView, 3>& faces, ConstFieldView cells,
                           ConstFieldView rhs, double tolerance, const std::array<FieldView, 3>& q,
                           FieldView phi) {
  const FieldView r = residual_.view(), z = z_.view(), d = direction_.view(), image = image_.view();
  for_each_cell(grid_.range(), [=](int i, int j, int k) {
    r(i, j, k) = rhs(i, j, k);
    phi(i, j, k) = 0;
  });
  double before = 0, least = 1e300;
  left_ = std::sqrt(inner_product(grid_, r, r));
  for (int n = 0; n < kMostSteps; ++n) {
    // Where nothing but round-off is left the residual grows again.
    if (!(left_ > tolerance) || left_ > 2 * least) return n;
    least = std::min(least, left_);
    precondition(cells);
    const double now = -inner_product(grid_, r, z);
    if (!(now > 0)) return n;
    const Real beta = n == 0 ? Real(0) : static_cast<Real>(now / before);
    for_each_cell(grid_.range(), [=](int i, int j, int k) { d(i, j, k) = z(i, j, k) + beta * d(i, j, k); });
    boundaries_.fill_pressure(d, q, false);
    apply(faces, d, image);
    const double curvature = -inner_product(grid_, d, image);
    if (!(curvature > 0)) return n;
    const Real alpha = static_cast<Real>(now / curvature);
    for_each_cell(grid_.range(), [=](int i, int j, int k) {
      phi(i, j, k) += alpha * d(i, j, k);
      r(i, j, k) -= alpha * image(i, j, k);
    });
    before = now;
    left_ = std::sqrt(inner_product(grid_, r, r));
  }
  return kMostSteps;
}

}  // namespace ejecta
