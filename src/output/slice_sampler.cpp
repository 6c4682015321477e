#include "output/slice_sampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace ejecta::output {

SliceSampler::Stencil SliceSampler::stencil(const Axis& axis, double position, bool mirror) {
  const double x = mirror ? std::abs(position) : position;
  if (x < axis.face.front() || x > axis.face.back()) return {};
  const int cell = axis.cell_at(x);
  const auto centre = [&](int n) { return axis.centre[static_cast<std::size_t>(n)]; };
  const int low = std::clamp(x < centre(cell) ? cell - 1 : cell, 0, std::max(axis.n - 2, 0));
  const int high = std::min(low + 1, axis.n - 1);
  if (low == high) return {low, low, 0};
  // Beyond the outermost centres the value is held, not extrapolated.
  const double weight = std::clamp((x - centre(low)) / (centre(high) - centre(low)), 0.0, 1.0);
  return {low, high, static_cast<Real>(weight)};
}

SliceSampler::SliceSampler(const Grid& grid, const SliceRaster& raster) : raster_(raster) {
  const auto mirror = [&](int d) { return (d == 0 && raster.mirror_x) || (d == 1 && raster.mirror_y); };
  normal_ = stencil(grid.axis(raster.axis), raster.position, mirror(raster.axis));
  std::size_t side = 0;
  for (int d = 0; d < 3; ++d) {
    if (d == raster.axis) continue;
    direction_[side] = d;
    const int pixels = raster.pixels[side];
    const double size = (raster.upper[side] - raster.lower[side]) / pixels;
    for (int p = 0; p < pixels; ++p)
      across_[side].push_back(stencil(grid.axis(d), raster.lower[side] + (p + 0.5) * size, mirror(d)));
    ++side;
  }
  line_cells_ = grid.n(direction_[0]);
  lines_.resize(3 * static_cast<std::size_t>(line_cells_) * across_[1].size());
  speed_.resize(across_[0].size() * across_[1].size());
}

void SliceSampler::sample(ConstFieldView u, ConstFieldView v, ConstFieldView w, SliceFrame& out) {
  const std::array<ConstFieldView, 3> velocity{u, v, w};
  const std::size_t width = across_[0].size();
  const auto cells = static_cast<std::size_t>(line_cells_);
  const auto normal = static_cast<std::size_t>(raster_.axis);
  const auto first = static_cast<std::size_t>(direction_[0]),
             second = static_cast<std::size_t>(direction_[1]);

  const auto row = [&](int q) {
    Real* speed = speed_.data() + static_cast<std::size_t>(q) * width;
    const Stencil& across = across_[1][static_cast<std::size_t>(q)];
    if (normal_.cell < 0 || across.cell < 0) {
      std::fill_n(speed, width, Real(0));
      return;
    }
    // First the cells' values along the row's line, blended from the four lines around it; then the pixels.
    Real* line = lines_.data() + 3 * cells * static_cast<std::size_t>(q);
    for (std::size_t c = 0; c < 3; ++c)
      for (int n = 0; n < line_cells_; ++n) {
        const auto at = [&](int i, int j) {
          std::array<int, 3> index{};
          index[first] = n;
          index[normal] = i;
          index[second] = j;
          return velocity[c](index[0], index[1], index[2]);
        };
        const Real near = (1 - across.weight) * at(normal_.cell, across.cell) +
                          across.weight * at(normal_.cell, across.next);
        const Real far = (1 - across.weight) * at(normal_.next, across.cell) +
                         across.weight * at(normal_.next, across.next);
        line[c * cells + static_cast<std::size_t>(n)] = (1 - normal_.weight) * near + normal_.weight * far;
      }
    for (std::size_t p = 0; p < width; ++p) {
      const Stencil& along = across_[0][p];
      Real sum = 0;
      if (along.cell >= 0)
        for (std::size_t c = 0; c < 3; ++c) {
          const Real* values = line + c * cells;
          const Real value = (1 - along.weight) * values[along.cell] + along.weight * values[along.next];
          sum += value * value;
        }
      speed[p] = std::sqrt(sum);
    }
  };
  for_each_index(static_cast<int>(across_[1].size()), row);

  Real fastest = 0;
  for (const Real s : speed_) {
    if (!std::isfinite(s))
      throw DivergedError(fmt::format("the air speed in slice {} is {}", raster_.name, s));
    fastest = std::max(fastest, s);
  }
  out.full_scale = static_cast<double>(fastest);
  out.speed.resize(speed_.size());
  const Real scale = fastest > 0 ? 255 / fastest : 0;
  for (std::size_t n = 0; n < speed_.size(); ++n)
    out.speed[n] = static_cast<std::uint8_t>(speed_[n] * scale + Real(0.5));
}

}  // namespace ejecta::output
