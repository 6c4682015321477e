#include "dem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace ejecta {
namespace {

constexpr double kDigits = 2e-6;   // of the largest coordinate: a text file with six digits, twice
constexpr double kSameWay = 0.99;  // cosine; a sliver's normal is mostly round-off
constexpr double kSameArea =
    1e-4;                        // a hull whose area exceeds that of the triangles by less is filled by them
constexpr double kFold = -0.99;  // cosine; a surface that turns back more sharply ends there
constexpr int kLeaf = 4;         // triangles in a box that is not divided

using Edge = std::pair<int, int>;

std::size_t at(int n) { return static_cast<std::size_t>(n); }

Vec3 twice_area(const Surface::Triangle& t) {
  return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
}

/// Corners of the convex hull of points in a plane, counter-clockwise about its normal (Andrew 1979); corners
/// within `tolerance` of a side are left out.
std::vector<Vec3> flat_hull(const std::vector<Vec3>& points, const Vec3& normal, double tolerance) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  struct Flat {
    double x, y;
    const Vec3* point;
  };
  std::vector<Flat> flat;
  for (const Vec3& p : points) flat.push_back({u.dot(p), v.dot(p), &p});
  std::sort(flat.begin(), flat.end(),
            [](const Flat& a, const Flat& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  const auto outside = [&](const Flat& a, const Flat& b, const Flat& c) {  // of b from the line a - c, m
    const double dx = c.x - a.x, dy = c.y - a.y, length = std::hypot(dx, dy);
    return length > 0 ? (dy * (b.x - a.x) - dx * (b.y - a.y)) / length : 0.0;
  };
  std::vector<Flat> hull;
  for (int round = 0; round < 2; ++round) {
    const std::size_t start = hull.size();
    for (const Flat& f : flat) {
      while (hull.size() >= start + 2 && outside(hull[hull.size() - 2], hull.back(), f) <= 0.0)
        hull.pop_back();
      hull.push_back(f);
    }
    hull.pop_back();
    std::reverse(flat.begin(), flat.end());
  }
  std::vector<Vec3> corners;
  for (std::size_t n = 0; n < hull.size(); ++n) {
    const Flat &before = hull[(n + hull.size() - 1) % hull.size()], &after = hull[(n + 1) % hull.size()];
    if (outside(before, hull[n], after) > tolerance) corners.push_back(*hull[n].point);
  }
  return corners;
}

double area_of(const std::vector<Vec3>& polygon, const Vec3& normal) {
  Vec3 sum(0, 0, 0);
  for (std::size_t n = 1; n + 1 < polygon.size(); ++n)
    sum += (polygon[n] - polygon[0]).cross(polygon[n + 1] - polygon[0]);
  return 0.5 * sum.dot(normal);
}

}  // namespace

Surface::Surface(const TriangleMesh& mesh, bool two_sided) {
  double largest = 0.0;
  for (const Vec3& v : mesh.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  tolerance_ = kDigits * largest;
  find_regions(mesh);
  build_tree();
  two_sided_ = two_sided && !closed_;
}

bool Surface::Region::holds(const Vec3& point, double margin) const {
  return std::any_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
    const Vec3 out = point - piece.centre;
    if (out.squaredNorm() >= piece.radius * piece.radius) return false;
    for (std::size_t c = 0; c < piece.corners.size(); ++c) {
      const Vec3& from = piece.corners[c];
      const Vec3 along = piece.corners[(c + 1) % piece.corners.size()] - from;
      if (along.cross(plane.normal).dot(point - from) > -margin * along.norm()) return false;
    }
    return true;
  });
}

