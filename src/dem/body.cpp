#include "dem/body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "base/error.hpp"
#include "shape/fit_spheres.hpp"
#include "shape/stl.hpp"

namespace ejecta {
namespace {

void add(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

Shape make_shape(const BodySpec& spec, const std::string& directory) {
  switch (spec.shape) {
    case ShapeKind::sphere:
      return make_sphere(spec.diameter);
    case ShapeKind::box:
      return make_box(spec.size);
    case ShapeKind::cluster:
      return make_cluster(spec.size, spec.cluster, spec.sphere_diameter);
    case ShapeKind::multisphere: {
      if (spec.fit_error > 0) {
        const std::string path = (std::filesystem::path(directory) / spec.file).string();
        const TriangleMesh mesh = read_stl(path, spec.scale);
        return make_multisphere(fit_spheres(mesh, spec.fit_error, path), mass_mesh(mesh));
      }
      std::vector<Ball> balls;
      for (const auto& s : spec.spheres) balls.push_back({Vec3(s[0], s[1], s[2]), s[3]});
      return make_multisphere(balls);
    }
    case ShapeKind::polyhedron:
      return make_polyhedron(spec.vertices);
    case ShapeKind::mesh: {
      const std::filesystem::path folder(directory);
      if (spec.files.empty()) {
        const std::string path = (folder / spec.file).string();
        return make_mesh(read_stl(path, spec.scale), path, spec.fit_error);
      }
      TriangleMesh all;
      for (const std::string& file : spec.files) add(all, read_stl((folder / file).string(), spec.scale));
      return make_mesh(all, fmt::format("{}", fmt::join(spec.files, " + ")), spec.fit_error);
    }
    case ShapeKind::superquadric:
      return make_superquadric(spec.size, spec.exponents[0], spec.exponents[1]);
  }
  throw InputError("unknown shape");
}

Body make_body(const BodySpec& spec, const Materials& materials, const std::string& directory) {
  try {
    Body body{spec.name, make_shape(spec, directory)};
    body.material = materials.index(spec.material);
    const double density = spec.density.value_or(materials.spec(body.material).density);
    const bool as_box = spec.shape == ShapeKind::cluster && spec.true_box_mass;
    const MassProperties unit = as_box ? mass_box(spec.size) : body.shape.mass_properties();
    body.mass = spec.mass.value_or(density * unit.volume);
    if (!(body.mass > 0) || !std::isfinite(body.mass))
      throw InputError(fmt::format("mass must be positive, not {} kg (density {} kg/m3, volume {:.6g} m3)",
                                   body.mass, density, unit.volume));
    body.inertia = body.mass / unit.volume * unit.inertia.diagonal();
    body.motion = spec.motion;
    body.release_at = spec.release_at;
    body.enters_at = spec.enters_at;
    body.position = spec.position;
    if (!(spec.rotation_axis.norm() > 0)) throw InputError("rotation_axis must not be zero");
    double angle = spec.rotation_angle;
    body.velocity = spec.velocity;
    body.angular_velocity = spec.spin;
    if (body.motion == Motion::prescribed) {
      body.course = make_course(spec, directory);
      body.position += body.course->first_way();
      angle += body.course->first_angle();
      body.velocity = body.course->velocity(0.0);
      body.angular_velocity = body.course->spin(0.0);
    }
    body.orientation =
        Quat(Eigen::AngleAxisd(angle, spec.rotation_axis.normalized())) * body.shape.frame().rotation;
    return body;
  } catch (const InputError& e) {
    throw InputError(fmt::format("body \"{}\": {}", spec.name, e.what()), e.advice);
  }
}

}  // namespace ejecta
