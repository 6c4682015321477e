#pragma once
#include <string>

#include "dem/particles.hpp"

/// Small cases for tests.
namespace ejecta {

inline Case scene(const MaterialSpec& material) {
  Case c;
  c.environment.gravity.setZero();
  c.materials = {material};
  return c;
}

inline BodySpec ball(const std::string& name, double diameter, const Vec3& position,
                     const Vec3& velocity = Vec3(0, 0, 0)) {
  BodySpec b;
  b.name = name;
  b.shape = ShapeKind::sphere;
  b.diameter = diameter;
  b.material = "stone";
  b.position = position;
  b.velocity = velocity;
  return b;
}

inline BodySpec box(const std::string& name, const Vec3& size, const Vec3& position,
                    const Vec3& velocity = Vec3(0, 0, 0)) {
  BodySpec b = ball(name, 0, position, velocity);
  b.shape = ShapeKind::box;
  b.size = size;
  return b;
}

inline WallSpec floor_at(double z, const std::string& material = "stone") {
  WallSpec w;
  w.name = "floor";
  w.point = Vec3(0, 0, z);
  w.material = material;
  return w;
}

/// The paper's material (Table 2).
inline MaterialSpec stone() {
  MaterialSpec m;
  m.name = "stone";
  return m;
}

}  // namespace ejecta
