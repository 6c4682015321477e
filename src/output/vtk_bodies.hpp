#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output/report_data.hpp"
#include "output/vtk_appended.hpp"

namespace ejecta::output {

/// One value or vector a body, e.g. {"velocity", 3, {vx, vy, vz of body 0, vx, ...}}.
struct BodyArray {
  std::string name;
  int components = 1;
  std::vector<double> values;
};

/// Writes bodies as .vtp (VTK polydata): their surface triangles in world axes, with the body's number (`id`)
/// and the caller's arrays on every triangle.
class BodiesWriter {
 public:
  explicit BodiesWriter(std::vector<BodySurface> surfaces);
  /// One pose a surface.
  void write(const std::filesystem::path& path, double time, std::span<const BodyPose> poses,
             std::span<const BodyArray> arrays);

 private:
  std::vector<BodySurface> surfaces_;
  std::vector<std::int64_t> connectivity_, offsets_, ids_;
  std::size_t vertices_ = 0;
  VtkAppended file_;
};

}  // namespace ejecta::output
