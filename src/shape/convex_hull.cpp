#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "shape/farthest.hpp"
#include "shape/mass_properties.hpp"
#include "shape/polytope.hpp"

namespace ejecta {
namespace {

constexpr const char* kSolidPoints = "at least four points that do not lie in one plane";
constexpr double kCoplanar = 1e-9;  // of the size: heights below it are none

__extension__ using Wide = __int128;

/// A point on a lattice of 2^-41 of the size of them all, 2000 times finer than what counts as a height:
/// there products of three differences are exact in 128 bits.
using LatticePoint = std::array<double, 3>;
constexpr double kLattice = 2199023255552.0;  // 2^41

std::vector<LatticePoint> on_lattice(const std::vector<Vec3>& points, const Vec3& low, double size) {
  std::vector<LatticePoint> all;
  for (const Vec3& p : points) {
    LatticePoint& q = all.emplace_back();
    for (std::size_t d = 0; d < 3; ++d)
      q[d] = std::round((p[static_cast<int>(d)] - low[static_cast<int>(d)]) / size * kLattice);
  }
  return all;
}

/// Whether d lies above the triangle a, b, c. The hull closes only if such answers agree with each other to
/// the last digit, however many points lie on one line: where doubles cannot tell, integers do.
bool is_above(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d) {
  std::array<double, 3> u, v, w;
  for (std::size_t e = 0; e < 3; ++e) u[e] = b[e] - a[e], v[e] = c[e] - a[e], w[e] = d[e] - a[e];
  const auto volume = [](const auto& p, const auto& q, const auto& r) {
    return (p[1] * q[2] - p[2] * q[1]) * r[0] + (p[2] * q[0] - p[0] * q[2]) * r[1] +
           (p[0] * q[1] - p[1] * q[0]) * r[2];
  };
  const auto sum = [](const auto& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]); };
  const double about = volume(u, v, w);
  if (std::abs(about) > 1e-14 * sum(u) * sum(v) * sum(w)) return about > 0;
  const auto whole = [](const std::array<double, 3>& p) {
    return std::array{static_cast<Wide>(p[0]), static_cast<Wide>(p[1]), static_cast<Wide>(p[2])};
  };
  return volume(whole(u), whole(v), whole(w)) > 0;
}

struct Triangle {
  std::array<int, 3> corners;
  Vec3 normal;                            // outward; its length is twice the area
  std::array<int, 3> beyond{-1, -1, -1};  // the triangle across the edge from each corner to the next
  std::vector<int> above{};               // points that see it and wait to be added
  bool gone = false;
};

struct Hull {
  const std::vector<Vec3>& points;
  std::vector<LatticePoint> lattice;
  double tolerance;
  std::vector<Triangle> triangles{};
  std::vector<int> starts{};  // of a point on the rim of what is taken away: the new triangle from it

  const Vec3& at(int n) const { return points[static_cast<std::size_t>(n)]; }
  Triangle& triangle(int n) { return triangles[static_cast<std::size_t>(n)]; }
  void add(int a, int b, int c) { triangles.push_back({{a, b, c}, (at(b) - at(a)).cross(at(c) - at(a))}); }
  bool sees(int point, const Triangle& t) const {
    const auto on = [this](int n) -> const LatticePoint& { return lattice[static_cast<std::size_t>(n)]; };
    return is_above(on(t.corners[0]), on(t.corners[1]), on(t.corners[2]), on(point));
  }
  /// Each point waits at the first of the triangles from `first` on that it sees; the others lie inside.
  void deal_out(const std::vector<int>& waiting, int first) {
    for (const int p : waiting)
      for (int t = first; t < static_cast<int>(triangles.size()); ++t)
        if (sees(p, triangle(t))) {
          triangle(t).above.push_back(p);
          break;
        }
  }
};

template <class Measure>
int farthest(const std::vector<Vec3>& points, const Measure& measure) {
  const auto it = std::max_element(points.begin(), points.end(),
                                   [&](const Vec3& a, const Vec3& b) { return measure(a) < measure(b); });
  return static_cast<int>(it - points.begin());
}

