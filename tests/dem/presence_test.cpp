#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "case/case.hpp"
#include "scene.hpp"

/// Bodies that enter, leave, and come back on the other side.
namespace ejecta {
namespace {

using testing::HasSubstr;

Case ring() {
  Case c = scene(stone());
  c.domain.x = {0.0, 0.1};
  c.domain.periodic = {"x"};
  return c;
}

/// Two bodies that meet at `middle`, one faster and off the common axis so that they turn.
Case meeting(double middle, const BodySpec& like) {
  Case c = ring();
  for (const double side : {-1.0, 1.0}) {
    BodySpec b = like;
    b.name = side < 0 ? "left" : "right";
    b.position = Vec3(middle + side * 8e-3, side * 1e-3, 0);
    b.velocity = Vec3(-side * 0.5, 0, 0);
    b.rotation_axis = Vec3(1, 2, 3);  // faces that are not parallel
    b.rotation_angle = side;
    if (b.position.x() >= 0.1) b.position.x() -= 0.1;
    c.bodies.push_back(b);
  }
  return c;
}

/// A collision across the side is the collision in the middle.
TEST(Periodic, SidesAreNoPlaceOfTheirOwn) {
  for (const BodySpec& like :
       {ball("", 10e-3, Vec3(0, 0, 0)), box("", Vec3::Constant(8e-3), Vec3(0, 0, 0))}) {
    Particles inside = make_particles(meeting(0.05, like)), across = make_particles(meeting(0.1, like));
    for (int n = 0; n < 100; ++n) {
      inside.advance(5e-4);
      across.advance(5e-4);
    }
    ASSERT_GT(inside.peaks(0).time, 0.0) << "they met";
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_NEAR((inside.bodies()[b].velocity - across.bodies()[b].velocity).norm(), 0, 1e-9);
      EXPECT_NEAR((inside.bodies()[b].angular_velocity - across.bodies()[b].angular_velocity).norm(), 0,
                  1e-6);
      EXPECT_GE(across.bodies()[b].position.x(), 0.0);
      EXPECT_LT(across.bodies()[b].position.x(), 0.1 + 0.5 * 5e-4);
    }
    EXPECT_NEAR(across.energy().ledger(), inside.energy().ledger(), 1e-9);
  }
}

TEST(Periodic, TooNarrowIsRefused) {
  Case c = ring();
  c.bodies = {ball("boulder", 60e-3, Vec3(0.05, 0, 0))};
  try {
    make_particles(c);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("boulder"));
    EXPECT_THAT(e.what(), HasSubstr("at least 0.12 m"));
  }
}

TEST(Presence, ABodyWaitsForItsPlace) {
  Case c = scene(stone());
  BodySpec first = ball("first", 10e-3, Vec3(0, 0, 0), Vec3(1, 0, 0)), second = first;
  second.name = "second";
  second.enters_at = 2e-3;
  c.bodies = {first, second};
  Particles p = make_particles(c);
  p.advance(3e-3);
  p.advance(1e-3);
  EXPECT_EQ(p.presence(1), Presence::waiting) << "the first is still 4 mm away";
  EXPECT_EQ(p.energy().kinetic, 0.5 * p.bodies()[0].mass);
  for (int n = 0; n < 8; ++n) p.advance(1e-3);
  EXPECT_EQ(p.presence(1), Presence::here);
  EXPECT_GE((p.bodies()[0].position - p.bodies()[1].position).norm(), 10e-3);
  EXPECT_EQ(p.bodies()[1].velocity.x(), 1.0);
  EXPECT_TRUE(p.contacts().empty());
}

TEST(Presence, TheLedgerStaysClosedAndAResumeKnowsWhoIsThere) {
  Case c = scene(stone());
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.walls = {floor_at(0)};
  c.domain.x = {-0.04, 0.04};
  for (int n = 0; n < 20; ++n) {
    BodySpec b = n % 2
                     ? box("box " + std::to_string(n), Vec3::Constant(6e-3), Vec3(0, 0, 5e-3), Vec3(1, 0, 0))
                     : ball("ball " + std::to_string(n), 6e-3, Vec3(0, 0, 5e-3), Vec3(-1, 0, 0));
    b.enters_at = 5e-3 * n;
    c.bodies.push_back(b);
  }
  Particles p = make_particles(c);
  const double start = p.energy().ledger();
  for (int n = 0; n < 80; ++n) p.advance(1e-3);
  const std::vector<double> stored = p.state();
  Particles q = make_particles(c);
  q.restore(stored);
  for (int n = 0; n < 120; ++n) {
    p.advance(1e-3);
    q.advance(1e-3);
  }
  int gone = 0;
  for (int n = 0; n < 20; ++n) gone += p.presence(n) == Presence::gone;
  EXPECT_GT(gone, 5);
  EXPECT_EQ(p.state(), q.state());
  EXPECT_NEAR(p.energy().ledger(), start, 1e-3 * p.energy().dissipated);
}

}  // namespace
}  // namespace ejecta