void Surface::find_regions(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> corners;
  {
    std::map<std::array<int, 3>, bool> known;  // a triangle given twice is there once
    for (std::array<int, 3> t : mesh.triangles) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      if (known.emplace(t, true).second) corners.push_back(t);
    }
  }
  std::map<Edge, std::vector<int>> edges;  // directed
  for (std::size_t n = 0; n < corners.size(); ++n) {
    Triangle& t = triangles_.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      t.corners[c] = mesh.vertices[at(corners[n][c])];
      edges[{corners[n][c], corners[n][(c + 1) % 3]}].push_back(static_cast<int>(n));
    }
    t.normal = twice_area(t).normalized();
    t.region = -1;
  }
  closed_ = std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
    const auto back = edges.find({e.first.second, e.first.first});
    return back != edges.end() && back->second.size() == e.second.size();
  });

  // From the largest triangle, whose normal is the best known, across edges to all that lie in its plane.
  std::vector<int> by_area(triangles_.size());
  std::iota(by_area.begin(), by_area.end(), 0);
  std::stable_sort(by_area.begin(), by_area.end(), [&](int a, int b) {
    return twice_area(triangles_[at(a)]).squaredNorm() > twice_area(triangles_[at(b)]).squaredNorm();
  });
  std::vector<std::vector<int>> groups;
  const auto lies_in = [&](int n, const Vec3& normal, double offset) {
    const Triangle& t = triangles_[at(n)];
    return t.normal.dot(normal) > kSameWay &&
           std::all_of(t.corners.begin(), t.corners.end(),
                       [&](const Vec3& p) { return std::abs(normal.dot(p) - offset) <= tolerance_; });
  };
  for (const int seed : by_area) {
    if (triangles_[at(seed)].region >= 0) continue;
    const int region = static_cast<int>(groups.size());
    std::vector<int>& group = groups.emplace_back(1, seed);
    triangles_[at(seed)].region = region;
    const Vec3 normal = triangles_[at(seed)].normal;
    const double offset = normal.dot(triangles_[at(seed)].corners[0]);
    for (std::size_t n = 0; n < group.size(); ++n)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& t = corners[at(group[n])];
        const auto next = edges.find({t[(c + 1) % 3], t[c]});
        if (next == edges.end()) continue;
        for (const int other : next->second)
          if (triangles_[at(other)].region < 0 && lies_in(other, normal, offset)) {
            triangles_[at(other)].region = region;
            group.push_back(other);
          }
      }
  }
  // Those that no common edge joins: by height above a skew direction, along which few planes agree.
  const Vec3 skew = Vec3(0.5377, 0.7431, 0.3981).normalized();
  std::vector<std::pair<double, int>> heights;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Triangle& t = triangles_[at(groups[g].front())];
    const double lean = t.normal.dot(skew);
    heights.emplace_back(lean, static_cast<int>(g));
  }
  std::sort(heights.begin(), heights.end());
  std::vector<int> joined(groups.size());
  std::iota(joined.begin(), joined.end(), 0);
  for (std::size_t n = 0; n < heights.size(); ++n) {
    const int g = heights[n].second;
    if (joined[at(g)] != g) continue;
    const Triangle& seed = triangles_[at(groups[at(g)].front())];
    const double offset = seed.normal.dot(seed.corners[0]);
    for (std::size_t m = n + 1; m < heights.size() && heights[m].first - heights[n].first < 1e-5; ++m) {
      const int other = heights[m].second;
      if (joined[at(other)] != other) continue;
      if (std::all_of(groups[at(other)].begin(), groups[at(other)].end(),
                      [&](int t) { return lies_in(t, seed.normal, offset); }))
        joined[at(other)] = g;
    }
  }
  std::vector<int> name(groups.size(), -1);
  std::vector<std::vector<std::vector<int>>> parts;  // of each region: groups that edges join
  for (std::size_t g = 0; g < groups.size(); ++g) {
    int& own = name[at(joined[g])];
    if (own < 0) {
      own = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    name[g] = own;
    for (const int t : groups[g]) triangles_[at(t)].region = own;
    parts[at(own)].push_back(std::move(groups[g]));
  }

  // Planes first: the sides of the pieces need those of the neighbours.
  for (const auto& part : parts) {
    Region& region = regions_.emplace_back();
    Vec3 normal(0, 0, 0);
    for (const auto& group : part)
      for (const int t : group) normal += twice_area(triangles_[at(t)]);
    region.plane.normal = normal.normalized();
    double moment = 0.0, area = 0.0;
    for (const auto& group : part)
      for (const int n : group) {
        const Triangle& t = triangles_[at(n)];
        const double size = twice_area(t).norm();
        moment += size / 3 * region.plane.normal.dot(t.corners[0] + t.corners[1] + t.corners[2]);
        area += size;
      }
    region.plane.offset = moment / area;
  }
  // Where the surface turns: of each region its outline's edges with what lies beyond.
  struct Turn {
    Vec3 from, to, normal;
  };
  std::vector<std::vector<Turn>> turns(regions_.size());
  for (std::size_t n = 0; n < corners.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto next = edges.find({corners[n][(c + 1) % 3], corners[n][c]});
      if (next == edges.end() || next->second.size() != 1) continue;
      const int own = triangles_[n].region, other = triangles_[at(next->second[0])].region;
      if (own != other)
        turns[at(own)].push_back(
            {triangles_[n].corners[c], triangles_[n].corners[(c + 1) % 3], regions_[at(other)].plane.normal});
    }
  const auto add_piece = [&](std::size_t r, const std::vector<Vec3>& polygon) {
    Region& region = regions_[r];
    Piece piece{polygon, {}, Vec3(0, 0, 0), 0.0};
    for (const Vec3& p : polygon) piece.centre += p / static_cast<double>(polygon.size());
    const Vec3& normal = region.plane.normal;
    for (std::size_t c = 0; c < polygon.size(); ++c) {
      const Vec3 &from = polygon[c], along = (polygon[(c + 1) % polygon.size()] - from).normalized();
      piece.radius = std::max(piece.radius, (from - piece.centre).norm());
      Vec3 behind = normal;
      for (const Turn& turn : turns[r]) {
        const auto off = [&](const Vec3& p) { return (p - from - along.dot(p - from) * along).norm(); };
        if (off(turn.from) > 2 * tolerance_ || off(turn.to) > 2 * tolerance_) continue;
        if (normal.dot(turn.normal) > kFold) behind = normal + turn.normal;
        break;
      }
      const Vec3 side = along.cross(behind).normalized();
      piece.sides.push_back({side, side.dot(from)});
    }
    region.pieces.push_back(std::move(piece));
  };
  const auto corners_of = [&](const std::vector<int>& group, double& area) {
    std::vector<Vec3> points;
    for (const int n : group) {
      const Triangle& t = triangles_[at(n)];
      points.insert(points.end(), t.corners.begin(), t.corners.end());
      area += 0.5 * twice_area(t).norm();
    }
    return points;
  };
  /// As one polygon, if the triangles fill their hull.
  const auto as_one = [&](std::size_t r, const std::vector<Vec3>& points, double area) {
    const Vec3& normal = regions_[r].plane.normal;
    const std::vector<Vec3> hull = flat_hull(points, normal, tolerance_);
    if (hull.size() < 3 || std::abs(area_of(hull, normal) - area) > kSameArea * area) return false;
    add_piece(r, hull);
    return true;
  };
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    double area = 0.0;
    std::vector<Vec3> points;
    for (const auto& group : parts[r]) {
      const auto more = corners_of(group, area);
      points.insert(points.end(), more.begin(), more.end());
    }
    if (as_one(r, points, area)) continue;
    for (const auto& group : parts[r]) {
      double own = 0.0;
      if (parts[r].size() > 1 && as_one(r, corners_of(group, own), own)) continue;
      for (const int n : group)
        add_piece(r, {triangles_[at(n)].corners.begin(), triangles_[at(n)].corners.end()});
    }
  }
}

