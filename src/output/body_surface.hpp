#pragma once
#include <string>

#include "output/report_data.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta::output {

/// The surface of a Shape (body axes, m) as the files hold it.
BodySurface make_body_surface(std::string name, const TriangleMesh& mesh);

}  // namespace ejecta::output
