#include "flow/grain_exchange.hpp"

#include <vector>

#include "base/row_sum.hpp"

namespace ejecta {
namespace {

template <bool kRoom>
TakenByGrains sum_taken(const Grid& grid, const FluidFraction& f, const Vec3& acceleration,
                        ConstFieldView part) {
  std::vector<TakenByGrains> planes(static_cast<std::size_t>(grid.nz()));
  for_each_index(grid.nz(), [&](int k) {
    TakenByGrains& sum = planes[static_cast<std::size_t>(k)];
    for (int j = 0; j < grid.ny(); ++j) {
      const double area = double(grid.metrics(1).volume[j]) * double(grid.metrics(2).volume[k]);
      const Real *now = f.solids.view().row(j, k), *before = f.solids_before.view().row(j, k),
                 *drag = f.drag.view().row(j, k), *open = kRoom ? nullptr : part.row(j, k),
                 *length = grid.metrics(0).volume;
      for (std::size_t c = 0; c < 3; ++c) {
        const Real *seen = f.seen[c].view().row(j, k), *dragging = f.dragging[c].view().row(j, k),
                   *push = f.push[c].view().row(j, k);
        const double a = acceleration[int(c)];
        sum.force[int(c)] +=
            area * row_sum(
                       0, grid.nx(), [=](int i) __attribute__((always_inline)) {
                         const double rate = double(drag[i]) * double(seen[i]) - double(dragging[i]);
                         if constexpr (kRoom)
                           return (rate + double(now[i]) * (double(push[i]) + a)) * double(length[i]);
                         else return rate * double(open[i]) * double(length[i]);
                       });
      }
      sum.volume += area * row_sum(0, grid.nx(), [=](int i) {
                      return (double(now[i]) - double(before[i])) * double(length[i]);
                    });
    }
  });
  TakenByGrains all;
  for (const TakenByGrains& plane : planes) {
    all.force += plane.force;
    all.volume += plane.volume;
  }
  return all;
}

}  // namespace

TakenByGrains taken_by_grains(const Grid& grid, const FluidFraction& f, const Vec3& acceleration,
                              ConstFieldView part) {
  return part.origin ? sum_taken<false>(grid, f, acceleration, part)
                     : sum_taken<true>(grid, f, acceleration, part);
}

void find_undisplaced(const Grid& grid, ConstFieldView p, const std::array<ConstFieldView, 3>& u,
                      ConstFieldView eddy, double viscosity, double scale, FluidFraction& f) {
  const Real unit = static_cast<Real>(scale);
  for_each_friction_row(grid, u, eddy, viscosity, [&](int j, int k, std::size_t c, const auto& friction) {
    for_each_lane(
        0, grid.nx(), [ =, push = f.push[c].view().row(j, k) ](int i) __attribute__((always_inline)) {
          push[i] = unit * friction(i);
        });
  });
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  for (int d = 0; d < 3; ++d) {
    if (!grid.active(d)) continue;
    const std::ptrdiff_t s = stride(p, d);
    for_each_cell(grid.range(), [=, to = f.push[static_cast<std::size_t>(d)].view(), metrics = m[d]](
                                    int i, int j, int k) {
      to(i, j, k) -= unit * cell_gradient(p.row(j, k) + i, s, metrics, d == 0 ? i : d == 1 ? j : k);
    });
  }
  for (std::size_t c = 0; !f.acts && c < 3; ++c)
    for_each_cell(grid.range(),
                  [to = f.seen[c].view(), from = u[c]](int i, int j, int k) { to(i, j, k) = from(i, j, k); });
}

}  // namespace ejecta
