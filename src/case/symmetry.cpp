#include "case/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "case/extent.hpp"

namespace ejecta {
namespace {

bool mirrored_nozzles(const JetSpec& jet) {
  return std::all_of(jet.more_nozzles.begin(), jet.more_nozzles.end(), [&](const Vec3& nozzle) {
    const Vec3 mirror(nozzle.x(), 2.0 * jet.nozzle.y() - nozzle.y(), nozzle.z());
    return (mirror - nozzle).norm() < 1e-9 ||
           std::any_of(jet.more_nozzles.begin(), jet.more_nozzles.end(),
                       [&](const Vec3& other) { return (mirror - other).norm() < 1e-9; });
  });
}

/// A shape that is even in each of its own axes.
bool even_shape(const BodySpec& b) {
  return b.shape == ShapeKind::sphere || b.shape == ShapeKind::box || b.shape == ShapeKind::cluster ||
         b.shape == ShapeKind::superquadric;
}

bool along_y(const Vec3& v) { return std::abs(v.x()) + std::abs(v.z()) <= 1e-12 * v.norm(); }

}  // namespace

Symmetry symmetry_across(const Case& c, std::size_t body) {
  const BodySpec& b = c.bodies.at(body);
  const auto no = [](std::string why) { return Symmetry{.refused = std::move(why)}; };
  if (c.jet.direction.y() != 0.0) return no("the jet blows aslant");
  if (!mirrored_nozzles(c.jet)) return no("the further nozzles are not mirrored");
  if (c.environment.gravity.y() != 0.0 || c.flow.body_force.y() != 0.0) return no("a force acts along y");
  if (b.spin.x() != 0.0 || b.spin.z() != 0.0) return no("the body spins about x or z");
  if (c.boundary[2].type != c.boundary[3].type) return no("the faces at y_min and y_max are not alike");
  if (const auto box = grid_box(c)) {
    const double right = box->high.y() - c.jet.nozzle.y(), left = c.jet.nozzle.y() - box->low.y();
    if (std::abs(right - left) > 1e-6 * (right + left)) return no("the jet is not in the middle of the box");
  }
  if (even_shape(b) && b.rotation_angle != 0.0 && !along_y(b.rotation_axis) &&
      std::abs(std::sin(2.0 * b.rotation_angle)) > 1e-9)
    return no("the body lies turned, and not about y");
  const bool plain = even_shape(b) && (b.rotation_angle == 0.0 || along_y(b.rotation_axis)) &&
                     !b.random_rotation && c.bodies.size() == 1 && b.copies == 1 && c.walls.empty();
  return {.sure = plain, .refused = {}};
}

bool map_is_symmetric(const Case& c) {
  if (c.map.symmetric) return *c.map.symmetric;
  if (c.map.lying == MapLying::given) return symmetry_across(c, mapped_body(c)).sure;
  Case plain = c;  // bodies that lie turned either way by chance are as even as the shape
  plain.bodies.at(mapped_body(c)).rotation_angle = 0.0;
  return symmetry_across(plain, mapped_body(c)).sure;
}

std::size_t mapped_body(const Case& c) {
  const auto at = std::find_if(c.bodies.begin(), c.bodies.end(), [&](const BodySpec& b) {
    return c.map.body.empty() ? b.on_belt : b.name == c.map.body;
  });
  return static_cast<std::size_t>(at - c.bodies.begin());
}

}  // namespace ejecta
