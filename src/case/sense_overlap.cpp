#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "case/findings.hpp"

/// Bodies that are inside each other at the start.
namespace ejecta {
namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

struct Block {
  Vec3 centre, half;
  Mat3 axes;  ///< columns, in the world
};

/// A body as far as this check needs it.
struct Solid {
  std::vector<Ball> balls;
  std::vector<Block> blocks;
};

Solid solid(const BodySpec& b) {
  const Mat3 turn = Eigen::AngleAxisd(b.rotation_angle, b.rotation_axis.normalized()).toRotationMatrix();
  Solid s;
  if (b.shape == ShapeKind::sphere) s.balls.push_back({b.position, 0.5 * b.diameter});
  if (b.shape == ShapeKind::box) s.blocks.push_back({b.position, 0.5 * b.size, turn});
  if (b.shape == ShapeKind::cluster || b.shape == ShapeKind::superquadric)
    s.balls.push_back({b.position, 0.5 * b.size.minCoeff()});  // the ball that is surely inside
  return s;
}

double overlap(const Ball& a, const Ball& b) { return a.radius + b.radius - (a.centre - b.centre).norm(); }

double overlap(const Ball& ball, const Block& block) {
  const Vec3 local = block.axes.transpose() * (ball.centre - block.centre);
  const Vec3 closest = local.cwiseMax(-block.half).cwiseMin(block.half);
  const double outside = (local - closest).norm();
  if (outside > 0.0) return ball.radius - outside;
  return ball.radius + (block.half - local.cwiseAbs()).minCoeff();
}

/// Separating axes of two oriented boxes (Gottschalk et al. 1996): the least overlap over the 15 candidates.
double overlap(const Block& a, const Block& b) {
  std::vector<Vec3> candidates;
  for (int i = 0; i < 3; ++i) {
    candidates.push_back(a.axes.col(i));
    candidates.push_back(b.axes.col(i));
    for (int j = 0; j < 3; ++j) {
      const Vec3 cross = a.axes.col(i).cross(b.axes.col(j));
      if (cross.norm() > 1e-6) candidates.push_back(cross.normalized());
    }
  }
  double least = 1e300;
  for (const Vec3& n : candidates) {
    const double reach =
        (a.axes.transpose() * n).cwiseAbs().dot(a.half) + (b.axes.transpose() * n).cwiseAbs().dot(b.half);
    least = std::min(least, reach - std::abs(n.dot(a.centre - b.centre)));
  }
  return least;
}

double overlap(const Solid& a, const Solid& b) {
  double deepest = -1e300;
  for (const Ball& p : a.balls) {
    for (const Ball& q : b.balls) deepest = std::max(deepest, overlap(p, q));
    for (const Block& q : b.blocks) deepest = std::max(deepest, overlap(p, q));
  }
  for (const Block& p : a.blocks) {
    for (const Ball& q : b.balls) deepest = std::max(deepest, overlap(q, p));
    for (const Block& q : b.blocks) deepest = std::max(deepest, overlap(p, q));
  }
  return deepest;
}

double smallest_radius(const Solid& s) {
  double smallest = 1e300;
  for (const Ball& b : s.balls) smallest = std::min(smallest, b.radius);
  for (const Block& b : s.blocks) smallest = std::min(smallest, b.half.minCoeff());
  return smallest;
}

/// Who goes behind whom on the belt, and who would lie on whom.
void check_belt(const Case& c, Findings& found) {
  const auto named = [&](const std::string& name) {
    return std::find_if(c.bodies.begin(), c.bodies.end(), [&](const BodySpec& b) { return b.name == name; });
  };
  for (std::size_t n = 0; n < c.bodies.size(); ++n) {
    const BodySpec& b = c.bodies[n];
    if (!b.on_belt) continue;
    const std::string key = fmt::format("body.{}", n);
    if (!b.behind.empty()) {
      const auto ahead = named(b.behind);
      if (ahead == c.bodies.end() || !ahead->on_belt) {
        found.error(
            key + ".behind",
            fmt::format("there is no body \"{}\"{}", b.behind, ahead == c.bodies.end() ? "" : " on the belt"),
            "the name of a [[body]] that is on_belt", fmt::format("behind = \"{}\"", c.bodies[0].name));
        continue;
      }
      const BodySpec* next = &b;
      for (std::size_t steps = 0; next && !next->behind.empty(); ++steps) {
        if (steps > c.bodies.size()) {
          found.error(key + ".behind", fmt::format("\"{}\" would go behind itself", b.name),
                      "a first body without `behind`", "along = \"-26 mm\"");
          break;
        }
        const auto after = named(next->behind);
        next = after == c.bodies.end() ? nullptr : &*after;
      }
      continue;
    }
    for (std::size_t m = 0; m < n; ++m) {
      const BodySpec& other = c.bodies[m];
      if (!other.on_belt || !other.behind.empty() || other.along != b.along || other.across != b.across)
        continue;
      found.error(
          key + ".on_belt",
          fmt::format("\"{}\" and \"{}\" would start in the same place: [launch] is one for all bodies",
                      other.name, b.name),
          "a place of its own on the belt: `behind` and `gap`, or `along` and `across`",
          fmt::format("behind = \"{}\", gap = \"12 mm\"", other.name));
      break;
    }
  }
}

}  // namespace

void sense_overlaps(const Case& c, Findings& found) {
  constexpr double allowed = 0.05;  // of the smaller radius: bodies resting on each other do overlap a little
  check_belt(c, found);
  std::vector<Solid> solids;
  for (const BodySpec& b : c.bodies) solids.push_back(solid(b));
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (c.bodies[i].on_belt || c.bodies[j].on_belt) continue;  // not at their `position`
      const auto comes_later = [](const BodySpec& b) { return b.enters_at || b.copies > 1; };
      if (comes_later(c.bodies[i]) || comes_later(c.bodies[j])) continue;
      const double depth = overlap(solids[i], solids[j]);
      Vec3 apart = c.bodies[i].position;  // beyond the reach of both, however they are turned
      apart.z() =
          c.bodies[j].position.z() + half_extent(c.bodies[i]).norm() + half_extent(c.bodies[j]).norm();
      if (depth > allowed * std::min(smallest_radius(solids[i]), smallest_radius(solids[j])))
        found.error(fmt::format("body.{}.position", i),
                    fmt::format("\"{}\" overlaps \"{}\" by {:.3g} mm at the start", c.bodies[i].name,
                                c.bodies[j].name, 1e3 * depth),
                    "bodies apart from each other", place_line("position", apart));
    }
}

}  // namespace ejecta
