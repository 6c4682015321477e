#include "output/body_surface.hpp"

#include <utility>

namespace ejecta::output {

BodySurface make_body_surface(std::string name, const TriangleMesh& mesh) {
  BodySurface surface{std::move(name), {}, {}};
  for (const Vec3& v : mesh.vertices)
    surface.vertices.push_back(
        {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  for (const auto& t : mesh.triangles)
    surface.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                                 static_cast<std::uint32_t>(t[2])});
  return surface;
}

}  // namespace ejecta::output
