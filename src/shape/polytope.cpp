#include "shape/polytope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "shape/farthest.hpp"
#include "shape/mass_properties.hpp"

namespace ejecta {
namespace {

constexpr double kSeam = 1e-6;  // of the size: parts that are nearer lie on each other

/// The part of a convex polygon within normal . x < offset.
std::vector<Vec3> cut_polygon(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> kept;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Vec3 &a = polygon[n], &b = polygon[(n + 1) % polygon.size()];
    const double h = normal.dot(a) - offset, g = normal.dot(b) - offset;
    if (h < 0) kept.push_back(a);
    if ((h < 0) != (g < 0)) kept.push_back(a + h / (h - g) * (b - a));
  }
  return kept;
}

const Vec3& corner(const Polytope& p, const Polytope::Face& f, int n) {
  return p.vertices[static_cast<std::size_t>(p.corners[static_cast<std::size_t>(f.first + n)])];
}

/// The part of a convex polytope within normal . x < offset, which must have a volume.
Polytope cut_polytope(const Polytope& p, const Vec3& normal, double offset) {
  std::vector<Vec3> points;
  for (const Polytope::Face& f : p.faces) {
    std::vector<Vec3> polygon;
    for (int c = 0; c < f.count; ++c) polygon.push_back(corner(p, f, c));
    for (const Vec3& v : cut_polygon(polygon, normal, offset)) points.push_back(v);
  }
  return convex_hull(points);
}

}  // namespace

Polytope polytope_box(const Vec3& half) {
  Polytope p;
  for (int c = 0; c < 8; ++c)
    p.vertices.push_back(half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  p.corners = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
  for (int f = 0; f < 6; ++f)
    p.faces.push_back({(f % 2 ? 1.0 : -1.0) * Vec3::Unit(f / 2), half[f / 2], 4 * f, 4});
  p.radius = half.norm();
  p.largest_face = 4 * half.prod() / half.minCoeff();
  return p;
}

Polytope moved(const Polytope& p, const Mat3& rotation, const Vec3& translation) {
  Polytope q = p;
  for (Vec3& v : q.vertices) v = rotation * v + translation;
  for (auto* faces : {&q.faces, &q.seams})
    for (Polytope::Face& f : *faces) {
      f.normal = rotation * f.normal;
      f.offset += f.normal.dot(translation);
    }
  q.centre = rotation * p.centre + translation;
  if (!rotation.isIdentity(0.0) || !translation.isZero(0.0)) q.exact.reset();
  return q;
}

std::vector<Polytope> without(const Polytope& p, const Polytope& q) {
  const double slack = kSeam * (p.radius + q.radius);
  if ((p.centre - q.centre).norm() > p.radius + q.radius) return {p};
  const Farthest of_q(q.vertices);
  for (const Polytope::Face& f : p.faces)
    if (f.offset + of_q.along(-f.normal) <= slack) return {p};
  std::vector<Polytope> outside;
  Polytope rest = p;
  for (const Polytope::Face& f : q.faces) {  // cut off what is beyond each face
    const Farthest of_rest(rest.vertices);
    if (f.offset + of_rest.along(-f.normal) <= slack) return {p};
    if (of_rest.along(f.normal) - f.offset <= slack) continue;
    outside.push_back(cut_polytope(rest, -f.normal, -f.offset));
    rest = cut_polytope(rest, f.normal, f.offset);
  }
  return outside;
}

void find_seams(Polytope& p, const Polytope& q) {
  const double slack = kSeam * (p.radius + q.radius);
  if ((p.centre - q.centre).norm() > p.radius + q.radius + slack) return;
  const Farthest farthest(q.vertices);
  for (const Polytope::Face& f : p.faces) {
    const double nearest = -farthest.along(-f.normal);
    if (std::abs(nearest - f.offset) > slack) continue;
    std::vector<Vec3> shared;
    for (int c = 0; c < f.count; ++c) shared.push_back(corner(p, f, c));
    for (const Polytope::Face& g : q.faces)
      if (g.normal.dot(f.normal) > -0.99) shared = cut_polygon(shared, g.normal, g.offset);
    if (shared.size() < 3) continue;
    p.seams.push_back(f);
    p.seams.back().first = static_cast<int>(p.corners.size());
    p.seams.back().count = static_cast<int>(shared.size());
    for (const Vec3& v : shared) {
      p.corners.push_back(static_cast<int>(p.vertices.size()));
      p.vertices.push_back(v);
    }
  }
}

void find_seams(std::vector<Polytope>& parts) {
  for (std::size_t n = 0; n < parts.size(); ++n)
    for (std::size_t m = 0; m < parts.size(); ++m)
      if (n != m) find_seams(parts[n], parts[m]);
}

TriangleMesh triangles_of(const Polytope& p) {
  TriangleMesh mesh{p.vertices, {}};
  for (const Polytope::Face& f : p.faces)
    for (int n = 1; n + 1 < f.count; ++n) {
      const auto* c = p.corners.data() + f.first;
      mesh.triangles.push_back({c[0], c[n], c[n + 1]});
    }
  return mesh;
}

TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  using enum TriangleFeature;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, corner_a};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, corner_b};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, edge_ab};
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, corner_c};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, edge_ca};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b), edge_bc};
  return {a + (vb * ab + vc * ac) / (va + vb + vc), face};
}

