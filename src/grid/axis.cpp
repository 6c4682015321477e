#include "grid/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace ejecta {

double Axis::smallest() const { return *std::min_element(width.begin(), width.end()); }

double Axis::largest() const { return *std::max_element(width.begin(), width.end()); }

int Axis::cell_at(double x) const {
  const auto above = std::upper_bound(face.begin(), face.end(), x);
  return std::clamp(static_cast<int>(above - face.begin()) - 1, 0, n - 1);
}

Axis make_axis(const std::vector<double>& points, const std::vector<int>& cells,
               const std::vector<double>& grading) {
  if (points.size() < 2 || cells.size() + 1 != points.size())
    throw InputError(fmt::format("a grid axis with {} points needs {} cell counts, not {}", points.size(),
                                 points.empty() ? 0 : points.size() - 1, cells.size()));
  if (!grading.empty() && grading.size() != cells.size())
    throw InputError(fmt::format("a grid axis with {} blocks needs {} gradings, not {}", cells.size(),
                                 cells.size(), grading.size()));
  Axis axis;
  axis.face.push_back(points[0]);
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const double from = points[b], to = points[b + 1];
    const int n = cells[b];
    if (!(to > from)) throw InputError(fmt::format("grid points must increase: {} m follows {} m", to, from));
    if (n < 1) throw InputError(fmt::format("a grid block needs at least one cell, not {}", n));
    const double expansion = grading.empty() ? 1.0 : grading[b];
    if (!(expansion > 0.0)) throw InputError(fmt::format("a grading must be positive, not {}", expansion));
    const double ratio = n > 1 ? std::pow(expansion, 1.0 / (n - 1)) : 1.0;
    double total = 0.0, h = 1.0;
    for (int c = 0; c < n; ++c, h *= ratio) total += h;
    double sum = 0.0;
    h = 1.0;
    for (int c = 0; c + 1 < n; ++c, h *= ratio) {
      sum += h;
      axis.face.push_back(from + (to - from) * sum / total);
    }
    axis.face.push_back(to);
  }
  axis.n = static_cast<int>(axis.face.size()) - 1;
  for (int i = 0; i < axis.n; ++i) {
    axis.centre.push_back(0.5 * (axis.face[i] + axis.face[i + 1]));
    axis.width.push_back(axis.face[i + 1] - axis.face[i]);
  }
  return axis;
}

}  // namespace ejecta
