#include "dem/course.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "base/error.hpp"
#include "scene.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using testing::HasSubstr;

/// Prescribed bodies: formulas and paths.
namespace {

constexpr double kPi = std::numbers::pi;

BodySpec driven(BodySpec b) {
  b.motion = Motion::prescribed;
  return b;
}

Case one_body(const BodySpec& b) {
  Case c = scene(stone());
  c.bodies = {b};
  return c;
}

/// Steps of odd lengths, none of which divides the period.
void advance(Particles& p, double until) {
  while (p.time() < until) p.advance(std::min(1.3e-4, until - p.time()));
}

TEST(Course, ABodyThatSwingsComesBackAfterAPeriod) {
  BodySpec b = driven(ball("swing", 5e-3, Vec3(1e-3, 2e-3, 3e-3)));
  b.velocity_formula = {{"0.2 * cos(100 * t)", "0", "0.1 * sin(100 * t)"}};
  Particles p = make_particles(one_body(b));
  const double period = 2 * kPi / 100;
  advance(p, period / 4);
  EXPECT_NEAR(p.bodies()[0].position.x(), 1e-3 + 2e-3, 1e-14);
  EXPECT_NEAR(p.bodies()[0].position.z(), 3e-3 + 1e-3, 1e-14);
  advance(p, 3 * period);
  EXPECT_LT((p.bodies()[0].position - b.position).norm(), 1e-14)
      << "velocity times step would be off by microns";
  EXPECT_NEAR(p.bodies()[0].velocity.x(), 0.2, 1e-12);
}

/// Even in one step as long as the whole motion, with a jump in it.
TEST(Course, TheWayIsTheIntegralWhateverTheStep) {
  const Course sudden({"step(t - 0.0123)", "exp(3 * t)", "0"}, {"0", "0", "0"});
  EXPECT_NEAR(sudden.way(0.0, 1.0).x(), 1 - 0.0123, 1e-12);
  EXPECT_NEAR(sudden.way(0.0, 1.0).y(), (std::exp(3.0) - 1) / 3, 1e-12);
}

TEST(Course, AWobbleTurnsBackToo) {
  BodySpec b = driven(box("flap", Vec3(8e-3, 4e-3, 2e-3), Vec3(0, 0, 0)));
  b.spin_formula = {{"0", "30 * cos(50 * t)", "0"}};
  Particles p = make_particles(one_body(b));
  const Quat before = p.bodies()[0].orientation;
  advance(p, 2 * kPi / 50 / 4);
  EXPECT_NEAR(p.bodies()[0].orientation.angularDistance(before), 30.0 / 50, 1e-12);
  advance(p, 2 * kPi / 50);
  EXPECT_LT(p.bodies()[0].orientation.angularDistance(before), 1e-7);
}

/// An axis that turns about z at n while the body turns about it at w is, seen in the frame that goes with
/// the axis, a turn at a constant rate: the exact orientation is known.
TEST(Course, AnAxisThatTurnsIsFollowed) {
  const double n = 40, w = 70, t = 0.11;
  const Course course({"0", "0", "0"}, {"70 * cos(40 * t)", "70 * sin(40 * t)", "0"});
  const Vec3 seen(w, 0, -n);
  const Quat exact = Quat(Eigen::AngleAxisd(n * t, Vec3::UnitZ())) *
                     Quat(Eigen::AngleAxisd(seen.norm() * t, seen.normalized()));
  Quat q = Quat::Identity();
  for (int i = 0; i < 50; ++i) course.turn(q, i * t / 50, t / 50);
  EXPECT_LT(q.angularDistance(exact), 1e-5);
  Quat finer = Quat::Identity();
  for (int i = 0; i < 800; ++i) course.turn(finer, i * t / 800, t / 800);
  EXPECT_LT(finer.angularDistance(exact), 1e-7);
}

/// Euler's equations would make a free brick tumble; what is prescribed turns as it is told.
TEST(Course, AConstantSpinStaysConstant) {
  BodySpec b = driven(box("brick", Vec3(8e-3, 4e-3, 2e-3), Vec3(0, 0, 0), Vec3(0.5, 0, 0)));
  b.spin = Vec3(30, 40, 0);
  Particles p = make_particles(one_body(b));
  advance(p, 0.1);
  const Quat exact(Eigen::AngleAxisd(5.0, Vec3(0.6, 0.8, 0)));
  EXPECT_LT(p.bodies()[0].orientation.angularDistance(exact), 1e-7);
  EXPECT_EQ(p.bodies()[0].angular_velocity, b.spin);
  EXPECT_NEAR(p.bodies()[0].position.x(), 0.05, 1e-15);
}

TEST(Course, AReleasedBodyFollowsTheClockOfTheRun) {
  BodySpec b = driven(ball("late", 5e-3, Vec3(0, 0, 0)));
  b.velocity_formula = {{"t", "0", "0"}};
  b.release_at = 0.02;
  Particles p = make_particles(one_body(b));
  for (int n = 1; n <= 300; ++n) p.advance(1e-4);
  EXPECT_NEAR(p.bodies()[0].position.x(), 0.5 * (0.03 * 0.03 - 0.02 * 0.02), 1e-12);
  EXPECT_NEAR(p.bodies()[0].velocity.x(), 0.03, 1e-12);
}

/// What drives the body pays for its speed and for what it pushes.
TEST(Course, TheLedgerIsClosed) {
  Case c = scene(stone());
  BodySpec b = driven(box("hammer", Vec3(8e-3, 8e-3, 4e-3), Vec3(0, 0, 0)));
  b.velocity_formula = {{"0.5 * sin(200 * t)", "0", "0"}};
  b.spin_formula = {{"0", "0", "20 * sin(90 * t)"}};
  c.bodies = {b, ball("pushed", 6e-3, Vec3(8e-3, 0.5e-3, 0))};
  Particles p = make_particles(c);
  const double before = p.energy().ledger();
  for (int n = 0; n < 300; ++n) p.advance(1e-4);
  EXPECT_GT(p.bodies()[1].velocity.x(), 0.1) << "was hit";
  EXPECT_GT(p.energy().work, 1e-6);
  EXPECT_NEAR(p.energy().ledger(), before, 1e-3 * p.energy().work);
}

TEST(Course, RestoresToTheSameBitsWhereverItIsStopped) {
  Case c = scene(stone());
  BodySpec b = driven(box("hammer", Vec3(8e-3, 8e-3, 4e-3), Vec3(0, 0, 0)));
  b.velocity_formula = {{"0.5 * sin(200 * t)", "0", "0"}};
  b.spin_formula = {{"3 * cos(70 * t)", "0", "20 * sin(90 * t)"}};
  b.release_at = 0.00105;  // within a step
  BodySpec free = ball("free", 6e-3, Vec3(8e-3, 0.5e-3, 0), Vec3(0.1, 0, 0));
  free.release_at = 0.00105;
  c.bodies = {b, free};
  Particles whole = make_particles(c);
  for (int n = 0; n < 11; ++n) whole.advance(1e-4);
  Particles stopped = make_particles(c);
  stopped.restore(whole.state());
  for (int n = 0; n < 200; ++n) {
    EXPECT_EQ(stopped.bodies()[0].angular_velocity, whole.bodies()[0].angular_velocity);
    whole.advance(1e-4);
    stopped.advance(1e-4);
    if (n == 100) {
      Particles again = make_particles(c);
      again.restore(stopped.state());
      stopped = std::move(again);
    }
  }
  EXPECT_EQ(stopped.state(), whole.state());
  EXPECT_GT(whole.bodies()[1].velocity.norm(), 0.05) << "was released";
}

class PathFile : public testing::Test {
 protected:
  BodySpec body(const std::string& text) {
    std::ofstream(scratch_.path() / "path.csv") << text;
    BodySpec b = driven(box("flap", Vec3(8e-3, 4e-3, 2e-3), Vec3(10e-3, 0, 0)));
    b.path = (scratch_.path() / "path.csv").string();
    b.rotation_axis = Vec3(0, 0, 2);
    return b;
  }
  ScratchDirectory scratch_;
};

TEST_F(PathFile, MeetsEveryPointAndRestsBetweenEqualOnes) {
  const BodySpec b = body(
      "# drawn\nt [ms], z [mm], x [cm], rotation [deg]\n0, 1, 0, 0\n10, 1, 0, 0\n20, 5, 1, 90\n"
      "30, 5, 1, 90\n40, 1, 0, 90\n");
  Particles p = make_particles(one_body(b));
  EXPECT_NEAR(p.bodies()[0].position.z(), 1e-3, 1e-16);
  advance(p, 7e-3);
  EXPECT_NEAR(p.bodies()[0].position.z(), 1e-3, 1e-15) << "no swing before it starts";
  advance(p, 15e-3);
  EXPECT_GT(p.bodies()[0].velocity.z(), 0.4);
  EXPECT_GT(p.bodies()[0].angular_velocity.z(), 0.0);
  advance(p, 25e-3);
  EXPECT_NEAR(p.bodies()[0].position.z(), 5e-3, 1e-14) << "no overshoot";
  EXPECT_NEAR(p.bodies()[0].position.x(), 20e-3, 1e-14);
  EXPECT_LT(p.bodies()[0].orientation.angularDistance(Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()))), 1e-7);
  advance(p, 40e-3);
  EXPECT_NEAR(p.bodies()[0].position.z(), 1e-3, 1e-14);
}

