#include "grid/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace ejecta {

Grid::Grid(Axis x, Axis y, Axis z, bool axisymmetric)
    : axis_{std::move(x), std::move(y), std::move(z)}, axisymmetric_(axisymmetric) {
  if (axisymmetric && axis_[1].n != 1)
    throw InputError(fmt::format("an axisymmetric grid has one cell in y, not {}", axis_[1].n));
  if (axisymmetric && axis_[0].face.front() < 0.0)
    throw InputError(
        fmt::format("an axisymmetric grid starts at x = r >= 0, not {} m", axis_[0].face.front()));
  for (std::size_t d = 0; d < 3; ++d) {
    lines_[d] =
        std::make_shared<const Lines>(make_lines(axis_[d], axisymmetric && d == 0, axisymmetric && d == 1));
    const Lines& l = *lines_[d];
    const auto from = [](const std::vector<Real>& line) { return line.data() + kGhosts; };
    metrics_[d] = {from(l.width),    from(l.centre),     from(l.face),      from(l.volume),
                   from(l.area),     from(l.inv_volume), from(l.inv_width), from(l.inv_distance),
                   from(l.inv_span), from(l.weight)};
  }
}

Grid::Lines Grid::make_lines(const Axis& a, bool radial, bool collapsed) {
  const int g = kGhosts, total = a.n + 2 * g + 1;
  // Face positions with mirrored ghosts, one extra above so that the last ghost has a width.
  std::vector<double> face(static_cast<std::size_t>(total + 1));
  for (int i = -g; i <= a.n + g + 1; ++i) {
    double x;
    if (i < 0)
      x = 2 * a.face.front() - a.face[static_cast<std::size_t>(std::min(-i, a.n))] -
          (std::max(-i - a.n, 0)) * a.width.front();
    else if (i > a.n)
      x = 2 * a.face.back() - a.face[static_cast<std::size_t>(std::max(2 * a.n - i, 0))] +
          (std::max(i - 2 * a.n, 0)) * a.width.back();
    else x = a.face[static_cast<std::size_t>(i)];
    face[static_cast<std::size_t>(i + g)] = x;
  }
  Lines l;
  double previous_centre = 0.0, previous_width = 0.0;
  for (int m = 0; m < total; ++m) {
    const double lo = face[static_cast<std::size_t>(m)], hi = face[static_cast<std::size_t>(m) + 1];
    const double width = hi - lo, centre = 0.5 * (lo + hi);
    const double volume = collapsed ? 1.0 : radial ? std::abs(0.5 * (hi * hi - lo * lo)) : width;
    l.width.push_back(static_cast<Real>(width));
    l.centre.push_back(static_cast<Real>(centre));
    l.face.push_back(static_cast<Real>(lo));
    l.volume.push_back(static_cast<Real>(volume));
    l.inv_width.push_back(static_cast<Real>(1.0 / width));
    l.inv_volume.push_back(static_cast<Real>(1.0 / volume));
    l.area.push_back(static_cast<Real>(radial ? std::abs(lo) : 1.0));
    if (m == 0) previous_centre = centre - width, previous_width = width;
    l.inv_distance.push_back(static_cast<Real>(1.0 / (centre - previous_centre)));
    l.weight.push_back(static_cast<Real>(width / (width + previous_width)));
    previous_centre = centre;
    previous_width = width;
  }
  for (int m = 0; m < total; ++m) {
    const std::size_t lo = static_cast<std::size_t>(std::max(m - 1, 0));
    const std::size_t hi = static_cast<std::size_t>(std::min(m + 1, total - 1));
    const double span = 0.5 * (face[hi] + face[hi + 1] - face[lo] - face[lo + 1]);
    l.inv_span.push_back(a.n == 1 ? Real(0)
                                  : static_cast<Real>(1.0 / span));  // nothing varies along one cell
  }
  if (radial && a.face.front() < 1e-12 * a.length()) l.area[static_cast<std::size_t>(g)] = 0;
  for (auto* line : {&l.width, &l.centre, &l.face, &l.volume, &l.area, &l.inv_volume, &l.inv_width,
                     &l.inv_distance, &l.inv_span, &l.weight})
    line->insert(line->end(), kRealLanes, line->back());  // kernels run over whole registers (for_each_lane)
  return l;
}

double Grid::volume(int i, int j, int k) const {
  const double lo = axis_[0].face[static_cast<std::size_t>(i)],
               hi = axis_[0].face[static_cast<std::size_t>(i) + 1];
  const double vz = axis_[2].width[static_cast<std::size_t>(k)];
  if (axisymmetric_) return 0.5 * (hi * hi - lo * lo) * vz;
  return (hi - lo) * axis_[1].width[static_cast<std::size_t>(j)] * vz;
}

Vec3 Grid::centre(int i, int j, int k) const {
  return {axis_[0].centre[static_cast<std::size_t>(i)], axis_[1].centre[static_cast<std::size_t>(j)],
          axis_[2].centre[static_cast<std::size_t>(k)]};
}

Vec3 Grid::lower() const { return {axis_[0].face.front(), axis_[1].face.front(), axis_[2].face.front()}; }

Vec3 Grid::upper() const { return {axis_[0].face.back(), axis_[1].face.back(), axis_[2].face.back()}; }

double Grid::smallest_volume() const {
  if (axisymmetric_) return volume(0, 0, 0);
  return axis_[0].smallest() * axis_[1].smallest() * axis_[2].smallest();
}

double Grid::largest_volume() const {
  if (axisymmetric_) return volume(nx() - 1, 0, nz() - 1);
  return axis_[0].largest() * axis_[1].largest() * axis_[2].largest();
}

}  // namespace ejecta
