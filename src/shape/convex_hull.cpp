#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "shape/polytope.hpp"

namespace ejecta {
namespace {

constexpr double kCoplanar = 1e-9;  // of the size: heights below it are none

__extension__ using Quad = __float128;

/// Whether d lies above the triangle a, b, c. The hull closes only if such answers agree with each other, so
/// where doubles cannot tell, more digits do. (A thing of 1e-30 is round-off of 113 bits: on the triangle.)
bool is_above(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = u.cross(v).dot(w);
  const double most = u.cwiseAbs().sum() * v.cwiseAbs().sum() * w.cwiseAbs().sum();
  if (std::abs(volume) > 1e-14 * most) return volume > 0;
  const auto minus = [](double p, double q) { return static_cast<Quad>(p) - static_cast<Quad>(q); };
  const Quad u0 = minus(b[0], a[0]), u1 = minus(b[1], a[1]), u2 = minus(b[2], a[2]);
  const Quad v0 = minus(c[0], a[0]), v1 = minus(c[1], a[1]), v2 = minus(c[2], a[2]);
  const Quad w0 = minus(d[0], a[0]), w1 = minus(d[1], a[1]), w2 = minus(d[2], a[2]);
  return (u1 * v2 - u2 * v1) * w0 + (u2 * v0 - u0 * v2) * w1 + (u0 * v1 - u1 * v0) * w2 > 1e-30 * most;
}

struct Triangle {
  std::array<int, 3> corners;
  Vec3 normal;  // outward; its length is twice the area
};

struct Hull {
  const std::vector<Vec3>& points;
  double tolerance;
  std::vector<Triangle> triangles;

  const Vec3& at(int n) const { return points[static_cast<std::size_t>(n)]; }
  void add(int a, int b, int c) { triangles.push_back({{a, b, c}, (at(b) - at(a)).cross(at(c) - at(a))}); }
  bool sees(int point, const Triangle& t) const {
    return is_above(at(t.corners[0]), at(t.corners[1]), at(t.corners[2]), at(point));
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
    throw InputError(
        fmt::format("the {} points lie in a plane: a solid needs at least four that do not", points.size()));
  const bool above = height > 0;
  for (const auto& [p, q, r] : {std::array{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}})
    above ? hull.add(p, r, q) : hull.add(p, q, r);
}

/// Replaces the triangles that `point` sees by a fan from it to their rim.
void add_point(Hull& hull, int point) {
  if (std::none_of(hull.triangles.begin(), hull.triangles.end(),
                   [&](const Triangle& t) { return hull.sees(point, t); }))
    return;
  std::set<std::pair<int, int>> rim;
  std::vector<Triangle> kept;
  for (const Triangle& t : hull.triangles) {
    if (!hull.sees(point, t)) {
      kept.push_back(t);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const int from = t.corners[c], to = t.corners[(c + 1) % 3];
      if (!rim.erase({to, from})) rim.insert({from, to});
    }
  }
  hull.triangles = std::move(kept);
  for (const auto& [from, to] : rim) hull.add(from, to, point);
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
  std::stable_sort(hull.triangles.begin(), hull.triangles.end(), [](const Triangle& a, const Triangle& b) {
    return a.normal.squaredNorm() > b.normal.squaredNorm();
  });
  Polytope result;
  std::map<int, int> renamed;
  std::vector<bool> used(hull.triangles.size(), false);
  for (std::size_t n = 0; n < hull.triangles.size(); ++n) {
    if (used[n]) continue;
    const Triangle& own = hull.triangles[n];
    const Vec3 normal = own.normal.normalized();
    const double offset = normal.dot(hull.at(own.corners[0]));
    std::vector<std::size_t> group;
    Rim rim;
    for (std::size_t m = n; m < hull.triangles.size(); ++m) {
      const auto& t = hull.triangles[m].corners;
      const bool same = std::all_of(t.begin(), t.end(), [&](int p) {
        return std::abs(normal.dot(hull.at(p)) - offset) <= 2 * hull.tolerance;
      });
      if (used[m] || !same) continue;
      group.push_back(m);
      for (std::size_t c = 0; c < 3; ++c)
        if (!rim.erase({t[(c + 1) % 3], t[c]})) rim.insert({t[c], t[(c + 1) % 3]});
    }
    std::vector<int> corners = walk(rim);
    if (corners.empty()) {  // round-off has torn the plane: leave its triangles as they are
      corners.assign(own.corners.begin(), own.corners.end());
      group = {n};
    }
    for (const std::size_t m : group) used[m] = true;
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
    throw InputError(fmt::format("{} points cannot enclose a solid (at least 4 are needed)", points.size()));
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError("a vertex is not a number");
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Hull hull{points, kCoplanar * (high - low).norm(), {}};
  first_tetrahedron(hull);
  for (int n = 0; n < static_cast<int>(points.size()); ++n) add_point(hull, n);
  Polytope result = merge_faces(hull);
  result.centre = 0.5 * (low + high);
  for (const Vec3& v : result.vertices) result.radius = std::max(result.radius, (v - result.centre).norm());
  for (const Polytope::Face& f : result.faces)
    if (!f.normal.allFinite() ||
        f.normal.dot(support_polytope(result, f.normal)) > f.offset + 1e-6 * result.radius)
      throw InputError("the points are too nearly in a plane or line to span a solid");
  return result;
}

}  // namespace ejecta
