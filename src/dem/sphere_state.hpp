#pragma once
#include "dem/parts.hpp"

namespace ejecta {

/// x, y, z and a fourth number that is zero: one register.
using Vec4 = double __attribute__((vector_size(4 * sizeof(double))));
/// Four numbers at any address.
using LooseVec4 = double __attribute__((vector_size(4 * sizeof(double)), aligned(8), may_alias));

inline Vec4 vec4(const Vec3& v) { return Vec4{v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 vec3(const Vec4& v) { return {v[0], v[1], v[2]}; }
inline double dot(const Vec4& a, const Vec4& b) {
  const Vec4 p = a * b;
  return (p[0] + p[1]) + (p[2] + p[3]);
}

/// A free sphere while Particles::advance() runs: all that a sub-step reads and writes of it, packed. The
/// Body is brought up to date at the end.
struct alignas(64) SphereState {
  Vec4 position, velocity, momentum;  // m, m/s, angular kg m2/s
  Vec4 force, torque;                 // N, N m, of contacts at the last sub-step
  Vec4 listed_at;                     // m, where it was when candidates were listed
  Vec4 turn;  // rad, not yet given to the orientation: nothing but pictures depends on it
  double inverse_mass = 0.0, inverse_inertia = 0.0;
  double unused[2] = {0.0, 0.0};
};

/// Half a kick and the drift of velocity Verlet; `push`: acceleration by gravity and load, `twist`: torque of
/// the load. Clears the contact forces. Returns the square of the distance moved since the listing, m2.
inline double drift_sphere(SphereState& s, BallRow& row, const Vec4& push, const Vec4& twist, double dt) {
  const Vec4 kick = 0.5 * dt * (push + s.inverse_mass * s.force);
  const Vec4 spin_kick = 0.5 * dt * (s.torque + twist);
  s.velocity += kick;
  s.momentum += spin_kick;
  s.position += dt * s.velocity;
  s.turn += (dt * s.inverse_inertia) * s.momentum;
  s.force = s.torque = Vec4{};
  *reinterpret_cast<LooseVec4*>(&row.vx) = s.velocity + kick;
  *reinterpret_cast<LooseVec4*>(&row.wx) = s.inverse_inertia * (s.momentum + spin_kick);
  row.x = s.position[0];
  row.y = s.position[1];
  row.z = s.position[2];
  row.inverse_mass = s.inverse_mass;
  const Vec4 moved = s.position - s.listed_at;
  return dot(moved, moved);
}

/// Half a kick by the new forces. Returns the power of the contacts on the sphere, W.
inline double kick_sphere(SphereState& s, const Vec4& push, const Vec4& twist, double dt) {
  s.velocity += 0.5 * dt * (push + s.inverse_mass * s.force);
  s.momentum += 0.5 * dt * (s.torque + twist);
  return dot(s.force, s.velocity) + dot(s.torque, s.inverse_inertia * s.momentum);
}

}  // namespace ejecta
