#include "shape/faceted_solid.hpp"

#include <algorithm>
#include <cmath>

#include "shape/point_order.hpp"

namespace ejecta {
namespace {

/// Where an edge meets the plane: the same bits for both of its directions, so that neighbouring faces agree.
Vec3 crossing(const Vec3& p, double hp, const Vec3& q, double hq) {
  if (hp == 0) return p;
  if (hq == 0) return q;
  return before(p, q) ? Vec3(p + hp / (hp - hq) * (q - p)) : Vec3(q + hq / (hq - hp) * (p - q));
}

/// One side of a plane as a solid is cut along it.
struct Side {
  Plane away;  // the cutting plane, looking out of this side
  double tolerance;
  FacetedSolid solid;
  FacetedSolid::Face lid{away, {}, true};

  double height(const Vec3& p) const {
    const double h = away.height(p);
    return std::abs(h) <= tolerance ? 0.0 : h;
  }

  void add(const FacetedSolid::Face& face) {
    FacetedSolid::Face kept{face.plane, {}, face.from_cut};
    std::vector<Vec3> leaves, enters;
    for (const auto& [p, q] : face.edges) {
      const double hp = height(p), hq = height(q);
      if (hp < 0 && hq < 0) kept.edges.push_back({p, q});
      if ((hp < 0) == (hq < 0)) continue;
      const Vec3 x = crossing(p, hp, q, hq);
      const FacetedSolid::Edge edge = hp < 0 ? FacetedSolid::Edge{p, x} : FacetedSolid::Edge{x, q};
      (hp < 0 ? leaves : enters).push_back(x);
      if (edge.from != edge.to) kept.edges.push_back(edge);
    }
    // The outline leaves and enters again along one line, always with the face on its left.
    const Vec3 along = face.plane.normal.cross(away.normal);
    const auto earlier = [&](const Vec3& a, const Vec3& b) { return along.dot(a) < along.dot(b); };
    std::stable_sort(leaves.begin(), leaves.end(), earlier);
    std::stable_sort(enters.begin(), enters.end(), earlier);
    for (std::size_t n = 0; n < std::min(leaves.size(), enters.size()); ++n) {
      if (leaves[n] == enters[n]) continue;
      kept.edges.push_back({leaves[n], enters[n]});
      lid.edges.push_back({enters[n], leaves[n]});
    }
    if (!kept.edges.empty()) solid.faces.push_back(std::move(kept));
  }

  FacetedSolid closed() {
    if (!lid.edges.empty()) solid.faces.push_back(std::move(lid));
    return std::move(solid);
  }
};

}  // namespace

double FacetedSolid::volume() const {
  double six = 0.0;
  const Vec3 origin = faces.empty() ? Vec3(0, 0, 0) : faces.front().edges.front().from;
  for (const Face& face : faces) {
    Vec3 twice(0, 0, 0);
    const Vec3& base = face.edges.front().from;
    for (const Edge& e : face.edges) twice += (e.from - base).cross(e.to - base);
    six += (base - origin).dot(face.plane.normal) * twice.dot(face.plane.normal);
  }
  return six / 6.0;
}

std::vector<Vec3> FacetedSolid::corners() const {
  std::vector<Vec3> points;
  for (const Face& face : faces)
    for (const Edge& e : face.edges) points.insert(points.end(), {e.from, e.to});
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

FacetedSolid faceted(const TriangleMesh& mesh) {
  FacetedSolid solid;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t c) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[c])];
    };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    solid.faces.push_back(
        {{normal, normal.dot(at(0))}, {{at(0), at(1)}, {at(1), at(2)}, {at(2), at(0)}}, false});
  }
  return solid;
}

CutSolid cut(const FacetedSolid& solid, const Plane& plane, double tolerance) {
  Side below{plane, tolerance, {}}, above{{-plane.normal, -plane.offset}, tolerance, {}};
  for (const FacetedSolid::Face& face : solid.faces) {
    below.add(face);
    above.add(face);
  }
  return {below.closed(), above.closed()};
}

}  // namespace ejecta
