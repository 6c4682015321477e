#pragma once
#include <memory>
#include <optional>
#include <string>

#include "base/vec.hpp"
#include "case/case.hpp"
#include "dem/course.hpp"
#include "dem/materials.hpp"
#include "shape/shape.hpp"

namespace ejecta {

/// A rigid body. Its axes are those of its shape: origin in the centre of mass, principal. SI units, world
/// axes unless said otherwise.
struct Body {
  std::string name;
  Shape shape;
  double mass = 0.0;      ///< kg
  Vec3 inertia{0, 0, 0};  ///< kg m2, principal moments in body axes
  int material = 0;       ///< index into the materials
  Motion motion = Motion::free;
  std::shared_ptr<const Course> course;  ///< of a prescribed body
  double release_at = 0.0;               ///< s; until then the body rests as placed
  std::optional<double> enters_at;       ///< s; until then, and while its place is taken, it is not there
  Vec3 position{0, 0, 0};                ///< m, centre of mass
  Quat orientation = Quat::Identity();   ///< body axes -> world
  Vec3 velocity{0, 0, 0};                ///< m/s
  Vec3 angular_velocity{0, 0, 0};        ///< rad/s

  Vec3 velocity_at(const Vec3& point) const { return velocity + angular_velocity.cross(point - position); }
  Vec3 to_world(const Vec3& p) const { return position + orientation * p; }
  Vec3 to_body(const Vec3& p) const { return orientation.conjugate() * (p - position); }
  /// Of a point in the world, m, < 0 inside.
  double signed_distance(const Vec3& point) const { return shape.signed_distance(to_body(point)); }
  double kinetic_energy() const {
    const Vec3 spin = orientation.conjugate() * angular_velocity;
    return 0.5 * mass * velocity.squaredNorm() + 0.5 * inertia.dot(spin.cwiseAbs2());
  }
  Vec3 angular_momentum() const {  ///< kg m2/s, about the centre of mass
    return orientation * inertia.cwiseProduct(orientation.conjugate() * angular_velocity);
  }
};

/// The shape a [[body]] entry describes, in the axes the user wrote it in until the factory turns it.
/// `directory`: where relative file names start.
Shape make_shape(const BodySpec& spec, const std::string& directory);
/// Mass, inertia and placement of a [[body]] entry. Throws InputError naming the body.
Body make_body(const BodySpec& spec, const Materials& materials, const std::string& directory);

}  // namespace ejecta