NearestPoint nearest_on_polytope(const Polytope& p, const Vec3& point) {
  NearestPoint inside{-std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
  for (std::size_t n = 0; n < p.faces.size(); ++n) {
    const double d = p.faces[n].normal.dot(point) - p.faces[n].offset;
    if (d > inside.distance) inside = {d, p.faces[n].normal, static_cast<int>(n)};
  }
  if (inside.distance <= 0) return inside;
  Vec3 nearest = point;
  double best = std::numeric_limits<double>::infinity();
  for (const Polytope::Face& f : p.faces) {
    const double d = f.normal.dot(point) - f.offset;
    if (d <= 0 || d * d >= best) continue;  // a face seen from behind is never the nearest
    for (int n = 1; n + 1 < f.count; ++n) {
      const Vec3 q = nearest_on_triangle(point, corner(p, f, 0), corner(p, f, n), corner(p, f, n + 1)).point;
      const double d2 = (point - q).squaredNorm();
      if (d2 < best) {
        best = d2;
        nearest = q;
      }
    }
  }
  const double distance = std::sqrt(best);
  return {distance, distance > 0 ? Vec3((point - nearest) / distance) : inside.normal, inside.face};
}

Vec3 support_polytope(const Polytope& p, const Vec3& direction) {
  std::size_t farthest = 0;
  double most = direction.dot(p.vertices[0]);
  for (std::size_t n = 1; n < p.vertices.size(); ++n) {
    const double reach = direction.dot(p.vertices[n]);
    if (reach > most) {
      most = reach;
      farthest = n;
    }
  }
  return p.vertices[farthest];
}

Vec3 support_exact(const Polytope& p, const Vec3& direction) {
  return p.exact ? p.exact->support(direction) : support_polytope(p, direction);
}

double volume_polytope(const Polytope& p) { return mass_mesh(triangles_of(p)).volume; }

double volume_polytopes(std::span<const Polytope> parts) {
  return std::accumulate(parts.begin(), parts.end(), 0.0,
                         [](double sum, const Polytope& p) { return sum + volume_polytope(p); });
}

double width_polytope(const Polytope& p) {
  double width = std::numeric_limits<double>::infinity();
  const Farthest farthest(p.vertices);
  for (const Polytope::Face& f : p.faces) width = std::min(width, f.offset + farthest.along(-f.normal));
  return width;
}

double width_polytopes(std::span<const Polytope> parts) {
  double largest = 0.0, width = std::numeric_limits<double>::infinity();
  for (const Polytope& p : parts) largest = std::max(largest, volume_polytope(p));
  for (const Polytope& p : parts)
    if (volume_polytope(p) > kCrumb * largest) width = std::min(width, width_polytope(p));
  return width;
}

}  // namespace ejecta
