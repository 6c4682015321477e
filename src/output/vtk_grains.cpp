#include "output/vtk_grains.hpp"

#include <fmt/format.h>

#include <vector>

#include "output/vtk_appended.hpp"

namespace ejecta::output {

void write_grains(const std::filesystem::path& path, double time, std::span<const GrainPoint> grains) {
  VtkAppended file;
  file.begin("PolyData");
  file.text(">\n");
  file.time(time);
  file.text(fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\">\n<Points>\n", grains.size()));
  const auto vectors = [&](const char* name, auto member) {
    float* to = file.float_array(name, 3, 3 * grains.size());
    for (const GrainPoint& g : grains)
      for (int d = 0; d < 3; ++d) *to++ = static_cast<float>((g.*member)[d]);
  };
  vectors("points", &GrainPoint::position);
  file.text("</Points>\n<Verts>\n");
  std::vector<std::int64_t> connectivity, offsets, ids;
  for (const GrainPoint& g : grains) {
    connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    ids.push_back(g.id);
  }
  file.array("connectivity", 1, std::span<const std::int64_t>(connectivity));
  file.array("offsets", 1, std::span<const std::int64_t>(offsets));
  file.text("</Verts>\n<PointData>\n");
  file.array("id", 1, std::span<const std::int64_t>(ids));
  float* to = file.float_array("diameter", 1, grains.size());
  for (const GrainPoint& g : grains) *to++ = static_cast<float>(g.diameter);
  vectors("velocity", &GrainPoint::velocity);
  vectors("force", &GrainPoint::force);
  file.text("</PointData>\n</Piece>\n");
  file.write(path);
}

}  // namespace ejecta::output
