#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {
namespace {

struct Corners {
  std::array<Vec3, 3> at;
  Vec3 low, high;
};

/// Whether the edge p - q goes through the inside of the triangle, by more than `tolerance` on both sides.
bool pierces(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t, double tolerance) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const double hp = normal.dot(p - t[0]), hq = normal.dot(q - t[0]);
  if (!(std::min(hp, hq) < -tolerance && std::max(hp, hq) > tolerance)) return false;
  const Vec3 x = p + hp / (hp - hq) * (q - p);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3& a = t[c];
    const Vec3 side = t[(c + 1) % 3] - a;
    if (!(normal.dot(side.cross(x - a)) > tolerance * side.norm())) return false;
  }
  return true;
}

bool cross(const Corners& a, const Corners& b, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c)
    if (pierces(a.at[c], a.at[(c + 1) % 3], b.at, tolerance) ||
        pierces(b.at[c], b.at[(c + 1) % 3], a.at, tolerance))
      return true;
  return false;
}

}  // namespace

void require_not_crossing(const TriangleMesh& mesh, const std::string& name) {
  std::vector<Corners> triangles;
  double size = 0.0;
  for (const auto& t : mesh.triangles) {
    Corners& k = triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) k.at[c] = mesh.vertices[static_cast<std::size_t>(t[c])];
    k.low = k.at[0].cwiseMin(k.at[1]).cwiseMin(k.at[2]);
    k.high = k.at[0].cwiseMax(k.at[1]).cwiseMax(k.at[2]);
    size = std::max(size, (k.high - triangles.front().low).norm());
  }
  // In the order of their lowest x: those that may meet follow each other.
  std::vector<std::size_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return triangles[a].low.x() < triangles[b].low.x(); });
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Corners& a = triangles[order[n]];
    for (std::size_t m = n + 1; m < order.size() && triangles[order[m]].low.x() <= a.high.x(); ++m) {
      const Corners& b = triangles[order[m]];
      if ((a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any()) continue;
      if (!cross(a, b, 1e-7 * size)) continue;
      const Vec3 at = (a.at[0] + a.at[1] + a.at[2]) / 3;
      throw InputError(fmt::format(
          "{}: the surface crosses itself: triangles {} and {} go through each other near ({:.6g}, "
          "{:.6g}, {:.6g}) m; pieces may touch but not share space",
          name, std::min(order[n], order[m]) + 1, std::max(order[n], order[m]) + 1, at.x(), at.y(), at.z()));
    }
  }
}

}  // namespace ejecta