void Surface::build_tree() {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto middle = [&](int n, int axis) {
    const auto& c = triangles_[at(n)].corners;
    return c[0][axis] + c[1][axis] + c[2][axis];
  };
  nodes_.push_back({Vec3(0, 0, 0), Vec3(0, 0, 0), 0, 0, static_cast<int>(order_.size())});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int first = nodes_[n].first, count = nodes_[n].count;
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (int k = first; k < first + count; ++k)
      for (const Vec3& p : triangles_[at(order_[at(k)])].corners) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    nodes_[n].low = low;
    nodes_[n].high = high;
    if (count <= kLeaf) continue;
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto begin = order_.begin() + first, half = begin + count / 2;
    std::nth_element(begin, half, begin + count, [&](int a, int b) {
      return std::pair(middle(a, axis), a) < std::pair(middle(b, axis), b);
    });
    nodes_[n].child = static_cast<int>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({low, high, 0, first, count / 2});
    nodes_.push_back({low, high, 0, first + count / 2, count - count / 2});
  }
}

/// By the solid angle of the triangles, 4 pi from inside (van Oosterom & Strackee 1983, IEEE Trans. Biomed.
/// Eng. 30:125).
bool Surface::contains(const Vec3& point) const {
  const Node& all = nodes_.front();
  if (!closed_ || (point.array() < all.low.array()).any() || (point.array() > all.high.array()).any())
    return false;
  double angle = 0.0;
  for (const Triangle& t : triangles_) {
    const Vec3 a = t.corners[0] - point, b = t.corners[1] - point, c = t.corners[2] - point;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return angle > 2 * std::numbers::pi;
}

}  // namespace ejecta
