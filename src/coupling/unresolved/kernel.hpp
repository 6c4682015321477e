#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "grid/grid.hpp"

/// Where the volume of a grain lies and what it feels: one weight a cell, the same for both.
namespace ejecta {

/// Part of the kernel K(x) = (15/16) (1 - x^2)^2, |x| < 1, that lies below x: its integral from -1. K and its
/// slope are continuous, so that what a moving grain leaves in a cell is too.
inline double kernel_below(double x) {
  x = std::clamp(x, -1.0, 1.0);
  const double square = x * x;
  return 0.5 + x * (15.0 / 16 - square * (10.0 / 16 - square * (3.0 / 16)));
}

/// What lies beyond a face of the box, for the part of a kernel that reaches there.
enum class Beyond {
  mirror,   ///< walls, symmetry planes: what reaches beyond is thrown back, the sum of weights stays 1
  outside,  ///< inlets and outlets: it is lost to the box, as the grain is when it has passed
  periodic  ///< it comes back on the other side
};

/// Weights of the cells along one axis.
struct AxisWeights {
  static constexpr int kMost = 10;
  int first = 0, count = 0;  ///< cells first ... first + count - 1; of periodic axes modulo n
  std::array<double, kMost> weight{};
};

/// The cell that holds x, as Axis::cell_at, looked for from the cell `near` on.
inline int cell_from(const Axis& axis, double x, int near) {
  const double* face = axis.face.data();
  while (near > 0 && x < face[near]) --near;
  while (near < axis.n - 1 && x >= face[near + 1]) ++near;
  return near;
}

/// Half width of the kernel about x in `cell`, m: half of `width`, and never less than a cell (between
/// centres that of both, in proportion), without which the force on a grain would ripple as it crosses cells.
inline double kernel_half_width(const Axis& axis, double x, double width, int cell) {
  if (axis.n == 1) return 0.5 * axis.length();
  const int low = cell > 0 && x < axis.centre[static_cast<std::size_t>(cell)] ? cell - 1 : cell;
  const std::size_t a = static_cast<std::size_t>(std::min(low, axis.n - 2)), b = a + 1;
  const double share = std::clamp((x - axis.centre[a]) / (axis.centre[b] - axis.centre[a]), 0.0, 1.0);
  return std::max(0.5 * width, (1 - share) * axis.width[a] + share * axis.width[b]);
}
inline double kernel_half_width(const Axis& axis, double x, double width) {
  return kernel_half_width(axis, x, width, axis.cell_at(x));
}

/// The exact integral of the kernel of half width h (m) about x in `cell` over each cell. Their sum is 1 but
/// for what lies outside; an axis of a single cell has one weight of 1. Throws InputError where the kernel
/// covers more than AxisWeights::kMost cells.
AxisWeights axis_weights(const Axis& axis, double x, double h, const std::array<Beyond, 2>& beyond, int cell);
inline AxisWeights axis_weights(const Axis& axis, double x, double h, const std::array<Beyond, 2>& beyond) {
  return axis_weights(axis, x, h, beyond, axis.cell_at(x));
}

}  // namespace ejecta
