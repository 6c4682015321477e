#include "dem/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ejecta {
namespace {

using Polygon = std::vector<Vec3>;

constexpr double kRounding = 1e-15;  // of a solid's size

/// Buffers kept between calls: no step allocates.
struct Scratch {
  Polygon polygon, clipped;
  std::vector<double> heights;
  std::vector<HalfSpace> planes, cell;
};

Scratch& scratch() {
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

void load_face(Scratch& s, const Polytope& p, const Polytope::Face& f, const Mat3& rotation,
               const Vec3& shift) {
  s.polygon.clear();
  for (int n = f.first; n < f.first + f.count; ++n)
    s.polygon.push_back(
        rotation * p.vertices[static_cast<std::size_t>(p.corners[static_cast<std::size_t>(n)])] + shift);
}

/// Planes that cut the ball about `centre`; the others cannot clip anything inside it. False if it is
/// outside.
bool planes_near(const Polytope& p, const Mat3& rotation, const Vec3& shift, double margin,
                 const Vec3& centre, double radius, std::vector<HalfSpace>& planes) {
  planes.clear();
  for (const Polytope::Face& f : p.faces) {
    const Vec3 normal = rotation * f.normal;
    const double offset = f.offset + normal.dot(shift) + margin;
    const double height = normal.dot(centre) - offset;
    if (height >= radius) return false;
    if (height > -radius) planes.push_back({normal, offset});
  }
  return true;
}

/// Clips s.polygon by the planes. False if nothing is left.
bool clip_all(Scratch& s, std::vector<HalfSpace>& planes, std::size_t skip) {
  for (std::size_t n = 0; n < planes.size(); ++n) {
    if (n == skip || clip(s, planes[n])) continue;
    if (skip > planes.size()) std::swap(planes[n], planes[n / 2]);  // what rejects one often rejects the next
    return false;
  }
  return true;
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

Vec3 add_polygon(const Scratch& s, Sums& sums, bool& started) {
  if (!started) sums.apex = s.polygon[0];
  started = true;
  return sums.add(s.polygon);
}

/// Clips the faces of p (moved) by s.planes and adds what is left.
Vec3 add_faces(Scratch& s, Sums& sums, bool& started, const Polytope& p, const Mat3& rotation,
               const Vec3& shift, double margin) {
  Vec3 total(0, 0, 0);
  for (const Polytope::Face& f : p.faces) {
    load_face(s, p, f, rotation, shift + margin * (rotation * f.normal));
    if (clip_all(s, s.planes, kNone)) total += add_polygon(s, sums, started);
  }
  return total;
}

/// Vector area of the seams of p (moved) within s.planes.
Vec3 seams_within(Scratch& s, const Polytope& p, const Mat3& rotation, const Vec3& shift) {
  Vec3 total(0, 0, 0);
  Sums unused;
  for (const Polytope::Face& f : p.seams) {
    load_face(s, p, f, rotation, shift);
    if (clip_all(s, s.planes, kNone)) total += unused.add(s.polygon);
  }
  return total;
}

}  // namespace

Overlap overlap_half_space(const Polytope& a, const Vec3& normal, double offset) {
  Overlap o;
  if (normal.dot(a.centre) - a.radius >= offset) return o;
  Scratch& s = scratch();
  Sums sums;
  sums.apex = a.centre + (offset - normal.dot(a.centre)) * normal;  // on the plane: the lid spans no volume
  for (const Polytope::Face& f : a.faces) {
    load_face(s, a, f, Mat3::Identity(), Vec3(0, 0, 0));
    if (clip(s, {normal, offset})) o.area -= sums.add(s.polygon);
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

Overlap overlap_polytopes(const Polytope& a, const Polytope& b, const Mat3& rotation,
                          const Vec3& translation) {
  Overlap o;
  const Vec3 centre_b = rotation * b.centre + translation;
  if ((centre_b - a.centre).norm() >= a.radius + b.radius) return o;
  Scratch& s = scratch();
  Sums sums;
  bool started = false;
  // Faces of a and b in one plane would count twice: a is made larger by a hair, so that they lie apart.
  const double hair = 1e-10 * (a.radius + b.radius);
  if (!planes_near(a, Mat3::Identity(), Vec3(0, 0, 0), hair, centre_b, b.radius, s.planes)) return o;
  const Vec3 area_b = add_faces(s, sums, started, b, rotation, translation, 0.0);
  const Vec3 seams_b = seams_within(s, b, rotation, translation);
  if (!planes_near(b, rotation, translation, 0.0, a.centre, a.radius, s.planes)) return o;
  const Vec3 area_a = add_faces(s, sums, started, a, Mat3::Identity(), Vec3(0, 0, 0), hair);
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  // The two areas are opposite, but where a seam takes part only the other solid's is all surface.
  const Vec3 seams_a = seams_within(s, a, Mat3::Identity(), Vec3(0, 0, 0));
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
  const double hair = 1e-10 * a.radius;  // as in overlap_polytopes
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
  add_faces(s, sums, started, a, Mat3::Identity(), Vec3(0, 0, 0), hair);
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
