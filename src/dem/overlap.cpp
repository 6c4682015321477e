#include "dem/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace ejecta {
namespace {

using Polygon = std::vector<Vec3>;

constexpr double kRounding = 1e-15;  // of a solid's size
constexpr double kHair = 1e-10;      // of the sum of two: by so much the first is made larger, see below
constexpr double kFilm = 3.0;        // hairs: what is no thicker has the shape of its rounding errors

/// Of a flat convex face: from one point to another. In no order: sums and cuts need none.
struct CutEdge {
  int from = 0, to = 0;
};
enum class Origin : char { solid, first_plane, plane };
/// The edges of one face of what is left of a solid, up to `end`.
struct CutFace {
  std::size_t end = 0;
  Origin origin = Origin::solid;
};
struct CutSolid {
  std::vector<Vec3> points;
  std::vector<CutEdge> edges;  // face after face
  std::vector<CutFace> faces;
  void clear() {
    points.clear();
    edges.clear();
    faces.clear();
  }
  int add(const Vec3& p) {
    points.push_back(p);
    return static_cast<int>(points.size()) - 1;
  }
};

/// Buffers kept between calls: no step allocates.
struct Scratch {
  Polygon polygon, clipped;
  std::vector<Vec3> moved;  // vertices of the second solid, axes of the first
  std::vector<double> heights;
  std::vector<unsigned char> code;  // of each vertex, see load_face; or whether it lies under a plane
  std::vector<HalfSpace> planes;
  CutSolid solid, kept;        // what is left of a solid
  std::vector<CutEdge> lid;    // its new face
  std::vector<int> names;      // of its points, in what is kept
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

/// Adds the sum of place x vector area over a triangle, m3.
void add_first_moment(const Vec3& a, const Vec3& b, const Vec3& c, Mat3& first) {
  first += (1.0 / 6.0 * (a + b + c)) * (b - a).cross(c - a).transpose();
}

/// Volume and moment of the pyramids that faces span with an apex.
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
  /// Adds a polygon, and its shadow along `normal` to an area (m2) and its first moment about the apex (m3).
  void add(const Polygon& p, const Vec3& normal, double& area, Vec3& first) {
    const Vec3 a = p[0] - apex;
    for (std::size_t n = 1; n + 1 < p.size(); ++n) {
      const Vec3 b = p[n] - apex, c = p[n + 1] - apex, corners = a + b + c;
      const Vec3 twice = (b - a).cross(c - a);
      const double six_v = a.dot(twice), shadow = normal.dot(twice);
      volume += six_v / 6.0;
      moment += six_v / 24.0 * corners;
      area += 0.5 * shadow;
      first += 1.0 / 6.0 * shadow * corners;
    }
  }
  /// Adds a face; returns its vector area.
  Vec3 add(const CutSolid& solid, std::span<const CutEdge> edges) {
    Vec3 twice(0, 0, 0), heavy(0, 0, 0);
    double six_v = 0.0;
    const auto arm = [&](int n) -> Vec3 { return solid.points[static_cast<std::size_t>(n)] - apex; };
    const Vec3 a = arm(edges[0].from);
    for (const CutEdge& e : edges) {
      const Vec3 b = arm(e.from), c = arm(e.to), area = (b - a).cross(c - a);
      const double v = a.dot(area);
      twice += area;
      six_v += v;
      heavy += v * (a + b + c);
    }
    volume += six_v / 6.0;
    moment += heavy / 24.0;
    return 0.5 * twice;
  }
  /// Sum of place, from the apex, x vector area over a polygon, a face, m3.
  Mat3 first_moment(const Polygon& p) const {
    Mat3 first = Mat3::Zero();
    const Vec3 a = p[0] - apex;
    for (std::size_t n = 1; n + 1 < p.size(); ++n) add_first_moment(a, p[n] - apex, p[n + 1] - apex, first);
    return first;
  }
  Mat3 first_moment(const CutSolid& solid, std::span<const CutEdge> edges) const {
    Mat3 first = Mat3::Zero();
    const auto arm = [&](int n) -> Vec3 { return solid.points[static_cast<std::size_t>(n)] - apex; };
    const Vec3 a = arm(edges[0].from);
    for (const CutEdge& e : edges) add_first_moment(a, arm(e.from), arm(e.to), first);
    return first;
  }
};

/// Puts the faces of a solid into s.solid but for those wholly beyond the plane.
void load_solid(Scratch& s, const Polytope& p, const HalfSpace& plane) {
  s.solid.clear();
  s.code.clear();
  for (const Vec3& v : p.vertices) s.code.push_back(plane.normal.dot(v) < plane.offset);
  s.names.assign(p.vertices.size(), -1);
  const auto name = [&](int n) {
    int& own = s.names[static_cast<std::size_t>(n)];
    if (own < 0) own = s.solid.add(p.vertices[static_cast<std::size_t>(n)]);
    return own;
  };
  for (const Polytope::Face& f : p.faces) {
    const auto corners = corners_of(p, f);
    if (std::none_of(corners.begin(), corners.end(),
                     [&](int n) { return s.code[static_cast<std::size_t>(n)]; }))
      continue;
    int last = name(corners.back());
    for (const int n : corners) {
      const int next = name(n);
      s.solid.edges.push_back({last, next});
      last = next;
    }
    s.solid.faces.push_back({s.solid.edges.size(), Origin::solid});
  }
}

bool all_beyond(const CutSolid& solid, const HalfSpace& plane) {
  return std::all_of(solid.points.begin(), solid.points.end(),
                     [&](const Vec3& p) { return plane.normal.dot(p) >= plane.offset; });
}

/// Keeps what of s.solid lies within the plane and closes it with a face there. Each face that the plane cuts
/// is closed from where its outline leaves to where it enters; these joints reversed are the new face. An
/// edge is cut from its end inside, so at the same point for both of its faces. False if nothing is left.
bool clip_solid(Scratch& s, const HalfSpace& plane, Origin origin) {
  const std::size_t count = s.solid.points.size();
  s.heights.resize(count);
  s.names.resize(count);
  s.kept.clear();
  for (std::size_t n = 0; n < count; ++n) {
    s.heights[n] = plane.normal.dot(s.solid.points[n]) - plane.offset;
    s.names[n] = s.heights[n] < 0 ? s.kept.add(s.solid.points[n]) : -1;
  }
  if (s.kept.points.size() == count) return true;
  if (s.kept.points.empty()) return false;
  s.lid.clear();
  const auto cut = [&](int inside, int outside) {
    const std::size_t n = static_cast<std::size_t>(inside), m = static_cast<std::size_t>(outside);
    const Vec3 &p = s.solid.points[n], &q = s.solid.points[m];
    return s.kept.add(p + s.heights[n] / (s.heights[n] - s.heights[m]) * (q - p));
  };
  for (std::size_t n = 0, k = 0; n < s.solid.faces.size(); ++n) {
    const std::size_t first_edge = s.kept.edges.size(), first_joint = s.lid.size();
    std::size_t enters = first_joint, leaves = first_joint;
    const auto joint = [&](std::size_t j) -> CutEdge& {
      if (j == s.lid.size()) s.lid.emplace_back();
      return s.lid[j];
    };
    for (; k < s.solid.faces[n].end; ++k) {
      const CutEdge& e = s.solid.edges[k];
      const int from = s.names[static_cast<std::size_t>(e.from)],
                to = s.names[static_cast<std::size_t>(e.to)];
      if (from >= 0 && to >= 0) {
        s.kept.edges.push_back({from, to});
      } else if (from >= 0) {
        s.kept.edges.push_back({from, joint(leaves++).to = cut(e.from, e.to)});
      } else if (to >= 0) {
        s.kept.edges.push_back({joint(enters++).from = cut(e.to, e.from), to});
      }
    }
    for (std::size_t j = first_joint; j < s.lid.size(); ++j)
      s.kept.edges.push_back({s.lid[j].to, s.lid[j].from});
    if (s.kept.edges.size() > first_edge)
      s.kept.faces.push_back({s.kept.edges.size(), s.solid.faces[n].origin});
  }
  s.kept.edges.insert(s.kept.edges.end(), s.lid.begin(), s.lid.end());
  s.kept.faces.push_back({s.kept.edges.size(), origin});
  std::swap(s.solid, s.kept);
  return true;
}

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

/// Centroid, from the apex, of the shadow of a surface along its vector area.
Vec3 middle_of(const Mat3& first_moment, const Vec3& area) {
  return first_moment * area / area.squaredNorm();
}

/// Clips the faces of p (moved) by s.planes and adds what is left of those in the box. `first`: their first
/// moment, if asked for.
Vec3 add_faces(Scratch& s, Sums& sums, bool& started, const Polytope& p, std::span<const Vec3> vertices,
               const Box& shared, double margin, Mat3* first) {
  Vec3 total(0, 0, 0);
  note_sides(s, vertices, shared);
  for (const Polytope::Face& f : p.faces)
    if (load_face(s, p, f, vertices, margin * f.normal) && clip_shared(s, shared)) {
      total += add_polygon(s, sums, started);
      if (first) *first += sums.first_moment(s.polygon);
    }
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

/// Whether an overlap is but a film: a face that lands would be pushed where rounding says.
bool is_film(const Overlap& o, double hair) { return !(o.volume > kFilm * hair * o.area.norm()); }

}  // namespace

Overlap overlap_half_space(const Polytope& a, const Vec3& normal, double offset) {
  Overlap o;
  if (normal.dot(a.centre) - a.radius >= offset) return o;
  Scratch& s = scratch();
  Sums sums;
  sums.apex = a.centre + (offset - normal.dot(a.centre)) * normal;  // on the plane: the lid spans no volume
  const HalfSpace plane{normal, offset};
  double below = 0.0;  // shadow of the faces below the plane: minus the section
  Vec3 first(0, 0, 0);
  s.code.clear();
  for (const Vec3& v : a.vertices) s.code.push_back(normal.dot(v) - offset < 0);
  for (const Polytope::Face& f : a.faces) {
    const auto corners = corners_of(a, f);
    const auto under = std::count_if(corners.begin(), corners.end(),
                                     [&](int n) { return s.code[static_cast<std::size_t>(n)]; });
    if (under == 0) continue;
    s.polygon.clear();
    for (const int n : corners) s.polygon.push_back(a.vertices[static_cast<std::size_t>(n)]);
    if (under == f.count || clip(s, plane)) sums.add(s.polygon, normal, below, first);
  }
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  o.depth = offset - normal.dot(o.centroid);
  if (!(o.depth > kRounding * a.radius)) return {};  // a corner that touches
  // What is wholly under the plane has no section with it: that of a prism as deep.
  const double section = -below, least = 0.5 * o.volume / o.depth;
  o.area = std::max(section, least) * normal;
  o.middle = section > least ? Vec3(sums.apex + first / below) : o.centroid;
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
    const Vec3 p = support_exact(a, along),
               q = rotation * support_exact(b, rotation.transpose() * -along) + translation;
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
  Mat3 first = Mat3::Zero();
  const Vec3 area_b = add_faces(s, sums, started, b, s.moved, shared, 0.0, &first);
  const Vec3 seams_b = seams_within(s, b, s.moved, shared);
  if (!planes_near(s, b, rotation, translation, 0.0, box_a, shared)) return o;
  const Vec3 area_a = add_faces(s, sums, started, a, a.vertices, shared, hair, nullptr);
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  // The two areas are opposite, but where a seam takes part only the other solid's is all surface.
  const Vec3 seams_a = seams_within(s, a, a.vertices, shared);
  const bool cut_a = !seams_a.isZero(), cut_b = !seams_b.isZero();
  const Vec3 hidden = cut_a == cut_b ? Vec3(0.5 * (seams_b - seams_a)) : cut_b ? seams_b : Vec3(-seams_a);
  o.area = (cut_a == cut_b ? Vec3(0.5 * (area_b - area_a)) : cut_b ? area_b : Vec3(-area_a)) - hidden;
  o.middle = sums.apex + middle_of(first, area_b);
  // What lies behind a seam that looks the way of the contact belongs to the part before it: of a corner of
  // walls, what is reached through the other wall.
  const double open = o.area.norm();
  if (open > 0) o.volume *= open / (open + std::max(0.0, o.area.dot(hidden) / open));
  if (is_film(o, hair)) o = {};
  return o;
}

Overlap overlap_cell(const Polytope& a, std::span<const HalfSpace> planes) {
  Overlap o;
  Scratch& s = scratch();
  s.planes.clear();
  bool first_cuts = false;
  const double hair = kHair * a.radius;  // as in overlap_polytopes, but here the cell is made smaller
  for (const HalfSpace& p : planes) {
    const HalfSpace plane{p.normal, p.offset - hair};
    const double height = plane.normal.dot(a.centre) - plane.offset;
    if (height >= a.radius) return o;
    if (height <= -a.radius) continue;
    double low = a.radius, high = -a.radius;
    for (const Vec3& v : a.vertices) {
      const double h = plane.normal.dot(v) - plane.offset;
      low = std::min(low, h);
      high = std::max(high, h);
    }
    if (low >= 0) return o;
    if (high < 0) continue;
    first_cuts = first_cuts || &p == planes.data();
    s.planes.push_back(plane);
  }
  Sums sums{.apex = a.centre};
  if (s.planes.empty()) {
    load_solid(s, a, {Vec3::UnitZ(), std::numeric_limits<double>::infinity()});
  } else {
    const HalfSpace& first = s.planes.front();
    sums.apex -= (first.normal.dot(a.centre) - first.offset) * first.normal;  // its lid spans no volume
    load_solid(s, a, first);
    clip_solid(s, first, first_cuts ? Origin::first_plane : Origin::plane);
    const auto rest = std::span(s.planes).subspan(1);
    if (std::any_of(rest.begin(), rest.end(), [&](const HalfSpace& p) { return all_beyond(s.solid, p); }))
      return o;
    for (const HalfSpace& p : rest)
      if (!clip_solid(s, p, Origin::plane)) return o;
  }
  for (std::size_t n = 0, begin = 0; n < s.solid.faces.size(); begin = s.solid.faces[n++].end) {
    const CutFace& f = s.solid.faces[n];
    const auto edges = std::span(s.solid.edges).subspan(begin, f.end - begin);
    const Vec3 area = sums.add(s.solid, edges);
    if (f.origin == Origin::solid) continue;
    o.area += area;
    if (f.origin != Origin::first_plane) continue;
    o.first = area.norm();
    o.middle = sums.apex + middle_of(sums.first_moment(s.solid, edges), area);
  }
  if (!(sums.volume > 0)) return {};
  o.volume = sums.volume;
  o.centroid = sums.apex + sums.moment / sums.volume;
  if (!(o.first > 0)) o.middle = o.centroid;
  o.depth = planes[0].offset - planes[0].normal.dot(o.centroid);
  if (is_film(o, hair)) o = {};
  return o;
}

}  // namespace ejecta
