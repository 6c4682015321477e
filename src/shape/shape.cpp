#include "shape/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shape/primitives.hpp"
#include "shape/shape_data.hpp"
#include "shape/surface_nets.hpp"

namespace ejecta {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

double area_balls(const std::vector<Ball>& balls, const Vec3& direction) {
  const Vec3 d = direction.normalized(), u = d.unitOrthogonal(), v = d.cross(u);
  std::vector<std::array<double, 3>> discs;
  for (const Ball& b : balls) discs.push_back({u.dot(b.centre), v.dot(b.centre), b.radius});
  return area_discs(discs);
}

TriangleMesh surface_box(const Vec3& half) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices.push_back(half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
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
                               [&](const BoxGeometry& g) { return distance_box(g.half, p); }},
                    data_->geometry);
}

Vec3 Shape::gradient(const Vec3& p) const {
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return gradient_balls(g.balls, p); },
                               [&](const BoxGeometry& g) { return gradient_box(g.half, p); }},
                    data_->geometry);
}

Vec3 Shape::support(const Vec3& direction) const {
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return support_balls(g.balls, direction); },
                               [&](const BoxGeometry& g) { return support_box(g.half, direction); }},
                    data_->geometry);
}

double Shape::projected_area(const Vec3& direction) const {
  const Vec3 d = direction.normalized().cwiseAbs();
  return std::visit(Overloaded{[&](const BallsGeometry& g) { return area_balls(g.balls, direction); },
                               [&](const BoxGeometry& g) {
                                 return 4.0 * d.dot(Vec3(g.half.y() * g.half.z(), g.half.z() * g.half.x(),
                                                         g.half.x() * g.half.y()));
                               }},
                    data_->geometry);
}

TriangleMesh Shape::surface(double tolerance) const {
  if (!(tolerance > 0)) tolerance = 0.01 * bounding_radius();
  return std::visit(Overloaded{[&](const BallsGeometry& g) {
                                 return g.balls.size() == 1 ? surface_ball(g.balls.front(), tolerance)
                                                            : surface_nets(*this, 5.0 * tolerance);
                               },
                               [&](const BoxGeometry& g) { return surface_box(g.half); }},
                    data_->geometry);
}

double Shape::bounding_radius() const { return data_->bounding_radius; }
double Shape::smallest_feature() const { return data_->smallest_feature; }
const MassProperties& Shape::mass_properties() const { return data_->mass; }
const BodyFrame& Shape::frame() const { return data_->frame; }

}  // namespace ejecta