/// Four points that span a volume.
void first_tetrahedron(Hull& hull) {
  const auto& points = hull.points;
  const int a = farthest(points, [](const Vec3& p) { return p.x(); });
  const int b = farthest(points, [&](const Vec3& p) { return (p - hull.at(a)).norm(); });
  const Vec3 line = (hull.at(b) - hull.at(a)).normalized();
  const int c = farthest(points, [&](const Vec3& p) { return line.cross(p - hull.at(a)).norm(); });
  const Vec3 up = line.cross(hull.at(c) - hull.at(a)).normalized();
  const int d = farthest(points, [&](const Vec3& p) { return std::abs(up.dot(p - hull.at(a))); });
  const double height = up.dot(hull.at(d) - hull.at(a));
  if (!(std::abs(height) > hull.tolerance))
    throw InputError(fmt::format("the {} points lie in a plane", points.size()), {.expected = kSolidPoints});
  const bool above = height > 0;
  for (const auto& [p, q, r] : {std::array{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}})
    above ? hull.add(p, r, q) : hull.add(p, q, r);
}

/// Replaces the triangles that the farthest of the points above triangle `n` sees by a fan from it to their
/// rim (Barber, Dobkin & Huhdanpaa 1996, ACM Trans. Math. Softw. 22:469).
void add_point(Hull& hull, int n) {
  const Triangle& base = hull.triangle(n);
  const auto height = [&](int p) { return base.normal.dot(hull.at(p) - hull.at(base.corners[0])); };
  const int point = *std::max_element(base.above.begin(), base.above.end(),
                                      [&](int p, int q) { return height(p) < height(q); });
  std::vector<int> seen{n}, waiting;
  struct Edge {
    int from, to, outer;
  };
  std::vector<Edge> rim;
  hull.triangle(n).gone = true;
  for (std::size_t k = 0; k < seen.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const int next = hull.triangle(seen[k]).beyond[c];
      if (!hull.triangle(next).gone && hull.sees(point, hull.triangle(next))) {
        hull.triangle(next).gone = true;
        seen.push_back(next);
      }
    }
  for (const int t : seen) {
    Triangle& old = hull.triangle(t);
    for (std::size_t c = 0; c < 3; ++c)
      if (!hull.triangle(old.beyond[c]).gone)
        rim.push_back({old.corners[c], old.corners[(c + 1) % 3], old.beyond[c]});
    for (const int p : old.above)
      if (p != point) waiting.push_back(p);
    old.above = {};
  }
  const int first = static_cast<int>(hull.triangles.size());
  for (const Edge& e : rim) {
    const int fresh = static_cast<int>(hull.triangles.size());
    hull.starts[static_cast<std::size_t>(e.from)] = fresh;
    hull.add(e.from, e.to, point);
    Triangle& outer = hull.triangle(e.outer);
    for (std::size_t c = 0; c < 3; ++c)
      if (outer.corners[c] == e.to && outer.corners[(c + 1) % 3] == e.from) outer.beyond[c] = fresh;
    hull.triangle(fresh).beyond[0] = e.outer;
  }
  for (int t = first; t < static_cast<int>(hull.triangles.size()); ++t) {
    const int next = hull.starts[static_cast<std::size_t>(hull.triangle(t).corners[1])];
    hull.triangle(t).beyond[1] = next;
    hull.triangle(next).beyond[2] = t;
  }
  hull.deal_out(waiting, first);
}

using Rim = std::set<std::pair<int, int>>;

/// Corners of a rim that is one simple loop; nothing if it is not.
std::vector<int> walk(const Rim& rim) {
  const std::map<int, int> next(rim.begin(), rim.end());
  std::vector<int> corners;
  if (next.size() != rim.size()) return corners;
  int at = next.begin()->first;
  do {
    corners.push_back(at);
    const auto to = next.find(at);
    if (to == next.end()) return {};
    at = to->second;
  } while (at != corners.front() && corners.size() < next.size());
  return at == corners.front() && corners.size() == next.size() ? corners : std::vector<int>();
}

