#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "scene.hpp"

using namespace ejecta;

namespace {

/// A ball, a cluster and a box that touch each other on a floor.
Case three_on_a_floor() {
  Case c = scene(stone());
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.bodies = {ball("ball", 6e-3, Vec3(0, 0, 3.1e-3), Vec3(1, 0, 0)),
              box("box", Vec3(6e-3, 6e-3, 6e-3), Vec3(14e-3, 0, 3.1e-3)),
              box("cluster", Vec3(6e-3, 6e-3, 6e-3), Vec3(7e-3, 0, 3.1e-3))};
  c.bodies[2].shape = ShapeKind::cluster;
  c.bodies[2].sphere_diameter = 4e-3;
  c.walls = {floor_at(0)};
  return c;
}

class Damage {
 public:
  explicit Damage(std::vector<double> whole) : whole_(std::move(whole)) {}

  std::vector<double> next() {
    std::vector<double> s = whole_;
    for (int n = below(3); n >= 0; --n) damage(s);
    return s;
  }

 private:
  int below(std::size_t n) { return static_cast<int>(random_() % n); }
  double number() {
    const double odd[] = {-1.0,
                          0.5,
                          1e9,
                          1e300,
                          -1e300,
                          std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity()};
    return below(2) == 0 ? below(40) : odd[below(std::size(odd))];
  }
  void damage(std::vector<double>& s) {
    const auto at = s.begin() + below(s.size() + 1);
    switch (below(4)) {
      case 0:
        s.erase(at, s.end());
        break;
      case 1:
        s.insert(at, static_cast<std::size_t>(1 + below(30)), number());
        break;
      default:
        if (at != s.end()) *at = number();
    }
  }

  std::vector<double> whole_;
  std::mt19937 random_{11};
};

/// Which pairs were listed, and how, depends on when they were: a state holds them.
TEST(Restore, BallsNearARimGoOnToTheBit) {
  Case c = three_on_a_floor();
  c.bodies.clear();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      c.bodies.push_back(ball("b" + std::to_string(5 * i + j), 10e-3,
                              Vec3(0.016 * (i - 2), 0.016 * (j - 2), 5.02e-3),
                              Vec3(u(random), u(random), 0)));
  c.walls[0].kind = WallKind::box;
  c.walls[0].size = Vec3(0.1, 0.1, 0.01);
  c.walls[0].point = Vec3(0, 0, -5e-3);
  Particles p = make_particles(c);
  std::vector<std::vector<double>> states;
  constexpr int kSteps = 160;
  for (int n = 0; n < kSteps; ++n) {
    states.push_back(p.state());
    p.advance(1e-3);
  }
  for (int from = 0; from < kSteps; from += 7) {
    Particles q = make_particles(c);
    q.restore(states[static_cast<std::size_t>(from)]);
    for (int n = from; n < kSteps; ++n) q.advance(1e-3);
    EXPECT_EQ(q.state(), p.state()) << "from step " << from;
  }
}

TEST(Restore, ADamagedStateIsRestoredOrRefused) {
  Particles p = make_particles(three_on_a_floor());
  while (p.contacts().size() < 4) p.advance(1e-3);
  const std::vector<double> whole = p.state();
  Damage damage(whole);
  int refused = 0;
  for (int n = 0; n < 5000; ++n) {
    Particles q = p;
    try {
      q.restore(damage.next());
      EXPECT_GE(q.state().size(), 6u + 23u * 3u);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 2000);
  p.restore(whole);
  EXPECT_EQ(p.state(), whole);
}

TEST(Restore, TheMessageNamesWhatDoesNotFit) {
  Particles p = make_particles(three_on_a_floor());
  std::vector<double> s = p.state();
  s.pop_back();
  try {
    p.restore(s);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("saved state of the bodies"), std::string::npos) << e.what();
  }
}

}  // namespace
