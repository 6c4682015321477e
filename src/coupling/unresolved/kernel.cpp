#include "coupling/unresolved/kernel.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace ejecta {

AxisWeights axis_weights(const Axis& axis, double x, double h, const std::array<Beyond, 2>& beyond,
                         int cell) {
  AxisWeights w;
  const double low = axis.face.front(), high = axis.face.back();
  if (axis.n == 1) {
    w.count = 1;
    w.weight[0] = 1;
    return w;
  }
  const bool periodic = beyond[0] == Beyond::periodic;
  if (!periodic && (x <= low - h || x >= high + h)) return w;  // gone, by whatever side
  if (beyond[0] == Beyond::mirror) x = std::max(x, low);       // dented into a wall
  if (beyond[1] == Beyond::mirror) x = std::min(x, high);
  const auto face = [&](int i) {  // of the axis continued beyond a periodic side
    const int turns = i < 0 ? -1 : i > axis.n ? 1 : 0;
    return axis.face[static_cast<std::size_t>(i - turns * axis.n)] + turns * (high - low);
  };
  int first = cell, last = first;
  while ((periodic ? first > -axis.n : first > 0) && face(first) > x - h) --first;
  while ((periodic ? last < 2 * axis.n - 1 : last < axis.n - 1) && face(last + 1) < x + h) ++last;
  w.first = first;
  w.count = last - first + 1;
  if (w.count > AxisWeights::kMost)
    throw InputError(
        fmt::format("a grain spreads over {} cells of {:.3g} mm: at most {}; coarser cells, a smaller "
                    "coupling.kernel_width, or the grain as a [[body]]",
                    w.count, 1e3 * axis.width[static_cast<std::size_t>(cell)], AxisWeights::kMost));
  const double inverse = 1 / h;
  const auto add = [&](double centre) {
    double below = kernel_below((face(first) - centre) * inverse);
    for (int n = 0; n < w.count; ++n) {
      const double above = kernel_below((face(first + n + 1) - centre) * inverse);
      w.weight[static_cast<std::size_t>(n)] += above - below;
      below = above;
    }
  };
  add(x);
  if (beyond[0] == Beyond::mirror && x - h < low) add(2 * low - x);
  if (beyond[1] == Beyond::mirror && x + h > high) add(2 * high - x);
  // What the mirrors throw back reaches no farther than the kernel itself; what is left is round-off.
  if (beyond[0] != Beyond::outside && beyond[1] != Beyond::outside) {
    double sum = 0;
    for (int n = 0; n < w.count; ++n) sum += w.weight[static_cast<std::size_t>(n)];
    for (int n = 0; n < w.count; ++n) w.weight[static_cast<std::size_t>(n)] /= sum;
  }
  return w;
}

}  // namespace ejecta