/// Triangles of one plane joined to a face, where they have one rim. The largest give the planes: the normal
/// of a sliver is mostly round-off.
Polytope merge_faces(Hull& hull) {
  std::vector<int> largest;
  for (int n = 0; n < static_cast<int>(hull.triangles.size()); ++n)
    if (!hull.triangle(n).gone) largest.push_back(n);
  std::stable_sort(largest.begin(), largest.end(), [&](int a, int b) {
    return hull.triangle(a).normal.squaredNorm() > hull.triangle(b).normal.squaredNorm();
  });
  Polytope result;
  std::map<int, int> renamed;
  std::vector<bool> used(hull.triangles.size(), false);
  for (const int n : largest) {
    if (used[static_cast<std::size_t>(n)]) continue;
    const Triangle& own = hull.triangle(n);
    const Vec3 normal = own.normal.normalized();
    const double offset = normal.dot(hull.at(own.corners[0]));
    std::vector<int> group{n};
    used[static_cast<std::size_t>(n)] = true;
    Rim rim;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const Triangle& t = hull.triangle(group[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        const int from = t.corners[c], to = t.corners[(c + 1) % 3];
        if (!rim.erase({to, from})) rim.insert({from, to});
        const std::size_t next = static_cast<std::size_t>(t.beyond[c]);
        const auto& corners = hull.triangles[next].corners;
        if (used[next] || !std::all_of(corners.begin(), corners.end(), [&](int p) {
              return std::abs(normal.dot(hull.at(p)) - offset) <= 2 * hull.tolerance;
            }))
          continue;
        used[next] = true;
        group.push_back(static_cast<int>(next));
      }
    }
    std::vector<int> corners = walk(rim);
    if (corners.empty()) {  // round-off has torn the plane: leave its triangles as they are
      corners.assign(own.corners.begin(), own.corners.end());
      for (const int m : group) used[static_cast<std::size_t>(m)] = m == n;
    }
    result.faces.push_back(
        {normal, offset, static_cast<int>(result.corners.size()), static_cast<int>(corners.size())});
    for (const int corner : corners) {
      const auto [name, fresh] = renamed.emplace(corner, static_cast<int>(result.vertices.size()));
      if (fresh) result.vertices.push_back(hull.at(corner));
      result.corners.push_back(name->second);
    }
  }
  return result;
}

}  // namespace

Polytope convex_hull(const std::vector<Vec3>& points) {
  if (points.size() < 4)
    throw InputError(fmt::format("{} points cannot enclose a solid", points.size()),
                     {.expected = kSolidPoints});
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError("a vertex is not a number");
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  Hull hull{points, on_lattice(points, low, size), kCoplanar * size};
  first_tetrahedron(hull);
  for (int t = 0; t < 4; ++t)
    for (std::size_t c = 0; c < 3; ++c)
      for (int other = 0; other < 4; ++other)
        for (std::size_t d = 0; d < 3; ++d)
          if (hull.triangle(t).corners[c] == hull.triangle(other).corners[(d + 1) % 3] &&
              hull.triangle(t).corners[(c + 1) % 3] == hull.triangle(other).corners[d])
            hull.triangle(t).beyond[c] = other;
  hull.starts.resize(points.size());
  std::vector<int> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  hull.deal_out(all, 0);
  for (int n = 0; n < static_cast<int>(hull.triangles.size()); ++n)
    if (!hull.triangle(n).above.empty()) add_point(hull, n);
  Polytope result = merge_faces(hull);
  const auto hold_by_ball = [&](const Vec3& centre) {
    result.centre = centre;
    result.radius = 0.0;
    for (const Vec3& v : result.vertices) result.radius = std::max(result.radius, (v - centre).norm());
  };
  hold_by_ball(0.5 * (low + high));
  const Farthest farthest(result.vertices);
  for (const Polytope::Face& f : result.faces)
    if (!f.normal.allFinite() || farthest.along(f.normal) > f.offset + 1e-6 * result.radius)
      throw InputError("the points are too nearly in a plane or line to span a solid",
                       {.expected = kSolidPoints});
  hold_by_ball(mass_mesh(triangles_of(result)).centre);
  for (const Polytope::Face& f : result.faces) {
    Vec3 twice(0, 0, 0);
    const auto corner = [&](int n) -> const Vec3& {
      return result.vertices[static_cast<std::size_t>(
          result.corners[static_cast<std::size_t>(f.first + n % f.count)])];
    };
    for (int n = 0; n < f.count; ++n) twice += corner(n).cross(corner(n + 1));
    result.largest_face = std::max(result.largest_face, 0.5 * std::abs(twice.dot(f.normal)));
  }
  return result;
}

}  // namespace ejecta
