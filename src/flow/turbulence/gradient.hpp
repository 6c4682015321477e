#pragma once
#include "flow/stencil.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta {

/// Rows of the three velocities around (., j, k), with the spans of their central differences.
struct GradientRow {
  const Real *x, *y, *z, *span_x, *radius;
  std::ptrdiff_t sy, sz;
  Real span_y, span_z;

  EJECTA_KERNEL VelocityGradient operator()(int i) const {
    const Real sx = span_x[i];
    VelocityGradient v{
        derivative(x + i, 1, sx), derivative(x + i, sy, span_y), derivative(x + i, sz, span_z),
        derivative(y + i, 1, sx), derivative(y + i, sy, span_y), derivative(y + i, sz, span_z),
        derivative(z + i, 1, sx), derivative(z + i, sy, span_y), derivative(z + i, sz, span_z)};
    if (radius) v.yy = x[i] / radius[i];  // hoop strain u_r / r
    return v;
  }
};

inline GradientRow gradient_row(const Grid& grid, const std::array<ConstFieldView, 3>& u, int j, int k) {
  return {u[0].row(j, k),
          u[1].row(j, k),
          u[2].row(j, k),
          grid.metrics(0).inv_span,
          grid.axisymmetric() ? grid.metrics(0).centre : nullptr,
          u[0].sy,
          u[0].sz,
          grid.metrics(1).inv_span[j],
          grid.metrics(2).inv_span[k]};
}

}  // namespace ejecta
