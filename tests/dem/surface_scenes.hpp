#pragma once
#include <cmath>
#include <memory>
#include <string>

#include "dem/particles.hpp"
#include "scene.hpp"
#include "shape/convex_parts.hpp"

/// Bodies and surfaces of triangles for tests of contacts, without files.
namespace ejecta {

inline Body body_of(const std::string& name, const Shape& shape, const Materials& materials) {
  Body b{name, shape};
  const MassProperties& unit = shape.mass_properties();
  const double density = materials.spec(0).density;
  b.mass = density * unit.volume;
  b.inertia = density * unit.inertia.diagonal();
  b.orientation = shape.frame().rotation;
  return b;
}

inline Wall wall_of(const TriangleMesh& mesh, bool two_sided = false) {
  Wall w;
  w.name = "mesh";
  w.is_plane = false;
  w.surface = std::make_shared<Surface>(mesh, two_sided);
  if (w.surface->closed()) w.solids = convex_pieces(mesh);
  find_seams(w.solids);
  return w;
}

/// The rectangle [-s, s]^2 at z = 0, of n x n squares of two triangles, with its normals upwards.
inline TriangleMesh flat_mesh(int n, double s) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.vertices.emplace_back(s * (2.0 * i / n - 1), s * (2.0 * j / n - 1), 0.0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Mat3& turn, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v = turn * v + by;
  return mesh;
}

inline void join(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// A block of half edges `half`, each face of n x n squares.
inline TriangleMesh block_mesh(const Vec3& half, int n) {
  TriangleMesh soup;
  for (int f = 0; f < 6; ++f) {
    Mat3 turn;
    const int axis = f / 2;
    turn.col(2) = (f % 2 ? 1.0 : -1.0) * Vec3::Unit(axis);
    turn.col(0) = Vec3::Unit((axis + 1) % 3);
    turn.col(1) = turn.col(2).cross(turn.col(0));
    join(soup, moved(flat_mesh(n, 1.0), turn, turn.col(2)));
  }
  TriangleMesh mesh;
  std::vector<int> name;
  for (const Vec3& v : soup.vertices) {
    int found = -1;
    for (std::size_t k = 0; k < mesh.vertices.size() && found < 0; ++k)
      if ((mesh.vertices[k] - v.cwiseProduct(half)).norm() < 1e-9 * half.norm()) found = static_cast<int>(k);
    if (found < 0) {
      found = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(v.cwiseProduct(half));
    }
    name.push_back(found);
  }
  for (const auto& t : soup.triangles)
    mesh.triangles.push_back({name[static_cast<std::size_t>(t[0])], name[static_cast<std::size_t>(t[1])],
                              name[static_cast<std::size_t>(t[2])]});
  return mesh;
}

/// A plate on legs x legs square legs, closed: cells of a lattice that are filled, with their outer faces.
inline TriangleMesh table_mesh(int legs, double size) {
  const int n = 2 * legs - 1;
  const double pitch = size / n;
  const auto filled = [&](int i, int j, int k) {
    if (i < 0 || j < 0 || i >= n || j >= n || k < 0 || k > 1) return false;
    return k == 1 || (i % 2 == 0 && j % 2 == 0);
  };
  TriangleMesh mesh;
  std::vector<int> name(static_cast<std::size_t>((n + 1) * (n + 1) * 3), -1);
  const auto vertex = [&](int i, int j, int k) {
    int& at = name[static_cast<std::size_t>((k * (n + 1) + j) * (n + 1) + i)];
    if (at < 0) {
      at = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(pitch * Vec3(i - 0.5 * n, j - 0.5 * n, k));
    }
    return at;
  };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (int f = 0; f < 6 && filled(i, j, k); ++f) {
          const int axis = f / 2, side = f % 2;
          int d[3] = {0, 0, 0};
          d[axis] = side ? 1 : -1;
          if (filled(i + d[0], j + d[1], k + d[2])) continue;
          int corner[4];
          for (int c = 0; c < 4; ++c) {
            int p[3] = {i, j, k};
            p[axis] += side;
            p[(axis + 1) % 3] += c == 1 || c == 2;
            p[(axis + 2) % 3] += c >= 2;
            corner[c] = vertex(p[0], p[1], p[2]);
          }
          if (!side) std::swap(corner[1], corner[3]);
          mesh.triangles.push_back({corner[0], corner[1], corner[2]});
          mesh.triangles.push_back({corner[0], corner[2], corner[3]});
        }
  return mesh;
}

}  // namespace ejecta
