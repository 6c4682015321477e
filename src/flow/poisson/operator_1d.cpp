#include "flow/poisson/operator_1d.hpp"

namespace ejecta {

Operator1D operator_1d(const Grid& grid, int d, PoissonBoundary lower, PoissonBoundary upper) {
  const Axis& a = grid.axis(d);
  const bool radial = grid.axisymmetric() && d == 0, collapsed = grid.axisymmetric() && d == 1;
  Operator1D op;
  for (int i = 0; i < a.n; ++i) {
    const double lo = a.face[i], hi = a.face[i + 1];
    op.volume.push_back(collapsed ? 1.0 : radial ? 0.5 * (hi * hi - lo * lo) : hi - lo);
  }
  const auto area = [&](int i) { return radial ? a.face[i] : 1.0; };
  const double wrap = 0.5 * (a.width.front() + a.width.back());
  for (int i = 0; i <= a.n; ++i) {
    const PoissonBoundary kind = i == 0 ? lower : upper;
    double distance;
    if (i > 0 && i < a.n) distance = a.centre[i] - a.centre[i - 1];
    else distance = kind == PoissonBoundary::periodic ? wrap : 0.5 * a.width[i == 0 ? 0 : a.n - 1];
    const bool closed = (i == 0 || i == a.n) && kind == PoissonBoundary::neumann;
    op.coupling.push_back(closed || (a.n == 1 && kind == PoissonBoundary::periodic) ? 0.0
                                                                                    : area(i) / distance);
  }
  return op;
}

}  // namespace ejecta
