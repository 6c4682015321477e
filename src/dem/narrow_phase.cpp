#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "dem/overlap.hpp"
#include "dem/solid_contacts.hpp"

namespace ejecta {
namespace {

constexpr double kPi = std::numbers::pi;

/// cos 60 degrees: a face that looks more than that against a contact is the far side of a solid, one that
/// looks as much towards it the near side.
constexpr double kFarSide = -0.5, kNearSide = 0.5;

Touch touch_ball(const BallRow& ball, double distance, const Vec3& normal) {
  Touch t;
  t.overlap = ball.radius - distance;
  if (!(t.overlap > 0)) return {};
  t.normal = normal;
  t.radius = t.size = ball.radius;
  t.point = ball.centre() - (ball.radius - 0.5 * t.overlap) * normal;
  return t;
}

/// `solid` in axes that `rotation` and `origin` take to the world. `face`: before which the ball's centre was
/// when it was last outside.
Touch touch_ball_polytope(const BallRow& ball, const Polytope& solid, const Mat3& rotation,
                          const Vec3& origin, int face) {
  const Vec3 local = rotation.transpose() * (ball.centre() - origin);
  if ((local - solid.centre).squaredNorm() >= (ball.radius + solid.radius) * (ball.radius + solid.radius))
    return {};
  NearestPoint nearest = nearest_on_polytope(solid, local);
  if (nearest.distance <= 0 && face >= 0) {
    const Polytope::Face& f = solid.faces[static_cast<std::size_t>(face)];
    nearest = {f.normal.dot(local) - f.offset, f.normal, face};
  }
  Touch t = touch_ball(ball, nearest.distance, rotation * nearest.normal);
  t.face = nearest.face;
  return t;
}

/// `centre`: of the ball among the wall's own images. `side`: on which it stood when it touched first.
Touch touch_ball_triangle(const BallRow& ball, const Vec3& centre, const Surface& surface, int n, int side) {
  const Surface::Triangle& f = surface.triangles()[static_cast<std::size_t>(n)];
  const double height = f.normal.dot(centre - f.corners[0]);
  if (std::abs(height) >= ball.radius && side == 0) return {};
  const TrianglePoint nearest = nearest_on_triangle(centre, f.corners[0], f.corners[1], f.corners[2]);
  const bool on_face = nearest.feature == TriangleFeature::face;
  if (!on_face || side == 0) side = height < 0 ? -1 : 1;
  const Vec3 out = centre - nearest.point;
  const bool ghost = on_face && side < 0 && !surface.two_sided();
  const double distance = ghost ? std::abs(height) : on_face ? side * height : out.norm();
  Touch t =
      touch_ball(ball, distance, on_face || !(distance > 0) ? Vec3(side * f.normal) : Vec3(out / distance));
  t.on_face = on_face;
  t.ghost = ghost && t.overlap > 0;
  t.side = side;
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
  if (!(o.volume > 0) || !(area > 1e-9 * std::pow(o.volume, 2.0 / 3.0))) return t;
  const double reference = kPi * size * size;
  t.normal = rotation * (o.area / area);
  t.overlap = 2.0 * o.volume / reference;
  t.radius = reference * reference / (4.0 * kPi * o.volume);
  t.point = origin + rotation * o.centroid;
  const Vec3 arm = rotation * (o.centroid - o.middle);
  t.lean = o.volume / area * (arm - arm.dot(t.normal) * t.normal);
  t.patch_radius = std::sqrt(area / kPi);
  t.size = size;
  t.thickness = o.volume / area;
  return t;
}

/// Whether the solid reaches beyond a plane.
bool beyond(const Polytope& solid, const HalfSpace& plane) {
  return plane.normal.dot(support_exact(solid, plane.normal)) > plane.offset;
}

/// Whether a face is of the far side, seen along `along`.
bool is_far(const Polytope::Face& f, const Vec3& along) { return f.normal.dot(along) < kFarSide; }

/// Whether a reaches as deep into b (in axes that `rotation` and `shift` take to those of a), along -out, as
/// the first corner of b's far side lies. Above that depth b is the same without its far side: a straight way
/// from a point of it to what was left out would cross that side there. Where the far side runs into the near
/// one, as at the edges of a tetrahedron, b is thin at any depth and nothing has gone through it.
bool reaches_far_side(const Polytope& b, const Mat3& rotation, const Vec3& shift, const Vec3& out,
                      const Polytope& a) {
  const Vec3 along = rotation.transpose() * out;
  const double deepest = out.dot(support_exact(a, -out) - shift);
  if (along.dot(support_exact(b, along)) < deepest) return true;  // nothing is shared
  thread_local std::vector<char> is_near;
  is_near.assign(b.vertices.size(), false);
  for (const Polytope::Face& f : b.faces)
    if (f.normal.dot(along) > kNearSide)
      for (const int v : corners_of(b, f)) is_near[static_cast<std::size_t>(v)] = true;
  return std::any_of(b.faces.begin(), b.faces.end(), [&](const Polytope::Face& f) {
    if (!is_far(f, along)) return false;
    const auto corners = corners_of(b, f);
    return std::any_of(corners.begin(), corners.end(), [&](int v) {
      const std::size_t n = static_cast<std::size_t>(v);
      return !is_near[n] && along.dot(b.vertices[n]) >= deepest;
    });
  });
}

/// Planes along `along` through the edges between the faces of the far side of a solid and its others: what
/// goes on behind it is as wide as it is. In the solid's axes.
template <class Add>
void for_each_outline(const Polytope& p, const Vec3& along, const Add& add) {
  for (const Polytope::Face& f : p.faces) {
    if (!is_far(f, along)) continue;
    const auto corners = corners_of(p, f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const int from = corners[c], to = corners[(c + 1) % corners.size()];
      const bool inner = std::any_of(p.faces.begin(), p.faces.end(), [&](const Polytope::Face& g) {
        if (&g == &f || !is_far(g, along)) return false;
        const auto others = corners_of(p, g);
        for (std::size_t n = 0; n < others.size(); ++n)
          if (others[n] == to && others[(n + 1) % others.size()] == from) return true;
        return false;
      });
      if (inner) continue;
      const Vec3& at = p.vertices[static_cast<std::size_t>(from)];
      Vec3 normal = (p.vertices[static_cast<std::size_t>(to)] - at).cross(along);
      if (!(normal.norm() > 0)) continue;
      normal.normalize();
      if (normal.dot(p.centre - at) > 0) normal = -normal;
      add(normal, normal.dot(at));
    }
  }
}

/// The faces of b (in axes that `rotation` and `shift` take to those of a) but for those on its far side, as
/// seen along `out`. Nothing unless a reaches beyond one of these.
bool without_far_side(const Polytope& b, const Mat3& rotation, const Vec3& shift, const Vec3& out,
                      const Polytope& a, std::vector<HalfSpace>& planes) {
  planes.clear();
  if (!reaches_far_side(b, rotation, shift, out, a)) return false;
  const Vec3 along = rotation.transpose() * out;
  const auto in_a = [&](const Vec3& own, double offset) {
    const Vec3 normal = rotation * own;
    return HalfSpace{normal, offset + normal.dot(shift)};
  };
  bool pierced = false;
  for (const Polytope::Face& f : b.faces) {
    const HalfSpace plane = in_a(f.normal, f.offset);
    if (is_far(f, along)) pierced = pierced || beyond(a, plane);
    else planes.push_back(plane);
  }
  if (!pierced || planes.empty()) return false;
  for_each_outline(b, along, [&](const Vec3& n, double offset) { planes.push_back(in_a(n, offset)); });
  return true;
}

/// As overlap_polytopes. A solid that the other has gone through goes on behind: `out`, in the axes of a,
/// whence the contact pushed a at the last step (zero: they did not touch), says which of its sides is met.
Overlap overlap_solids(const Polytope& a, const Polytope& b, const Mat3& rotation, const Vec3& shift,
                       const Vec3& out) {
  if (!out.isZero()) {
    thread_local std::vector<HalfSpace> planes;
    if ((rotation * b.centre + shift - a.centre).norm() >= a.radius + b.radius) return {};
    if (without_far_side(b, rotation, shift, out, a, planes)) return overlap_cell(a, planes);
    const Mat3 back = rotation.transpose();
    if (without_far_side(a, back, -(back * shift), -(back * out), b, planes)) {
      Overlap o = overlap_cell(b, planes);
      o.area = -(rotation * o.area);
      o.centroid = rotation * o.centroid + shift;
      o.middle = rotation * o.middle + shift;
      return o;
    }
  }
  return overlap_polytopes(a, b, rotation, shift);
}

/// What of a solid comes `depth` deep into something along `along` (axes of the solid): of a smooth one the
/// cap, in `cap`.
const Polytope& met_part(const Polytope& solid, const Vec3& along, double depth, Polytope& cap) {
  constexpr double kMore = 1.001;  // its rim lies beyond what is shared
  return solid.exact && cut_cap(*solid.exact, along, kMore * depth, cap) ? cap : solid;
}

/// A polytope that holds what a solid stands for: of a smooth one, which it is inscribed in, grown in
/// `grown`.
const Polytope& holder(const Polytope& solid, Polytope& grown) {
  if (!solid.exact) return solid;
  grown = solid;
  grown.exact.reset();
  for (Vec3& v : grown.vertices) v *= solid.excess;
  for (Polytope::Face& f : grown.faces) f.offset *= solid.excess;
  grown.centre *= solid.excess;
  grown.radius *= solid.excess;
  return grown;
}

/// As overlap_solids. Facets of smooth solids lie about the contact: where it pushed at the last step, or, of
/// solids that have just met, where polytopes that hold them say; then again where the contact was found,
/// until that is in the middle of them.
Overlap overlap_smooth(const Polytope& a, const Polytope& b, const Mat3& rotation, const Vec3& shift,
                       const Vec3& out) {
  constexpr int kTurns = 4;
  constexpr double kCentred = 1e-3;  // of the caps' angle, squared
  if (!a.exact && !b.exact) return overlap_solids(a, b, rotation, shift, out);
  Vec3 along = -out;  // from a to b, axes of a
  if (out.isZero()) {
    thread_local Polytope grown_a, grown_b;
    const Overlap coarse = overlap_polytopes(holder(a, grown_a), holder(b, grown_b), rotation, shift);
    if (coarse.area.isZero()) return {};
    along = -coarse.area.normalized();
  }
  thread_local Polytope cap_a, cap_b;
  Overlap o;
  for (int n = 0; n < kTurns; ++n) {
    const Vec3 back = rotation.transpose() * -along;
    const double depth = along.dot(support_exact(a, along) - rotation * support_exact(b, back) - shift);
    if (!(depth > 0)) return {};
    o = overlap_solids(met_part(a, along, depth, cap_a), met_part(b, back, depth, cap_b), rotation, shift,
                       out.isZero() ? out : Vec3(-along));
    if (!(o.volume > 0)) return {};
    const Vec3 found = -o.area.normalized();
    const double turned = (found - along).squaredNorm();
    along = found;
    if (turned < kCentred * depth / std::min(a.radius, b.radius)) break;
  }
  return o;
}

/// Of a polytope with what lies behind a region of a surface; z is measured from its plane. `side`: on which
/// the polytope stood when it touched first, or 0.
Touch touch_region(const PolytopePart& part, const Body& body, const Vec3& position, const Surface& surface,
                   int n, int side) {
  const Polytope& solid = *part.solid;
  const Surface::Region& region = surface.regions()[static_cast<std::size_t>(n)];
  const Mat3 turn = body.orientation.toRotationMatrix();
  const Vec3 centre = position + turn * solid.centre;
  const bool known = side != 0;
  const double height = region.plane.normal.dot(centre) - region.plane.offset;
  if (!known) {
    if (std::abs(height) >= solid.radius) return {};
    side = height < 0 ? -1 : 1;
  }
  const bool ghost = side < 0 && !surface.two_sided();
  const Vec3 down = turn.transpose() * Vec3(-side * region.plane.normal);
  const double depth = down.dot(support_exact(solid, down) - solid.centre) - side * height;
  if (!(depth > 0)) return {};  // most regions near a body are not touched
  thread_local Polytope cap;
  const Polytope& met = met_part(solid, down, depth, cap);
  Overlap sum;
  thread_local std::vector<HalfSpace> planes;
  const auto add_plane = [&](const Vec3& normal, double offset) {
    planes.push_back({turn.transpose() * normal, offset - normal.dot(position)});
  };
  for (const Surface::Piece& piece : region.pieces) {
    const double off = std::abs(region.plane.normal.dot(centre - piece.centre));
    const double apart = std::sqrt(std::max(0.0, (centre - piece.centre).squaredNorm() - off * off));
    if (apart > 2 * solid.radius + piece.radius) continue;
    planes.clear();
    add_plane(side * region.plane.normal, side * region.plane.offset);
    for (const HalfSpace& s : piece.sides) add_plane(s.normal, s.offset);
    const Overlap o = overlap_cell(met, planes);
    if (!(o.volume > 0)) continue;
    sum.volume += o.volume;
    sum.centroid += o.volume * o.centroid;
    sum.depth += o.volume * o.depth;
    sum.middle += o.first * o.middle;
    sum.first += o.first;
  }
  if (!(sum.volume > 0) || ((!known || ghost) && !(sum.first > 0))) return {};
  if (ghost) {
    Touch t;
    t.side = side;
    return t;
  }
  sum.centroid /= sum.volume;
  sum.depth /= sum.volume;
  sum.middle = sum.first > 0 ? Vec3(sum.middle / sum.first) : sum.centroid;
  sum.area = std::max(sum.first, 1e-6 * std::pow(sum.volume, 2.0 / 3.0)) *
             (turn.transpose() * Vec3(side * region.plane.normal));
  Touch t = touch_of(sum, part.radius, turn, position);
  t.depth = sum.depth;
  t.side = side;
  return t;
}

/// The ball's centre, or the body's position, among the images of a wall.
Vec3 at_wall(const Vec3& point, const SolidPair& pair) { return point - pair.shift; }

Touch touch_wall(const SolidPair& pair, const Parts& parts, std::span<const Body> bodies,
                 std::span<const Wall> walls) {
  const Wall& wall = walls[static_cast<std::size_t>(pair.b.index)];
  const ContactHistory& h = pair.history;
  if (pair.b.kind == PartKind::wall_triangle) {
    BallRow ball = parts.row(pair.a.index);
    const Vec3 centre = at_wall(ball.centre(), pair);
    ball.x = centre.x(), ball.y = centre.y(), ball.z = centre.z();
    return touch_ball_triangle(ball, centre, *wall.surface, pair.b.solid, h.side);
  }
  const PolytopePart& part = parts.polytope(pair.a.index);
  const Body& body = bodies[static_cast<std::size_t>(pair.body_a)];
  const Vec3 position = at_wall(body.position, pair);
  if (pair.b.kind == PartKind::wall_region)
    return touch_region(part, body, position, *wall.surface, pair.b.solid, h.side);
  const Mat3 turn = body.orientation.toRotationMatrix();
  if (pair.b.kind == PartKind::wall_plane) {
    const Vec3 up = turn.transpose() * wall.normal;
    const double offset = wall.offset - wall.normal.dot(position);
    thread_local Polytope cap;
    const double depth = part.solid->exact ? offset - up.dot(support_exact(*part.solid, -up)) : 0.0;
    if (part.solid->exact && !(depth > 0)) return {};
    const Overlap o = overlap_half_space(met_part(*part.solid, -up, depth, cap), up, offset);
    Touch t = touch_of(o, part.radius, turn, position);
    t.depth = o.depth;
    return t;
  }
  const Overlap o = overlap_smooth(*part.solid, wall.solids[static_cast<std::size_t>(pair.b.solid)],
                                   turn.transpose(), -(turn.transpose() * position),
                                   turn.transpose() * Vec3(h.normal.x, h.normal.y, h.normal.z));
  return touch_of(o, part.radius, turn, position);
}

}  // namespace

Touch find_touch(const SolidPair& pair, const Parts& parts, std::span<const Body> bodies,
                 std::span<const Wall> walls, const Domain& domain) {
  if (pair.body_b < 0) {
    Touch t = touch_wall(pair, parts, bodies, walls);
    if (!(t.overlap > 0) || pair.b.kind == PartKind::wall_plane) return t;
    // A wall may reach over a periodic side and so meet its own image: each counts on its side of it.
    const Vec3 foot = pair.a.kind == PartKind::ball ? Vec3(t.point + 0.5 * t.overlap * t.normal) : t.point;
    for (int c = 0; c < 3; ++c) {
      const double slack = 1e-9 * domain.period[c];
      if (domain.period[c] > 0 && (foot[c] < domain.low[c] - slack || foot[c] > domain.high[c] + slack))
        return {};
    }
    t.point += pair.shift;
    return t;
  }
  const Body& other = bodies[static_cast<std::size_t>(pair.body_b)];
  const Mat3 other_turn = other.orientation.toRotationMatrix();
  const PolytopePart& other_part = parts.polytope(pair.b.index);
  if (pair.a.kind == PartKind::ball)
    return touch_ball_polytope(parts.row(pair.a.index), *other_part.solid, other_turn,
                               other.position + pair.shift, pair.history.face);
  const PolytopePart& part = parts.polytope(pair.a.index);
  const Body& body = bodies[static_cast<std::size_t>(pair.body_a)];
  const Mat3 turn = body.orientation.toRotationMatrix();
  const Triple<double>& normal = pair.history.normal;
  const Mat3 rotation = turn.transpose() * other_turn;
  const Vec3 shift = turn.transpose() * (other.position + pair.shift - body.position),
             out = turn.transpose() * Vec3(normal.x, normal.y, normal.z);
  Touch touch{.apart = pair.touch.apart};
  if (out.isZero() && stand_apart(*part.solid, *other_part.solid, rotation, shift, touch.apart)) return touch;
  touch = touch_of(overlap_smooth(*part.solid, *other_part.solid, rotation, shift, out),
                   std::min(part.radius, other_part.radius), turn, body.position);
  touch.apart = pair.touch.apart;
  return touch;
}

double distance_to(const SolidPair& pair, const Vec3& point, const Parts& parts, std::span<const Body> bodies,
                   std::span<const Wall> walls) {
  const Vec3 p = at_wall(point, pair);
  if (pair.b.kind == PartKind::wall_triangle) {
    const auto& c = walls[static_cast<std::size_t>(pair.b.index)]
                        .surface->triangles()[static_cast<std::size_t>(pair.b.solid)]
                        .corners;
    return (p - nearest_on_triangle(p, c[0], c[1], c[2]).point).norm();
  }
  return nearest_on_polytope(*parts.polytope(pair.b.index).solid,
                             bodies[static_cast<std::size_t>(pair.body_b)].to_body(p))
      .distance;
}

}  // namespace ejecta
