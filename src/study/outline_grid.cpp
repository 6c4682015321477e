#include "study/outline_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "case/map_grid.hpp"

namespace ejecta {
namespace {

Raster grid_in(const MapSettings& s) {
  const Window& w = s.window;
  const MapGrid g =
      map_grid({w.x_low, w.x_high}, {s.symmetric ? 0.0 : w.y_low, w.y_high}, {s.step_x, s.step_y});
  if (!g.is_plane(s.symmetric))
    throw InputError(fmt::format("steps of {} and {} m leave fewer than three rows or columns in the window",
                                 s.step_x, s.step_y));
  return {g.first_x * s.step_x, g.first_y * s.step_y, s.step_x, s.step_y,
          g.last_x - g.first_x, g.last_y - g.first_y};
}

/// Every second node along and across, beginning with these.
RasterValues every_second(const RasterValues& all, int first_i, int first_j) {
  const Raster& r = all.raster;
  RasterValues out{{r.x0 + first_i * r.dx, r.y0 + first_j * r.dy, 2.0 * r.dx, 2.0 * r.dy,
                    (r.cells_x - first_i) / 2, (r.cells_y - first_j) / 2},
                   {}};
  for (int j = first_j; j <= r.cells_y; j += 2)
    for (int i = first_i; i <= r.cells_x; i += 2)
      out.values.push_back(all.values[static_cast<std::size_t>(r.node(i, j))]);
  return out;
}

/// Area, half-width, length before and behind.
std::array<double, 4> measures(const RasterValues& all) {
  const Extent e = positive_extent(all.raster, all.values);
  if (e.low_x > e.high_x) return {};
  return {positive_area(all.raster, all.values), std::max(e.high_y, -e.low_y), std::max(-e.low_x, 0.0),
          std::max(e.high_x, 0.0)};
}

}  // namespace

OutlineGrid::OutlineGrid(const MapSettings& settings)
    : settings_(settings), raster_(grid_in(settings)), told_(static_cast<std::size_t>(raster_.nodes())) {
  for (int n = 0; n < raster_.nodes(); ++n) order_.push_back(n);
  const auto is_coarse = [&](int n) { return n % raster_.row() % 2 == 0 && n / raster_.row() % 2 == 0; };
  std::stable_partition(order_.begin(), order_.end(), is_coarse);
}

std::vector<Proposal> OutlineGrid::ask(int count) {
  std::vector<Proposal> out;
  for (; count > 0 && asked_ < order_.size(); --count, ++asked_)
    out.push_back({{raster_.x(order_[asked_]), raster_.y(order_[asked_])}, Fidelity::fine});
  return out;
}

void OutlineGrid::tell(const MapRun& run) {
  if (!std::isfinite(run.margin)) throw DivergedError("the margin of a run of the map is no number");
  const long i = std::lround((run.at.x - raster_.x0) / raster_.dx),
             j = std::lround((run.at.y - raster_.y0) / raster_.dy);
  const bool inside = i >= 0 && i <= raster_.cells_x && j >= 0 && j <= raster_.cells_y;
  const int node = inside ? raster_.node(static_cast<int>(i), static_cast<int>(j)) : 0;
  if (!inside ||
      std::hypot(raster_.x(node) - run.at.x, raster_.y(node) - run.at.y) > 1e-6 * (raster_.dx + raster_.dy))
    throw InputError(fmt::format("({}, {}) m is no place of the grid of the map", run.at.x, run.at.y));
  told_[static_cast<std::size_t>(node)] = run.margin;
}

RasterValues OutlineGrid::margins() const {
  RasterValues all{raster_, {}};
  for (int n = 0; n < raster_.nodes(); ++n) {
    double nearest = std::numeric_limits<double>::infinity(), margin = 0.0;
    for (int m = 0; m < raster_.nodes(); ++m) {
      if (!told_[static_cast<std::size_t>(m)]) continue;
      const double distance =
          std::hypot((raster_.x(m) - raster_.x(n)) / raster_.dx, (raster_.y(m) - raster_.y(n)) / raster_.dy);
      if (distance >= nearest) continue;
      nearest = distance;
      margin = *told_[static_cast<std::size_t>(m)];
    }
    if (!std::isfinite(nearest)) throw InputError("a map without runs has no outline");
    all.values.push_back(margin);
  }
  return whole_plane(std::move(all), settings_.symmetric);
}

Outline OutlineGrid::outline() const {
  const RasterValues all = margins();
  const std::array<double, 4> values = measures(all);
  std::array<double, 4> squares{};
  for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const std::array<double, 4> coarse = measures(every_second(all, i, j));
    for (std::size_t k = 0; k < values.size(); ++k)
      squares[k] += 0.25 * (coarse[k] - values[k]) * (coarse[k] - values[k]);
  }
  const auto estimate = [&](std::size_t k) { return Estimate{values[k], std::sqrt(squares[k])}; };
  Outline out;
  out.area = estimate(0);
  out.half_width = estimate(1);
  out.length_before = estimate(2);
  out.length_behind = estimate(3);
  out.outline = positive_outlines(all.raster, all.values);
  out.reaches_sides = reaches_sides(all.raster, all.values);
  out.widest_gap = std::hypot(raster_.dx, raster_.dy);
  return out;
}

bool OutlineGrid::is_finished(const Outline&) const { return asked_ == order_.size(); }

}  // namespace ejecta
