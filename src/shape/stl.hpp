#pragma once
#include <string>
#include <string_view>

#include "shape/triangle_mesh.hpp"

namespace ejecta {

/// Reads STL text or binary from memory; lengths are multiplied by `scale` (to m); corners that coincide to
/// 1e-7 of the size become one vertex. Throws InputError naming `name` and the line, byte or triangle.
TriangleMesh parse_stl(std::string_view bytes, double scale, const std::string& name);
TriangleMesh read_stl(const std::string& path, double scale);

}  // namespace ejecta
