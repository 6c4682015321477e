#include "shape/surface_nets.hpp"

#include <cmath>
#include <map>

namespace ejecta {
namespace {

struct Lattice {
  int n;
  double h;
  Vec3 origin;
  int index(int i, int j, int k) const { return (k * n + j) * n + i; }
  Vec3 point(int i, int j, int k) const { return origin + h * Vec3(i, j, k); }
};

/// Mean of the crossings of the cell's edges, then two Newton steps onto the surface.
Vec3 cell_vertex(const Shape& shape, const Lattice& l, const std::vector<double>& d, int i, int j, int k) {
  Vec3 sum(0, 0, 0);
  int crossings = 0;
  for (int a = 0; a < 8; ++a)
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | (1 << axis);
      if (a == b) continue;
      const int pa[3] = {i + (a & 1), j + ((a >> 1) & 1), k + (a >> 2)};
      const int pb[3] = {i + (b & 1), j + ((b >> 1) & 1), k + (b >> 2)};
      const double da = d[static_cast<std::size_t>(l.index(pa[0], pa[1], pa[2]))];
      const double db = d[static_cast<std::size_t>(l.index(pb[0], pb[1], pb[2]))];
      if ((da < 0) == (db < 0)) continue;
      const double s = da / (da - db);
      sum += (1 - s) * l.point(pa[0], pa[1], pa[2]) + s * l.point(pb[0], pb[1], pb[2]);
      ++crossings;
    }
  Vec3 p = sum / crossings;
  for (int step = 0; step < 2; ++step) p -= shape.signed_distance(p) * shape.gradient(p);
  return p;
}

}  // namespace

TriangleMesh surface_nets(const Shape& shape, double h) {
  const double reach = shape.bounding_radius() + h;
  const int n = 2 * static_cast<int>(std::ceil(reach / h)) + 2;
  const Lattice l{n, h, Vec3::Constant(-0.5 * h * (n - 1))};
  std::vector<double> d(static_cast<std::size_t>(n) * n * n);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        d[static_cast<std::size_t>(l.index(i, j, k))] = shape.signed_distance(l.point(i, j, k));

  TriangleMesh mesh;
  std::map<int, int> vertex_of_cell;
  const auto vertex = [&](int i, int j, int k) {
    const auto [at, fresh] = vertex_of_cell.emplace(l.index(i, j, k), static_cast<int>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(cell_vertex(shape, l, d, i, j, k));
    return at->second;
  };
  // Each lattice edge that crosses the surface gives a quadrilateral of the four cells around it.
  for (int k = 1; k + 1 < n; ++k)
    for (int j = 1; j + 1 < n; ++j)
      for (int i = 1; i + 1 < n; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const int e[3] = {axis == 0, axis == 1, axis == 2};
          const bool here = d[static_cast<std::size_t>(l.index(i, j, k))] < 0;
          const bool there = d[static_cast<std::size_t>(l.index(i + e[0], j + e[1], k + e[2]))] < 0;
          if (here == there) continue;
          const int u[3] = {e[2], e[0], e[1]}, v[3] = {e[1], e[2], e[0]};
          int q[4] = {vertex(i, j, k), vertex(i - u[0], j - u[1], k - u[2]),
                      vertex(i - u[0] - v[0], j - u[1] - v[1], k - u[2] - v[2]),
                      vertex(i - v[0], j - v[1], k - v[2])};
          if (there) std::swap(q[1], q[3]);
          mesh.triangles.push_back({q[0], q[1], q[2]});
          mesh.triangles.push_back({q[0], q[2], q[3]});
        }
  return mesh;
}

}  // namespace ejecta
