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
    const int pixels = raster.pixels[side];
    const double size = (raster.upper[side] - raster.lower[side]) / pixels;
    for (int p = 0; p < pixels; ++p)
      across_[side].push_back(stencil(grid.axis(d), raster.lower[side] + (p + 0.5) * size, mirror(d)));
    ++side;
  }
  speed_.resize(across_[0].size() * across_[1].size());
}

void SliceSampler::sample(ConstFieldView u, ConstFieldView v, ConstFieldView w, SliceFrame& out) {
  const std::size_t width = across_[0].size();
  const auto row = [&](int q) {
    std::array<Stencil, 3> at;
    const std::size_t axis = static_cast<std::size_t>(raster_.axis);
    const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    at[axis] = normal_;
    at[second] = across_[1][static_cast<std::size_t>(q)];
    for (std::size_t p = 0; p < width; ++p) {
      at[first] = across_[0][p];
      Real sum[3] = {0, 0, 0};
      if (at[0].cell >= 0 && at[1].cell >= 0 && at[2].cell >= 0)
        for (int corner = 0; corner < 8; ++corner) {
          Real weight = 1;
          int index[3];
          for (std::size_t d = 0; d < 3; ++d) {
            const bool next = corner >> d & 1;
            weight *= next ? at[d].weight : 1 - at[d].weight;
            index[d] = next ? at[d].next : at[d].cell;
          }
          if (weight == 0) continue;
          sum[0] += weight * u(index[0], index[1], index[2]);
          sum[1] += weight * v(index[0], index[1], index[2]);
          sum[2] += weight * w(index[0], index[1], index[2]);
        }
      speed_[static_cast<std::size_t>(q) * width + p] =
          std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
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
