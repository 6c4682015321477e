#include "dem/particles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "scene.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

/// A heap of balls, clusters and boxes that falls onto a floor between two walls.
Case heap(int count) {
  MaterialSpec m = stone();
  m.rolling_friction = 0.02;
  Case c = scene(m);
  c.environment.gravity = Vec3(0.5, 0, -9.81);
  c.walls = {floor_at(0)};
  WallSpec side;
  side.name = "side";
  side.kind = WallKind::plate;
  side.point = Vec3(60e-3, 0, 30e-3);
  side.normal = Vec3(-1, 0, 0);
  side.size = Vec3(0.2, 0.2, 5e-3);
  side.material = "stone";
  c.walls.push_back(side);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < count; ++n) {
    const Vec3 at = 11e-3 * Vec3(n % 5, n / 5 % 5, n / 25) + Vec3(-22e-3, -22e-3, 8e-3);
    BodySpec b = box("body " + std::to_string(n), Vec3(7e-3, 6e-3, 5e-3), at);
    if (n % 3 == 0) b = ball(b.name, 8e-3, at);
    if (n % 3 == 1) {
      b.shape = ShapeKind::cluster;
      b.size = Vec3::Constant(7e-3);
      b.sphere_diameter = 4e-3;
    }
    b.rotation_axis = Vec3(u(random), u(random), 1.5);
    b.rotation_angle = u(random);
    b.spin = 20 * Vec3(u(random), u(random), u(random));
    c.bodies.push_back(b);
  }
  return c;
}

TEST(Particles, SameBitsForAnyNumberOfThreads) {
  std::vector<double> states[3];
  const int threads = thread_count();
  for (int n = 0; n < 3; ++n) {
    set_thread_count(n + 1);
    Particles p = make_particles(heap(90));
    p.advance(0.01);
    states[n] = p.state();
  }
  set_thread_count(threads);
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(states[0], states[2]);
}

TEST(Particles, StopAndResumeGivesTheSameBits) {
  Particles p = make_particles(heap(45));
  p.advance(0.035);
  ASSERT_GT(p.contacts().size(), 5u);
  const std::vector<double> stored = p.state();
  Particles q = make_particles(heap(45));
  q.restore(stored);
  EXPECT_EQ(q.state(), stored);
  for (int n = 0; n < 20; ++n) {
    p.advance(1e-3);
    q.advance(1e-3);
  }
  EXPECT_EQ(p.state(), q.state());
}

TEST(Particles, BodiesComeAndGo) {
  Particles p = make_particles(heap(45));
  p.advance(0.035);
  Particles q = p;
  // A body far away changes nothing for the others, neither by coming nor by going.
  Body stranger = p.bodies()[0];
  stranger.name = "stranger";
  stranger.position = Vec3(5, 5, 5);
  q.add(stranger);
  q.advance(1e-3);
  p.advance(1e-3);
  q.remove(45);
  for (std::size_t n = 0; n < p.bodies().size(); ++n) {
    const Body &a = p.bodies()[n], &b = q.bodies()[n];
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.angular_velocity, b.angular_velocity);
    EXPECT_EQ(p.contact_force(static_cast<int>(n)), q.contact_force(static_cast<int>(n)));
  }
  // Once both have listed their pairs anew nothing of all that a state holds tells them apart.
  p.remove(p.add(stranger));
  p.advance(1e-3);
  q.advance(1e-3);
  EXPECT_EQ(p.state(), q.state());
  // Removing the first one renames all others and keeps their contacts.
  const std::size_t before = p.contacts().size();
  std::size_t of_first = 0;
  for (const ContactRecord& c : p.contacts()) of_first += c.a == 0 || c.b == 0;
  p.remove(0);
  EXPECT_EQ(p.bodies()[0].name, "body 1");
  p.advance(1e-7);
  EXPECT_EQ(p.contacts().size(), before - of_first);
}

TEST(Particles, HeapComesToRestAndItsLedgerCloses) {
  Case c = heap(30);
  c.environment.gravity.x() = 0;
  c.materials[0].rolling_friction = 0.1;
  Particles p = make_particles(c);
  const double start = p.energy().ledger();
  p.advance(0.5);
  const DemEnergy e = p.energy();
  EXPECT_LT(e.kinetic, 5e-3 * e.dissipated);
  EXPECT_NEAR(e.ledger(), start, 1e-3 * e.dissipated);
  for (const Body& b : p.bodies())
    if (b.velocity.norm() > 1e-4)
      std::printf("%s %g %g %g  v %g %g %g w %g %g %g\n", b.name.c_str(), b.position.x(), b.position.y(),
                  b.position.z(), b.velocity.x(), b.velocity.y(), b.velocity.z(), b.angular_velocity.x(),
                  b.angular_velocity.y(), b.angular_velocity.z());
  for (const Body& b : p.bodies()) EXPECT_GT(b.position.z(), 1e-3);
}

