#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "case/problem.hpp"
#include "dem/particles.hpp"

/// Particles: who overlaps whom before anything moves, and where there is room.
namespace ejecta {
namespace {

constexpr double kTouching = 1e-3;  // of the size: bodies that overlap less only touch

}  // namespace

double Particles::way_out(const SolidPair& pair, const Touch& touch) const {
  if (pair.a.kind != PartKind::polytope) return touch.overlap;
  const auto reach = [](const Polytope& solid, const Vec3& along) {
    return along.dot(support_exact(solid, along));
  };
  const auto reach_of = [&](const PartKey& part, int body, const Vec3& along) {
    const Body& b = bodies_[static_cast<std::size_t>(body)];
    return along.dot(b.position) +
           reach(*parts_.polytope(part.index).solid, b.orientation.toRotationMatrix().transpose() * along);
  };
  const Vec3& n = touch.normal;
  double other = 0.0;
  if (pair.body_b >= 0) {
    other = reach_of(pair.b, pair.body_b, n);
  } else {
    const Wall& wall = walls_[static_cast<std::size_t>(pair.b.index)];
    if (pair.b.kind == PartKind::wall_plane) other = wall.offset;
    else if (pair.b.kind == PartKind::wall_solid)
      other = reach(wall.solids[static_cast<std::size_t>(pair.b.solid)], n);
    else other = touch.side * wall.surface->regions()[static_cast<std::size_t>(pair.b.solid)].plane.offset;
  }
  return other + n.dot(pair.shift) + reach_of(pair.a, pair.body_a, -n);
}

Particles::Dent Particles::deepest(const CandidateSearch& found, int only) const {
  Dent worst;
  const auto note = [&](double overlap, double size, int body, int other, const Vec3& normal, double way) {
    if (only >= 0 && only != body && only != other) return;
    if (overlap > kTouching * size && overlap > worst.overlap)
      worst = {overlap, body, other, normal, std::max(overlap, way)};
  };
  for (const auto& [i, j] : found.balls()) {
    const BallRow &a = parts_.row(i), &b = parts_.row(j);
    const Vec3 apart = domain_.nearest(a.centre() - b.centre());
    const double overlap = a.radius + b.radius - apart.norm();
    note(overlap, std::min(a.radius, b.radius), parts_.body_of_ball(i), parts_.body_of_ball(j),
         apart.normalized(), overlap);
  }
  for (const auto& [i, n] : found.planes()) {
    const BallRow& ball = parts_.row(i);
    const WallPlane& plane = planes_[static_cast<std::size_t>(n)];
    const double overlap = ball.radius + plane.offset - plane.normal.dot(ball.centre());
    note(overlap, ball.radius, parts_.body_of_ball(i), -1 - plane.wall, plane.normal, overlap);
  }
  for (const SolidPair& p : found.solids()) {
    const Touch t = find_touch(p, parts_, bodies_, walls_, domain_);
    if (!(t.overlap > 0) || t.ghost) continue;
    note(t.thickness > 0 ? t.thickness : t.overlap, t.size, p.body_a,
         p.body_b >= 0 ? p.body_b : -1 - p.b.index, t.normal, way_out(p, t));
  }
  return worst;
}

std::optional<Vec3> Particles::clear_place(const Dent& dent) const {
  constexpr int kTries = 40, kShells = 24;
  const int body = dent.body;
  const Vec3 start = bodies_[static_cast<std::size_t>(body)].position;
  Particles trial = *this;
  Body& b = trial.bodies_[static_cast<std::size_t>(body)];
  const auto dent_at = [&](const Vec3& place) {
    b.position = place;
    trial.parts_.update(body, b, b.velocity, b.angular_velocity);
    trial.search_.find(trial.parts_, trial.bodies_, walls_, domain_, 0.0, nullptr);
    const Dent found = trial.deepest(trial.search_, body);
    return found.overlap > 0 ? found : trial.deepest_in_walls(static_cast<std::size_t>(body));
  };
  Dent next = dent;
  for (int n = 0; n < kTries; ++n) {  // out of the deepest, again and again
    next = dent_at(b.position + (next.body == body ? 1.01 : -1.01) * next.way * next.normal);
    if (!(next.overlap > 0)) return b.position;
  }
  for (int shell = 1; shell <= kShells;
       ++shell)  // between walls that leads nowhere: the nearest that is free
    for (int n = 0; n < 27; ++n) {
      const Vec3 along(n % 3 - 1, n / 3 % 3 - 1, 1 - n / 9);  // upwards first
      if (along.isZero()) continue;
      const double far = 0.25 * shell * b.shape.bounding_radius();
      if (!(dent_at(start + far * along.normalized()).overlap > 0)) return b.position;
    }
  return std::nullopt;
}

Particles::Dent Particles::deepest_in_walls(std::size_t n) const {
  const int body = static_cast<int>(n);
  look_.find_walls(body, parts_, bodies_, walls_, domain_);
  Dent worst = deepest(look_);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (walls_[w].is_plane) continue;
    const auto inside = [&](const Vec3& centre, double size) {
      if (!(worst.overlap < size) || !walls_[w].surface->contains(centre)) return;
      double top = centre.z();  // upwards out of it, wherever it is in it
      for (const Surface::Triangle& t : walls_[w].surface->triangles())
        for (const Vec3& corner : t.corners) top = std::max(top, corner.z());
      const double way = top - bodies_[n].position.z() + bodies_[n].shape.bounding_radius();
      worst = {std::max(size, way), body, -1 - static_cast<int>(w), Vec3(0, 0, 1), way};
    };
    for (int k = parts_.first_ball(body); k < parts_.first_ball(body + 1); ++k)
      inside(parts_.row(k).centre(), parts_.row(k).radius);
    for (int k = parts_.first_polytope(body); k < parts_.first_polytope(body + 1); ++k)
      inside(bodies_[n].to_world(parts_.polytope(k).solid->centre), parts_.polytope(k).radius);
  }
  return worst;
}

void Particles::require_clear(const Dent& dent, const char* when) const {
  if (!(dent.overlap > 0)) return;
  const auto other = dent.other < 0 ? walls_[static_cast<std::size_t>(-1 - dent.other)].name
                                    : bodies_[static_cast<std::size_t>(dent.other)].name;
  const std::optional<Vec3> free = clear_place(dent);
  throw InputError(
      fmt::format("body \"{}\" overlaps {} \"{}\" by {:.4g} mm {}; move it by at least that along ({:.3f}, "
                  "{:.3f}, {:.3f})",
                  bodies_[static_cast<std::size_t>(dent.body)].name, dent.other < 0 ? "wall" : "body", other,
                  1e3 * dent.way, when, dent.normal.x(), dent.normal.y(), dent.normal.z()),
      {.expected = "bodies and walls that are apart when the run starts",
       .example =
           free ? place_line("position", *free) : "a smaller body, or more room: none was found near"});
}

void Particles::require_apart() {
  search_.find(parts_, bodies_, walls_, domain_, 0.0);
  require_clear(deepest(search_), "at the start");
  for (std::size_t n = 0; n < bodies_.size(); ++n)
    if (bodies_[n].motion == Motion::free && presence_[n] != Presence::gone)
      require_clear(deepest_in_walls(n),
                    presence_[n] == Presence::here ? "at the start" : "where it is to enter");
}

}  // namespace ejecta