/// The velocity is the derivative of the place and does not jump.
TEST_F(PathFile, VelocityAndPlaceAgree) {
  const auto course = make_course(body("t [s], x [m]\n0, 0\n1, 2\n2, 3\n4, 3.5\n5, 1\n"), "");
  for (double t = 0.05; t < 4.9; t += 0.01) {
    EXPECT_NEAR(course->way(t - 1e-5, 2e-5).x() / 2e-5, course->velocity(t).x(), 1e-4) << t;
    EXPECT_NEAR(course->velocity(t + 1e-9).x(), course->velocity(t - 1e-9).x(), 1e-6) << t;
  }
}

TEST_F(PathFile, WrongOnesAreRefusedWithTheirLine) {
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      make_body(body(text), Materials(one_body({})), "");
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal("t, x [mm]\n0, 1\n"), HasSubstr("path.csv:1: error: the column \"t\" has no unit"));
  EXPECT_THAT(refusal("t [mm], x [mm]\n0, 1\n"), HasSubstr("\"mm\" is no unit of a time"));
  EXPECT_THAT(refusal("t [ms], height [mm]\n0, 1\n"), HasSubstr("there is no column \"height\""));
  EXPECT_THAT(refusal("t [ms]\n0\n1\n"), HasSubstr("at least one other"));
  EXPECT_THAT(refusal("t [ms], x [mm]\n0, 1\n# still\n2\n"),
              HasSubstr("path.csv:4: error: 1 values for 2 columns"));
  EXPECT_THAT(refusal("t [ms], x [mm]\n0, 1\n2, a\n"), HasSubstr("   3 | 2, a\n      |    ^"));
  EXPECT_THAT(refusal("t [ms], x [mm]\n0, 1\n0, 2\n"), HasSubstr("the column t does not increase"));
  EXPECT_THAT(refusal("t [ms], x [mm]\n0, 1\n"), HasSubstr("at least two rows"));
  EXPECT_THAT(refusal(""), HasSubstr("at least two rows"));
}

/// A swing is seen for what it is even when it starts from rest.
TEST(Course, ThePaceIsThatOfTheWholeRun) {
  const Course swing({"0.2 * sin(100 * t)", "0", "0"}, {"0", "0", "0"});
  const Course::Pace pace = swing.pace(0.5);
  EXPECT_NEAR(pace.speed.x(), 0.2, 1e-6);
  EXPECT_EQ(pace.speed.y(), 0.0);
  EXPECT_GT(pace.change, 4 * 100 / (2 * kPi));
  EXPECT_LT(pace.change, 2 * 100.0);
  EXPECT_EQ(Course(Vec3(1, 0, 0), Vec3(0, 0, 3)).pace(1.0).change, 0.0);
}

}  // namespace
