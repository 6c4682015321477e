#pragma once
#include <span>
#include <string>
#include <vector>

#include "dem/body.hpp"
#include "dem/loads.hpp"

namespace ejecta {

/// J. Dissipated: taken by damping and friction since the start; work: done by loads, moving walls and
/// prescribed bodies.
struct DemEnergy {
  double kinetic = 0.0, potential = 0.0, elastic = 0.0, dissipated = 0.0, work = 0.0;
  /// kinetic + potential + elastic + dissipated - work: constant.
  double ledger() const { return kinetic + potential + elastic + dissipated - work; }
};

/// All bodies that move and touch, with their walls. Advances itself; knows no fluid.
class Particles {
 public:
  explicit Particles(const Vec3& gravity) : gravity_(gravity) {}

  /// Moves all bodies over dt (s) in equal sub-steps no longer than stable_dt(); gravity acts, loads[i] acts
  /// on body i and is held constant (empty: none).
  void advance(double dt, std::span<const Load> loads = {});
  /// The largest sub-step, s.
  double stable_dt() const;
  double time() const { return time_; }
  std::span<const Body> bodies() const { return bodies_; }

  /// Returns the index of the new body.
  int add(Body body);
  void remove(int index);
  /// Sets position, orientation and velocities of a body from the given one (launch).
  void place(int index, const Vec3& position, const Quat& orientation, const Vec3& velocity,
             const Vec3& angular_velocity);

  DemEnergy energy() const;
  /// Everything that changes in time, contact history included: restore() continues to the same bits.
  std::vector<double> state() const;
  void restore(std::span<const double> state);

 private:
  void substep(double dt, std::span<const Load> loads);
  Vec3 gravity_;
  double time_ = 0.0;
  double largest_step_ = 1e-4;
  std::vector<Body> bodies_;
  std::vector<Vec3> momentum_;  // angular, world
};

/// Bodies, materials, walls and contact law of a case.
Particles make_particles(const Case& config);

}  // namespace ejecta
