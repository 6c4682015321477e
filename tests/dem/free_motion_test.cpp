#include <gtest/gtest.h>

#include <cmath>

#include "dem/particles.hpp"
#include "dem/rotation.hpp"

namespace ejecta {
namespace {

Case cuboid_case() {
  Case c;
  c.environment.gravity.setZero();
  c.materials = {MaterialSpec{.name = "stone"}};
  BodySpec b;
  b.name = "cuboid";
  b.shape = ShapeKind::box;
  b.size = Vec3(20e-3, 15e-3, 10e-3);
  b.material = "stone";
  b.spin = Vec3(0.1, 100, 0.1);
  c.bodies = {b};
  return c;
}

/// Torque-free cuboid (Dzhanibekov): the exact period is 4K(k)/w_p, flips every 0.521929 s.
TEST(FreeMotion, CuboidFlipsHundredTimes) {
  Particles p = make_particles(cuboid_case());
  const double energy = p.energy().kinetic;
  const Vec3 momentum = p.bodies()[0].angular_momentum();
  EXPECT_NEAR(2 * energy, 3.3750064e-3, 1e-10);
  EXPECT_NEAR(momentum.norm(), 3.37500335e-5, 1e-13);
  const double dt = 1e-4;
  std::vector<double> crossings;
  const auto spin_y = [&] {
    return (p.bodies()[0].orientation.conjugate() * p.bodies()[0].angular_velocity).y();
  };
  double before = spin_y(), energy_error = 0, momentum_error = 0;
  for (int n = 0; n < 522500; ++n) {
    p.advance(dt);
    const double now = spin_y();
    if ((now < 0) != (before < 0)) crossings.push_back(p.time() - dt * now / (now - before));
    before = now;
    energy_error = std::max(energy_error, std::abs(p.energy().kinetic / energy - 1));
    momentum_error =
        std::max(momentum_error, (p.bodies()[0].angular_momentum() - momentum).norm() / momentum.norm());
  }
  ASSERT_EQ(crossings.size(), 100u);
  EXPECT_NEAR(crossings[0], 0.299601, 0.0003);
  EXPECT_NEAR((crossings[99] - crossings[0]) / 99, 0.521929, 1e-3 * 0.521929);
  EXPECT_LT(energy_error, 1e-6);
  EXPECT_LT(momentum_error, 1e-6);
  RecordProperty("energy_error", std::to_string(energy_error));
}

/// Through most of a flip, against a step eight times finer; steps short enough not to be divided further.
TEST(FreeMotion, RotationIsOfFourthOrder) {
  const Vec3 inertia(2.19375e-7, 3.375e-7, 4.21875e-7), momentum = inertia.cwiseProduct(Vec3(0.1, 100, 0.1));
  const auto at_end = [&](int steps) {
    Quat q = Quat::Identity();
    for (int n = 0; n < steps; ++n) rotate_free(q, momentum, inertia, 0.32 / steps);
    return q;
  };
  const Quat exact = at_end(12800);
  const double coarse = exact.angularDistance(at_end(800)), fine = exact.angularDistance(at_end(1600));
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.1);
  EXPECT_LT(fine, 1e-6);
}

TEST(FreeMotion, ParabolaIsExactAndReleaseIsKept) {
  Case c = cuboid_case();
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.bodies[0].velocity = Vec3(3, 0, 1);
  c.bodies[0].release_at = 0.02;
  Particles p = make_particles(c);
  EXPECT_EQ(p.bodies()[0].velocity, Vec3(0, 0, 0));
  p.advance(0.02);
  EXPECT_EQ(p.bodies()[0].position, Vec3(0, 0, 0));
  p.advance(0.1);
  EXPECT_NEAR(p.bodies()[0].position.x(), 0.3, 1e-12);
  EXPECT_NEAR(p.bodies()[0].position.z(), 0.1 - 0.5 * 9.81 * 0.01, 1e-12);
}

}  // namespace
}  // namespace ejecta
