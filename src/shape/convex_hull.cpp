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

using Triangle = std::array<int, 3>;

struct Hull {
  const std::vector<Vec3>& points;
  double tolerance;
  std::vector<Triangle> triangles;

  const Vec3& at(int n) const { return points[static_cast<std::size_t>(n)]; }
  Vec3 normal(const Triangle& t) const {
    return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).normalized();
  }
  double height(const Triangle& t, int point) const { return normal(t).dot(at(point) - at(t[0])); }
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
  hull.triangles = {{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}};
  if (height > 0)
    for (Triangle& t : hull.triangles) std::swap(t[1], t[2]);
}

/// Replaces the triangles that `point` sees by a fan from it to their rim.
void add_point(Hull& hull, int point) {
  std::set<std::pair<int, int>> rim;
  std::vector<Triangle> kept;
  for (const Triangle& t : hull.triangles) {
    if (hull.height(t, point) <= hull.tolerance) {
      kept.push_back(t);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const int from = t[c], to = t[(c + 1) % 3];
      if (!rim.erase({to, from})) rim.insert({from, to});
    }
  }
  for (const auto& [from, to] : rim) kept.push_back({from, to, point});
  hull.triangles = std::move(kept);
}

/// Triangles of one plane joined: the rim of each group, walked around.
Polytope merge_faces(const Hull& hull) {
  Polytope result;
  std::map<int, int> renamed;
  std::vector<bool> used(hull.triangles.size(), false);
  for (std::size_t n = 0; n < hull.triangles.size(); ++n) {
    if (used[n]) continue;
    const Vec3 normal = hull.normal(hull.triangles[n]);
    const double offset = normal.dot(hull.at(hull.triangles[n][0]));
    std::set<std::pair<int, int>> rim;
    for (std::size_t m = n; m < hull.triangles.size(); ++m) {
      const Triangle& t = hull.triangles[m];
      const bool same = std::all_of(t.begin(), t.end(), [&](int p) {
        return std::abs(normal.dot(hull.at(p)) - offset) <= 2 * hull.tolerance;
      });
      if (used[m] || !same) continue;
      used[m] = true;
      for (std::size_t c = 0; c < 3; ++c)
        if (!rim.erase({t[(c + 1) % 3], t[c]})) rim.insert({t[c], t[(c + 1) % 3]});
    }
    const std::map<int, int> next(rim.begin(), rim.end());
    Polytope::Face face{normal, offset, static_cast<int>(result.corners.size()), 0};
    int at = next.begin()->first;
    do {
      const auto [name, fresh] = renamed.emplace(at, static_cast<int>(result.vertices.size()));
      if (fresh) result.vertices.push_back(hull.at(at));
      result.corners.push_back(name->second);
      ++face.count;
      at = next.at(at);
    } while (at != next.begin()->first);
    result.faces.push_back(face);
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
  Hull hull{points, 1e-9 * (high - low).norm(), {}};
  first_tetrahedron(hull);
  for (int n = 0; n < static_cast<int>(points.size()); ++n) add_point(hull, n);
  Polytope result = merge_faces(hull);
  result.centre = 0.5 * (low + high);
  for (const Vec3& v : result.vertices) result.radius = std::max(result.radius, (v - result.centre).norm());
  return result;
}

}  // namespace ejecta
