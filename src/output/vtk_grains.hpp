#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

#include "base/vec.hpp"

namespace ejecta::output {

/// A grain as it is drawn: a sphere at a point.
struct GrainPoint {
  Vec3 position{0, 0, 0};  ///< m
  double diameter = 0.0;   ///< m
  Vec3 velocity{0, 0, 0};  ///< m/s
  Vec3 force{0, 0, 0};     ///< N, of the fluid
  std::int64_t id = 0;
};

/// Writes grains as .vtp (VTK polydata): one vertex each with `diameter`, `velocity`, `force` and `id`, to be
/// shown as sphere glyphs or Gaussian points.
void write_grains(const std::filesystem::path& path, double time, std::span<const GrainPoint> grains);

}  // namespace ejecta::output
