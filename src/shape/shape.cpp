#include "shape/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shape/farthest.hpp"
#include "shape/polytope.hpp"
#include "shape/primitives.hpp"
#include "shape/shape_data.hpp"
#include "shape/surface_nets.hpp"

namespace ejecta {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

double area_balls(const std::vector<Ball>& balls, const Vec3& direction) {
  const Vec3 d = direction.normalized(), u = d.unitOrthogonal(), v = d.cross(u);
  std::vector<std::array<double, 3>> discs;
  for (const Ball& b : balls) discs.push_back({u.dot(b.centre), v.dot(b.centre), b.radius});
  return area_discs(discs);
}

NearestPoint nearest_of(const std::vector<Polytope>& parts, const Vec3& p) {
  NearestPoint nearest = nearest_on_polytope(parts.front(), p);
  for (std::size_t n = 1; n < parts.size(); ++n) {
    const NearestPoint other = nearest_on_polytope(parts[n], p);
    if (other.distance < nearest.distance) nearest = other;
  }
  return nearest;
}

Vec3 support_of(const std::vector<Polytope>& parts, const Vec3& direction) {
  Vec3 best = support_polytope(parts.front(), direction);
  for (const Polytope& part : parts) {
    const Vec3 p = support_polytope(part, direction);
    if (direction.dot(p) > direction.dot(best)) best = p;
  }
  return best;
}

/// Half the sum of the triangles' shadows: exact where no line along `direction` meets the solid twice.
double area_mesh(const TriangleMesh& mesh, const Vec3& direction) {
  const Vec3 d = direction.normalized();
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    sum += std::abs(d.dot((b - a).cross(c - a)));
  }
  return 0.25 * sum;
}

TriangleMesh surface_ball(const Ball& ball, double tolerance) {
  // Chord height of an icosphere edge of angle 1.107/2^levels is radius * angle^2 / 8 along it and about
  // 4/3 of that at the centre of a triangle.
  int levels = 0;
  while (levels < 6 && ball.radius * std::pow(1.107 / (1 << levels), 2) / 6.0 > tolerance) ++levels;
  TriangleMesh mesh = icosphere(levels);
  for (Vec3& v : mesh.vertices) v = ball.centre + ball.radius * v;
  return mesh;
}

}  // namespace

double Shape::signed_distance(const Vec3& p) const {
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return distance_balls(g.balls, p); },
                               [&](const BoxGeometry& g) { return distance_box(g.half, p); },
                               [&](const PolytopesGeometry& g) { return nearest_of(g.parts, p).distance; }},
                    data_->geometry);
}

Vec3 Shape::gradient(const Vec3& p) const {
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return gradient_balls(g.balls, p); },
                               [&](const BoxGeometry& g) { return gradient_box(g.half, p); },
                               [&](const PolytopesGeometry& g) { return nearest_of(g.parts, p).normal; }},
                    data_->geometry);
}

Vec3 Shape::support(const Vec3& direction) const {
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return support_balls(g.balls, direction); },
                               [&](const BoxGeometry& g) { return support_box(g.half, direction); },
                               [&](const PolytopesGeometry& g) { return support_of(g.parts, direction); }},
                    data_->geometry);
}

std::vector<Width> Shape::widths() const {
  if (!balls().empty()) return {{Vec3(0, 0, 0), smallest_feature()}};
  std::vector<Width> list;
  double largest = 0.0;
  for (const Polytope& p : polytopes()) largest = std::max(largest, volume_polytope(p));
  for (const Polytope& p : polytopes()) {
    if (volume_polytope(p) <= kCrumb * largest) continue;
    const std::size_t first = list.size();
    const Farthest farthest(p.vertices);
    for (const Polytope::Face& f : p.faces) {
      const double size = f.offset + farthest.along(-f.normal);
      const bool known =
          std::any_of(list.begin() + static_cast<std::ptrdiff_t>(first), list.end(), [&](const Width& w) {
            return std::abs(w.direction.dot(f.normal)) > 1 - 1e-12 && w.size <= size * (1 + 1e-9);
          });
      if (!known) list.push_back({f.normal, size});
    }
  }
  return list;
}

double Shape::projected_area(const Vec3& direction) const {
  const Vec3 d = direction.normalized().cwiseAbs();
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return area_balls(g.balls, direction); },
                               [&](const BoxGeometry& g) {
                                 return 4.0 * d.dot(Vec3(g.half.y() * g.half.z(), g.half.z() * g.half.x(),
                                                         g.half.x() * g.half.y()));
                               },
                               [&](const PolytopesGeometry& g) { return area_mesh(g.surface, direction); }},
                    data_->geometry);
}

TriangleMesh Shape::surface(double tolerance) const {
  if (!(tolerance > 0)) tolerance = 0.01 * bounding_radius();
  return std::visit(Overloaded{[&](const BallsGeometry& g) {
                                 return g.balls.size() == 1 ? surface_ball(g.balls.front(), tolerance)
                                                            : surface_nets(*this, 5.0 * tolerance);
                               },
                               [&](const BoxGeometry& g) { return triangles_of(g.parts.front()); },
                               [&](const PolytopesGeometry& g) { return g.surface; }},
                    data_->geometry);
}

std::span<const Ball> Shape::balls() const {
  const auto* g = std::get_if<BallsGeometry>(&data_->geometry);
  return g ? std::span<const Ball>(g->balls) : std::span<const Ball>();
}

std::span<const Polytope> Shape::polytopes() const {
  return std::visit(Overloaded{[](const BallsGeometry&) { return std::span<const Polytope>(); },
                               [](const auto& g) { return std::span<const Polytope>(g.parts); }},
                    data_->geometry);
}

double Shape::parts_volume() const { return volume_polytopes(polytopes()); }

double Shape::bounding_radius() const { return data_->bounding_radius; }
double Shape::smallest_feature() const { return data_->smallest_feature; }
const MassProperties& Shape::mass_properties() const { return data_->mass; }
const BodyFrame& Shape::frame() const { return data_->frame; }

}  // namespace ejecta
