#include "output/vtk_bodies.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/error.hpp"

namespace ejecta::output {

BodiesWriter::BodiesWriter(std::vector<BodySurface> surfaces) : surfaces_(std::move(surfaces)) {
  for (std::size_t b = 0; b < surfaces_.size(); ++b) {
    for (const auto& triangle : surfaces_[b].triangles) {
      for (const std::uint32_t v : triangle)
        connectivity_.push_back(static_cast<std::int64_t>(vertices_ + v));
      offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
      ids_.push_back(static_cast<std::int64_t>(b));
    }
    vertices_ += surfaces_[b].vertices.size();
  }
}

void BodiesWriter::write(const std::filesystem::path& path, double time, std::span<const BodyPose> poses,
                         std::span<const BodyArray> arrays) {
  if (poses.size() != surfaces_.size())
    throw Error(fmt::format("{}: {} poses for {} bodies", path.string(), poses.size(), surfaces_.size()));
  file_.begin("PolyData");
  file_.text(">\n");
  file_.time(time);
  file_.text(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<Points>\n", vertices_,
                         offsets_.size()));
  float* point = file_.float_array("points", 3, 3 * vertices_);
  for (std::size_t b = 0; b < surfaces_.size(); ++b) {
    const Mat3 rotation = poses[b].there ? poses[b].orientation.toRotationMatrix() : Mat3(Mat3::Zero());
    for (const auto& v : surfaces_[b].vertices) {
      const Vec3 world = poses[b].position + rotation * Vec3(v[0], v[1], v[2]);
      for (int d = 0; d < 3; ++d) *point++ = static_cast<float>(world[d]);
    }
  }
  file_.text("</Points>\n<Polys>\n");
  file_.array("connectivity", 1, std::span<const std::int64_t>(connectivity_));
  file_.array("offsets", 1, std::span<const std::int64_t>(offsets_));
  file_.text("</Polys>\n<CellData>\n");
  file_.array("id", 1, std::span<const std::int64_t>(ids_));
  for (const BodyArray& array : arrays) {
    const std::size_t components = static_cast<std::size_t>(array.components);
    if (array.values.size() != components * surfaces_.size())
      throw Error(fmt::format("{}: \"{}\" has {} values for {} bodies", path.string(), array.name,
                              array.values.size(), surfaces_.size()));
    float* to = file_.float_array(array.name, array.components, components * ids_.size());
    for (const std::int64_t id : ids_)
      for (std::size_t c = 0; c < components; ++c)
        *to++ = static_cast<float>(array.values[static_cast<std::size_t>(id) * components + c]);
  }
  file_.text("</CellData>\n</Piece>\n");
  file_.write(path);
}

}  // namespace ejecta::output
