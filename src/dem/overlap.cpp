#include "dem/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ejecta {
namespace {

using Polygon = std::vector<Vec3>;

constexpr double kRounding = 1e-15;  // of a solid's size
constexpr double kHair = 1e-10;      // of the sum of two: by so much the first is made larger, see below

/// Buffers kept between calls: no step allocates.
struct Scratch {
  Polygon polygon, clipped;
  std::vector<Vec3> moved;  // vertices of the second solid, axes of the first
  std::vector<double> heights;
  std::vector<unsigned char> code;  // of each vertex, see load_face; or whether it lies under a plane
  std::vector<HalfSpace> planes, cell;
  std::size_t cut_shared = 0;  // of the planes: the first so many cut what the solids may share
};

/// Not to be seen through: else each function it is handed to looks up the thread's address again.
[[gnu::noipa]] Scratch& scratch() {
  thread_local Scratch s;
  return s;
}

/// Keeps the part of s.polygon with height < 0 (Sutherland & Hodgman 1974). False if nothing is left.
bool clip(Scratch& s, const HalfSpace& plane) {
  const std::size_t count = s.polygon.size();
  s.heights.resize(count);
  bool any_in = false, any_out = false;
  for (std::size_t n = 0; n < count; ++n) {
    s.heights[n] = plane.normal.dot(s.polygon[n]) - plane.offset;
    (s.heights[n] < 0 ? any_in : any_out) = true;
  }
  if (!any_out) return true;
  if (!any_in) return false;
  s.clipped.clear();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t next = n + 1 == count ? 0 : n + 1;
    const double h = s.heights[n], g = s.heights[next];
    if (h < 0) s.clipped.push_back(s.polygon[n]);
    if ((h < 0) != (g < 0))
      s.clipped.push_back(s.polygon[n] + h / (h - g) * (s.polygon[next] - s.polygon[n]));
  }
  std::swap(s.polygon, s.clipped);
  return s.polygon.size() >= 3;
}

/// Volume, moment and area of the pyramids that faces span with an apex.
struct Sums {
  Vec3 apex{0, 0, 0};
  double volume = 0.0;
  Vec3 moment{0, 0, 0};

  /// Adds a polygon; returns its vector area.
  Vec3 add(const Polygon& p) {
    Vec3 sum(0, 0, 0);
    const Vec3 a = p[0] - apex;
    for (std::size_t n = 1; n + 1 < p.size(); ++n) {
      const Vec3 b = p[n] - apex, c = p[n + 1] - apex;
      const Vec3 twice = (b - a).cross(c - a);
      const double six_v = a.dot(twice);
      volume += six_v / 6.0;
      moment += six_v / 24.0 * (a + b + c);
      sum += 0.5 * twice;
    }
    return sum;
  }
};

