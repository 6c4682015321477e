#include "dem/body.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"

namespace ejecta {
namespace {

int material_index(const BodySpec& spec, const Case& config) {
  for (std::size_t n = 0; n < config.materials.size(); ++n)
    if (config.materials[n].name == spec.material) return static_cast<int>(n);
  std::string known;
  for (const MaterialSpec& m : config.materials) known += (known.empty() ? "" : ", ") + m.name;
  throw InputError(fmt::format("material \"{}\" is not defined; known: {}", spec.material,
                               known.empty() ? "none" : known));
}

}  // namespace

Shape make_shape(const BodySpec& spec, const std::string&) {
  switch (spec.shape) {
    case ShapeKind::sphere:
      return make_sphere(spec.diameter);
    case ShapeKind::box:
      return make_box(spec.size);
    case ShapeKind::cluster:
      return make_cluster(spec.size, spec.cluster, spec.sphere_diameter);
    case ShapeKind::multisphere: {
      std::vector<Ball> balls;
      for (const auto& s : spec.spheres) balls.push_back({Vec3(s[0], s[1], s[2]), s[3]});
      return make_multisphere(balls);
    }
    default:
      throw InputError("this shape is not available");
  }
}

Body make_body(const BodySpec& spec, const Case& config) {
  try {
    Body body{spec.name, make_shape(spec, std::filesystem::path(config.path).parent_path())};
    body.material = material_index(spec, config);
    const double density =
        spec.density.value_or(config.materials[static_cast<std::size_t>(body.material)].density);
    const bool as_box = spec.shape == ShapeKind::cluster && spec.true_box_mass;
    const MassProperties unit = as_box ? mass_box(spec.size) : body.shape.mass_properties();
    body.mass = spec.mass.value_or(density * unit.volume);
    if (!(body.mass > 0) || !std::isfinite(body.mass))
      throw InputError(fmt::format("mass must be positive, not {} kg (density {} kg/m3, volume {:.6g} m3)",
                                   body.mass, density, unit.volume));
    body.inertia = body.mass / unit.volume * unit.inertia.diagonal();
    body.motion = spec.motion;
    body.release_at = spec.release_at;
    body.position = spec.position;
    if (!(spec.rotation_axis.norm() > 0)) throw InputError("rotation_axis must not be zero");
    body.orientation = Quat(Eigen::AngleAxisd(spec.rotation_angle, spec.rotation_axis.normalized())) *
                       body.shape.frame().rotation;
    body.velocity = spec.velocity;
    body.angular_velocity = spec.spin;
    return body;
  } catch (const InputError& e) {
    throw InputError(fmt::format("body \"{}\": {}", spec.name, e.what()));
  }
}

}  // namespace ejecta
