#pragma once
#include "dem/parts.hpp"

namespace ejecta {

/// x, y, z and a fourth number: one register.
using Vec4 = double __attribute__((vector_size(4 * sizeof(double))));
using Vec4f = float __attribute__((vector_size(4 * sizeof(float))));
/// Four numbers at any address.
using LooseVec4 = double __attribute__((vector_size(4 * sizeof(double)), aligned(8), may_alias));

inline Vec4 vec4(const Vec3& v) { return Vec4{v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 vec3(const Vec4& v) { return {v[0], v[1], v[2]}; }
inline double dot(const Vec4& a, const Vec4& b) {
  const Vec4 p = a * b;
  return (p[0] + p[1]) + (p[2] + p[3]);
}

/// A free sphere while Particles::advance() runs: what a sub-step reads and writes of it besides its BallRow,
/// which holds its place. Memory, not arithmetic, sets the pace here. The Body is brought up to date at the
/// end.
struct alignas(32) SphereState {
  Vec4 velocity;  // m/s; 1/kg
  Vec4 momentum;  // angular, kg m2/s; 1/(kg m2)
  Vec4f moved;    // m, since candidates were listed
  Vec4f turn;     // rad, not yet given to the orientation: nothing but pictures depends on it

  double inverse_mass() const { return velocity[3]; }
  double inverse_inertia() const { return momentum[3]; }
};

/// What acts on a sphere. Fourth numbers are zero.
struct Push {
  Vec4 acceleration;   // m/s2, by gravity and load
  Vec4 twist;          // N m, by the load
  Vec4 force, torque;  // N, N m, of contacts
};

/// Half a kick by the new forces. Returns terms whose sum is the power of the contacts on the sphere, W.
inline Vec4 kick_sphere(SphereState& s, const Push& p, double dt) {
  s.velocity += 0.5 * dt * (p.acceleration + s.inverse_mass() * p.force);
  s.momentum += 0.5 * dt * (p.torque + p.twist);
  return p.force * s.velocity + p.torque * (s.inverse_inertia() * s.momentum);
}

/// Half a kick and the drift of velocity Verlet. Returns the square of the distance moved since the listing,
/// m2.
inline float drift_sphere(SphereState& s, BallRow& row, const Push& p, double dt) {
  const Vec4 kick = 0.5 * dt * (p.acceleration + s.inverse_mass() * p.force);
  const Vec4 spin_kick = 0.5 * dt * (p.torque + p.twist), step{dt, dt, dt, 0.0};
  s.velocity += kick;
  s.momentum += spin_kick;
  const Vec4 way = step * s.velocity;
  s.moved += __builtin_convertvector(way, Vec4f);
  s.turn += __builtin_convertvector(s.inverse_inertia() * step * s.momentum, Vec4f);
  auto* rows = reinterpret_cast<LooseVec4*>(&row);
  rows[0] += way;
  // Damping and friction need velocities at the whole step: extrapolated, to keep the second order.
  rows[1] = s.velocity + kick;
  const Vec4 spin = s.inverse_inertia() * (s.momentum + spin_kick);
  rows[2] = Vec4{spin[0], spin[1], spin[2], row.material};
  const Vec4f squares = s.moved * s.moved;
  return squares[0] + squares[1] + squares[2];
}

}  // namespace ejecta