/// A box along the axes.
struct Box {
  Vec3 low{-1e300, -1e300, -1e300}, high{1e300, 1e300, 1e300};  // m
  bool empty() const { return (low.array() >= high.array()).any(); }
  bool holds(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
  Vec3 middle() const { return 0.5 * (low + high); }
  Vec3 half() const { return 0.5 * (high - low); }
};

Box box_around(std::span<const Vec3> points, double margin) {
  Box box{.low = points[0], .high = points[0]};
  for (const Vec3& p : points) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

/// Beyond which sides of the box each vertex lies, a bit for each (Cohen & Sutherland).
void note_sides(Scratch& s, std::span<const Vec3> vertices, const Box& box) {
  s.code.clear();
  for (const Vec3& v : vertices) {
    unsigned code = 0;
    for (int d = 0; d < 3; ++d)
      code |= unsigned(v[d] < box.low[d]) << (2 * d) | unsigned(v[d] > box.high[d]) << (2 * d + 1);
    s.code.push_back(static_cast<unsigned char>(code));
  }
}

/// Puts a face into s.polygon, moved by `shift`. False where all its corners lie beyond one side of the box.
bool load_face(Scratch& s, const Polytope& p, const Polytope::Face& f, std::span<const Vec3> vertices,
               const Vec3& shift) {
  unsigned beyond = 63;
  for (const int n : corners_of(p, f)) beyond &= s.code[static_cast<std::size_t>(n)];
  if (beyond != 0) return false;
  s.polygon.clear();
  for (const int n : corners_of(p, f)) s.polygon.push_back(vertices[static_cast<std::size_t>(n)] + shift);
  return true;
}

/// Puts the planes of p that cut the box `all`, in which the other solid lies, into s.planes, first those
/// that cut `shared`; the others cannot clip that solid. False if one has all of `shared` beyond it.
bool planes_near(Scratch& s, const Polytope& p, const Mat3& rotation, const Vec3& shift, double margin,
                 const Box& all, const Box& shared) {
  s.planes.clear();
  s.cut_shared = 0;
  const Vec3 all_middle = all.middle(), all_half = all.half(), middle = shared.middle(), half = shared.half();
  for (const Polytope::Face& f : p.faces) {
    const Vec3 normal = rotation * f.normal, size = normal.cwiseAbs();
    const double offset = f.offset + normal.dot(shift) + margin;
    const double height = normal.dot(middle) - offset, reach = size.dot(half);
    if (height >= reach) return false;
    if (height > -reach) {
      s.planes.push_back({normal, offset});
      std::swap(s.planes[s.cut_shared++], s.planes.back());
    } else if (normal.dot(all_middle) - offset > -size.dot(all_half)) {
      s.planes.push_back({normal, offset});
    }
  }
  return true;
}

/// Clips s.polygon by the planes but one. False if nothing is left.
bool clip_all(Scratch& s, std::span<const HalfSpace> planes, std::size_t skip) {
  for (std::size_t n = 0; n < planes.size(); ++n)
    if (n != skip && !clip(s, planes[n])) return false;
  return true;
}

/// Clips s.polygon by s.planes: once it lies in what may be shared the last cannot clip it.
bool clip_shared(Scratch& s, const Box& shared) {
  for (std::size_t n = 0; n < s.planes.size(); ++n) {
    if (n == s.cut_shared &&
        std::all_of(s.polygon.begin(), s.polygon.end(), [&](const Vec3& v) { return shared.holds(v); }))
      return true;
    if (!clip(s, s.planes[n])) return false;
  }
  return true;
}

Vec3 add_polygon(const Scratch& s, Sums& sums, bool& started) {
  if (!started) sums.apex = s.polygon[0];
  started = true;
  return sums.add(s.polygon);
}

/// Clips the faces of p (moved) by s.planes and adds what is left of those in the box.
Vec3 add_faces(Scratch& s, Sums& sums, bool& started, const Polytope& p, std::span<const Vec3> vertices,
               const Box& shared, double margin = 0.0) {
  Vec3 total(0, 0, 0);
  note_sides(s, vertices, shared);
  for (const Polytope::Face& f : p.faces)
    if (load_face(s, p, f, vertices, margin * f.normal) && clip_shared(s, shared))
      total += add_polygon(s, sums, started);
  return total;
}

/// Vector area of the seams of p (moved) within s.planes.
Vec3 seams_within(Scratch& s, const Polytope& p, std::span<const Vec3> vertices, const Box& shared) {
  Vec3 total(0, 0, 0);
  if (p.seams.empty()) return total;
  Sums unused;
  note_sides(s, vertices, shared);
  for (const Polytope::Face& f : p.seams)
    if (load_face(s, p, f, vertices, Vec3::Zero()) && clip_shared(s, shared)) total += unused.add(s.polygon);
  return total;
}

}  // namespace

Overlap overlap_half_space(const Polytope& a, const Vec3& normal, double offset) {
  Overlap o;
  if (normal.dot(a.centre) - a.radius >= offset) return o;
  Scratch& s = scratch();
  Sums sums;
  sums.apex = a.centre + (offset - normal.dot(a.centre)) * normal;  // on the plane: the lid spans no volume
  const HalfSpace plane{normal, offset};
  s.code.clear();
  for (const Vec3& v : a.vertices) s.code.push_back(normal.dot(v) - offset < 0);
  for (const Polytope::Face& f : a.faces) {
    const auto corners = corners_of(a, f);
    const auto under = std::count_if(corners.begin(), corners.end(),
                                     [&](int n) { return s.code[static_cast<std::size_t>(n)]; });
    if (under == 0) continue;
    s.polygon.clear();
    for (const int n : corners) s.polygon.push_back(a.vertices[static_cast<std::size_t>(n)]);
    if (under == f.count || clip(s, plane)) o.area -= sums.add(s.polygon);
  }
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  o.depth = offset - normal.dot(o.centroid);
  if (!(o.depth > kRounding * a.radius)) return {};  // a corner that touches
  // What is wholly under the plane has no section with it: that of a prism as deep.
  o.area = std::max(o.area.dot(normal), 0.5 * o.volume / o.depth) * normal;
  return o;
}

/// Separating vectors (Chung & Wang 1996): where the two points
/// farthest along the vector do not prove it, it is turned away from their connection.
bool stand_apart(const Polytope& a, const Polytope& b, const Mat3& rotation, const Vec3& translation,
                 Vec3& along) {
  constexpr int kTurns = 6;
  const Vec3 centres = rotation * b.centre + translation - a.centre;
  const double size = a.radius + b.radius, distance = centres.norm();
  if (distance >= size) return true;
  if (along.isZero()) along = distance > 0 ? Vec3(centres / distance) : Vec3(Vec3::UnitZ());
  for (int n = 0; n < kTurns; ++n) {
    const Vec3 p = support_polytope(a, along),
               q = rotation * support_polytope(b, rotation.transpose() * -along) + translation;
    const Vec3 between = q - p;
    if (along.dot(between) > 2.0 * kHair * size) return true;
    const double length = between.norm();
    if (!(length > 0)) return false;
    along -= 2.0 * along.dot(between) / (length * length) * between;
    along.normalize();
  }
  return false;
}

Overlap overlap_polytopes(const Polytope& a, const Polytope& b, const Mat3& rotation,
                          const Vec3& translation) {
  Overlap o;
  const Vec3 centre_b = rotation * b.centre + translation;
  if ((centre_b - a.centre).norm() >= a.radius + b.radius) return o;
  Scratch& s = scratch();
  Sums sums;
  bool started = false;
  // Faces of a and b in one plane would count twice: a is made larger by a hair, so that they lie apart.
  const double hair = kHair * (a.radius + b.radius);
  s.moved.clear();
  for (const Vec3& v : b.vertices) s.moved.push_back(rotation * v + translation);
  const Box box_a = box_around(a.vertices, hair), box_b = box_around(s.moved, hair),
            shared{.low = box_a.low.cwiseMax(box_b.low), .high = box_a.high.cwiseMin(box_b.high)};
  if (shared.empty()) return o;
  if (!planes_near(s, a, Mat3::Identity(), Vec3(0, 0, 0), hair, box_b, shared)) return o;
  const Vec3 area_b = add_faces(s, sums, started, b, s.moved, shared);
  const Vec3 seams_b = seams_within(s, b, s.moved, shared);
  if (!planes_near(s, b, rotation, translation, 0.0, box_a, shared)) return o;
  const Vec3 area_a = add_faces(s, sums, started, a, a.vertices, shared, hair);
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  // The two areas are opposite, but where a seam takes part only the other solid's is all surface.
  const Vec3 seams_a = seams_within(s, a, a.vertices, shared);
  const bool cut_a = !seams_a.isZero(), cut_b = !seams_b.isZero();
  o.area = cut_a == cut_b ? Vec3(0.5 * ((area_b - seams_b) - (area_a - seams_a)))
           : cut_b        ? Vec3(area_b - seams_b)
                          : Vec3(seams_a - area_a);
  return o;
}

Overlap overlap_cell(const Polytope& a, std::span<const HalfSpace> planes) {
  Overlap o;
  Scratch& s = scratch();
  s.cell.clear();
  bool first_cuts = false;
  const double hair = kHair * a.radius;  // as in overlap_polytopes
  for (std::size_t n = 0; n < planes.size(); ++n) {
    const double height = planes[n].normal.dot(a.centre) - planes[n].offset;
    if (height >= a.radius) return o;
    if (height <= -a.radius) continue;
    double low = a.radius, high = -a.radius;
    for (const Vec3& v : a.vertices) {
      const double h = planes[n].normal.dot(v) - planes[n].offset;
      low = std::min(low, h);
      high = std::max(high, h);
    }
    if (low >= 0) return o;
    if (high < -hair) continue;
    first_cuts = first_cuts || n == 0;
    s.cell.push_back(planes[n]);
  }
  Sums sums;
  bool started = false;
  if (!s.cell.empty())
    sums.apex = a.centre + (s.cell[0].offset - s.cell[0].normal.dot(a.centre)) * s.cell[0].normal;
  started = !s.cell.empty();  // on the first plane: its lid spans no volume
  s.planes = s.cell;
  s.cut_shared = s.planes.size();
  add_faces(s, sums, started, a, a.vertices, Box{}, hair);
  for (std::size_t k = 0; k < s.cell.size(); ++k) {
    const Vec3& normal = s.cell[k].normal;
    const Vec3 middle = a.centre + (s.cell[k].offset - normal.dot(a.centre)) * normal;
    const Vec3 u = 2 * a.radius * normal.unitOrthogonal(), v = normal.cross(u);
    s.polygon.assign({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
    if (!clip_all(s, s.cell, k)) continue;
    bool left = true;
    for (std::size_t f = 0; f < a.faces.size() && left; ++f)
      left = clip(s, {a.faces[f].normal, a.faces[f].offset + hair});
    if (!left) continue;
    const Vec3 lid = sums.add(s.polygon);
    o.area += lid;
    if (k == 0 && first_cuts) o.first = lid.norm();
  }
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  o.depth = planes[0].offset - planes[0].normal.dot(o.centroid);
  return o;
}

}  // namespace ejecta
