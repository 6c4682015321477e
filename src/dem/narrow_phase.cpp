#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/overlap.hpp"
#include "dem/solid_contacts.hpp"

namespace ejecta {
namespace {

constexpr double kPi = std::numbers::pi;

/// `solid` in axes that `rotation` and `origin` take to the world.
Touch touch_ball_polytope(const BallRow& ball, const Polytope& solid, const Mat3& rotation,
                          const Vec3& origin) {
  Touch t;
  const Vec3 local = rotation.transpose() * (ball.centre() - origin);
  if ((local - solid.centre).squaredNorm() >= (ball.radius + solid.radius) * (ball.radius + solid.radius))
    return t;
  const NearestPoint nearest = nearest_on_polytope(solid, local);
  t.overlap = ball.radius - nearest.distance;
  if (!(t.overlap > 0)) return {};
  t.normal = rotation * nearest.normal;
  t.radius = t.size = ball.radius;
  t.point = ball.centre() - (ball.radius - 0.5 * t.overlap) * t.normal;
  return t;
}

Touch touch_ball_facet(const BallRow& ball, const Facet& f) {
  const TrianglePoint nearest = nearest_on_triangle(ball.centre(), f.corners[0], f.corners[1], f.corners[2]);
  const Vec3 out = ball.centre() - nearest.point;
  const double height = f.normal.dot(out);
  if (!f.owns[static_cast<std::size_t>(nearest.feature)] || height < -f.thickness) return {};
  const bool face = nearest.feature == TriangleFeature::face;
  const double distance = face ? height : out.norm();
  if (!(distance < ball.radius) || (!face && !(height > 0))) return {};
  Touch t;
  t.normal = face ? f.normal : Vec3(out / distance);
  t.overlap = ball.radius - distance;
  t.radius = t.size = ball.radius;
  t.point = ball.centre() - (ball.radius - 0.5 * t.overlap) * t.normal;
  return t;
}

/// An elastic foundation: pressure in proportion to thickness, so that the force is a constant times the
/// shared volume V and acts at its centroid, along the vector area. That is the gradient of an energy and
/// changes without a jump between face, edge and corner. The constant is chosen so that a face of the area pi
/// s^2 is as stiff as under Hertz's law: with overlap 2 V / A, radius A^2 / (4 pi V) and A the contact's true
/// area, that law gives F = 1.06 E* V / sqrt(A) for a ball as for a face (the exact flat punch: 1.13; Johnson
/// 1985, 5.9); A is held at pi s^2, with s the radius of the ball of the smaller body's volume.
Touch touch_of(const Overlap& o, double size, const Mat3& rotation, const Vec3& origin) {
  Touch t;
  const double area = o.area.norm();
  if (!(o.volume > 0) || !(area > 0)) return t;
  const double reference = kPi * size * size;
  t.normal = rotation * (o.area / area);
  t.overlap = 2.0 * o.volume / reference;
  t.radius = reference * reference / (4.0 * kPi * o.volume);
  t.point = origin + rotation * o.centroid;
  t.patch_radius = std::sqrt(area / kPi);
  t.size = size;
  t.depth = o.depth;
  t.thickness = o.volume / area;
  return t;
}

}  // namespace

Touch find_touch(const SolidPair& pair, const Parts& parts, std::span<const Body> bodies,
                 std::span<const Wall> walls) {
  const auto wall_of = [&](const PartKey& k) -> const Wall& {
    return walls[static_cast<std::size_t>(k.index)];
  };
  const auto body_of = [&](int n) -> const Body& { return bodies[static_cast<std::size_t>(n)]; };
  if (pair.a.kind == PartKind::ball) {
    const BallRow& ball = parts.row(pair.a.index);
    if (pair.b.kind == PartKind::wall_solid) {
      const Wall& wall = wall_of(pair.b);
      const std::size_t n = static_cast<std::size_t>(pair.b.solid);
      return wall.facets.empty() ? touch_ball_polytope(ball, wall.solids[n], Mat3::Identity(), Vec3(0, 0, 0))
                                 : touch_ball_facet(ball, wall.facets[n]);
    }
    const Body& other = body_of(pair.body_b);
    return touch_ball_polytope(ball, *parts.polytope(pair.b.index).solid,
                               other.orientation.toRotationMatrix(), other.position + pair.shift);
  }
  const PolytopePart& part = parts.polytope(pair.a.index);
  const Body& body = body_of(pair.body_a);
  const Mat3 turn = body.orientation.toRotationMatrix();
  if (pair.b.kind == PartKind::wall_plane) {
    const Wall& wall = wall_of(pair.b);
    const double offset = wall.offset - wall.normal.dot(body.position);
    return touch_of(overlap_half_space(*part.solid, turn.transpose() * wall.normal, offset), part.radius,
                    turn, body.position);
  }
  if (pair.b.kind == PartKind::wall_solid) {
    const Wall& wall = wall_of(pair.b);
    const std::size_t n = static_cast<std::size_t>(pair.b.solid);
    Overlap o =
        overlap_polytopes(*part.solid, wall.solids[n], turn.transpose(), -(turn.transpose() * body.position));
    if (!wall.facets.empty()) {
      // The sides of a prism are no surface: only its face pushes.
      const Vec3 face = turn.transpose() * wall.facets[n].normal;
      o.area = std::max(o.area.dot(face), 0.0) * face;
    }
    return touch_of(o, part.radius, turn, body.position);
  }
  const PolytopePart& other_part = parts.polytope(pair.b.index);
  const Body& other = body_of(pair.body_b);
  return touch_of(overlap_polytopes(*part.solid, *other_part.solid,
                                    turn.transpose() * other.orientation.toRotationMatrix(),
                                    turn.transpose() * (other.position + pair.shift - body.position)),
                  std::min(part.radius, other_part.radius), turn, body.position);
}

}  // namespace ejecta