TEST(Particles, FluidLoadAccelerates) {
  Case c = scene(stone());
  c.bodies = {box("cube", Vec3::Constant(10e-3), Vec3(0, 0, 0))};
  Particles p = make_particles(c);
  const Load load{Vec3(0, 0, 0.27), Vec3(0, 4.5e-5, 0)};
  p.advance(0.01, std::vector<Load>{load});
  EXPECT_NEAR(p.bodies()[0].velocity.z(), 0.27 / 2.7e-3 * 0.01, 1e-12);
  EXPECT_NEAR(p.bodies()[0].angular_velocity.y(), 4.5e-5 / 4.5e-8 * 0.01, 1e-9);
  EXPECT_NEAR(p.energy().work, p.energy().kinetic, 1e-9 * p.energy().kinetic);
}

TEST(Particles, ClusterMayWeighWhatItsBoxWeighs) {
  Case c = scene(stone());
  c.bodies = {box("cluster", Vec3::Constant(10e-3), Vec3(0, 0, 0))};
  c.bodies[0].shape = ShapeKind::cluster;
  c.bodies[0].sphere_diameter = 5e-3;
  const Body plain = make_particles(c).bodies()[0];
  c.bodies[0].true_box_mass = true;
  const Body boxed = make_particles(c).bodies()[0];
  EXPECT_NEAR(plain.mass, 0.802 * 2.7e-3, 1e-6);
  EXPECT_NEAR(boxed.mass, 2.7e-3, 1e-12);
  EXPECT_NEAR(boxed.inertia.x(), 2.7e-3 * 2e-4 / 12, 1e-15);
}

/// Positions converge with the square of the step. (Hertz's dashpot, whose force sets in with the fourth root
/// of the overlap, and the history of friction, which starts at a whole step, are of first order.)
TEST(Particles, SecondOrderInTime) {
  double error[3];
  Vec3 reference(0, 0, 0);
  for (int n = 3; n >= 0; --n) {
    MaterialSpec m = stone();
    m.restitution = 1.0;
    m.friction = 0.0;
    Case c = scene(m);
    c.contact.time_step = n == 3 ? 5e-8 : 4e-6 / (1 << n);
    c.bodies = {ball("a", 10e-3, Vec3(-5e-3, 0, 0), Vec3(1, 0.4, 0)),
                ball("b", 10e-3, Vec3(5e-3, 0, 0), Vec3(-1, 0, 0.1))};
    Particles p = make_particles(c);
    p.advance(4e-4);  // within the contact
    EXPECT_EQ(p.contacts().size(), 1u);
    if (n == 3) reference = p.bodies()[0].position;
    else error[n] = (p.bodies()[0].position - reference).norm();
  }
  EXPECT_GT(std::log2(error[0] / error[2]) / 2, 1.7);
}

std::string refusal(const Case& c) {
  try {
    make_particles(c);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(BadInput, OverlappingBodiesAreNamed) {
  Case c = scene(stone());
  c.bodies = {ball("left", 10e-3, Vec3(0, 0, 0)), ball("right", 10e-3, Vec3(9e-3, 0, 0))};
  EXPECT_THAT(refusal(c), HasSubstr("body \"left\" overlaps body \"right\" by 1 mm"));
  c.bodies = {box("cube", Vec3::Constant(10e-3), Vec3(0, 0, 4e-3))};
  c.walls = {floor_at(0)};
  EXPECT_THAT(refusal(c), HasSubstr("body \"cube\" overlaps wall \"floor\" by 1 mm"));
  c.bodies[0].position.z() = 5e-3;
  EXPECT_EQ(refusal(c), "accepted");
}

TEST(BadInput, TimeStepTooLargeSaysWhatWouldWork) {
  Case c = scene(stone());
  c.bodies = {ball("b", 10e-3, Vec3(0, 0, 0))};
  c.contact.time_step = 1e-3;
  EXPECT_THAT(refusal(c), HasSubstr("contact.time_step = 0.001 s"));
  EXPECT_THAT(refusal(c),
              HasSubstr("6.54e-05 s resolves them"));  // a tenth of the Rayleigh time of the material
  c.contact.time_step = 1e-4;
  EXPECT_EQ(refusal(c), "accepted");
}

TEST(BadInput, MaterialsAndMasses) {
  Case c = scene(stone());
  c.bodies = {ball("b", 10e-3, Vec3(0, 0, 0))};
  c.bodies[0].mass = 0.0;
  EXPECT_THAT(refusal(c), HasSubstr("body \"b\": mass must be positive"));
  c.bodies[0].mass.reset();
  c.bodies[0].material = "gold";
  EXPECT_THAT(refusal(c), HasSubstr("known: \"stone\""));
  c.bodies[0].material = "stone";
  c.materials[0].youngs_modulus = 0;
  EXPECT_THAT(refusal(c), HasSubstr("friction needs a stiffness"));
  c.materials[0] = stone();
  c.contact.law = ContactLaw::linear;
  EXPECT_THAT(refusal(c), HasSubstr("contact.linear_stiffness"));
  c.contact.law = ContactLaw::hertz_mindlin;
  c.materials[0].restitution = std::nan("");
  EXPECT_THAT(refusal(c), HasSubstr("restitution"));
}

TEST(Particles, NotANumberStopsWithTheBodysName) {
  Case c = scene(stone());
  c.bodies = {ball("lost", 10e-3, Vec3(0, 0, 0))};
  Particles p = make_particles(c);
  const std::vector<Load> bad{{Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3(0, 0, 0)}};
  EXPECT_THROW(p.advance(1e-3, bad), DivergedError);
}

}  // namespace
}  // namespace ejecta
