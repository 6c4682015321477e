#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "shape/principal_axes.hpp"
#include "shape/shape_data.hpp"

namespace ejecta {
namespace {

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(fmt::format("{} must be a positive length, not {} m", what, value));
}

}  // namespace

Shape make_sphere(double diameter) {
  require_positive(diameter, "diameter of a sphere");
  return make_multisphere({{Vec3(0, 0, 0), 0.5 * diameter}});
}

Shape make_box(const Vec3& size) {
  for (int c = 0; c < 3; ++c) require_positive(size[c], "each edge of a box");
  auto data = std::make_shared<ShapeData>();
  data->geometry = BoxGeometry{0.5 * size, {polytope_box(0.5 * size)}};
  data->mass = mass_box(size);
  data->bounding_radius = 0.5 * size.norm();
  data->smallest_feature = size.minCoeff();
  return Shape(data);
}

Shape make_multisphere(const std::vector<Ball>& balls) {
  if (balls.empty())
    throw InputError("a multisphere needs at least one sphere",
                     {.key = "spheres",
                      .expected = "x, y, z and radius of each",
                      .example = R"(spheres = [["0 mm", "0 mm", "0 mm", "5 mm"]])"});
  for (const Ball& b : balls) require_positive(b.radius, "radius of each sphere of a multisphere");
  return make_multisphere(balls, mass_balls(balls));
}

Shape make_multisphere(const std::vector<Ball>& balls, const MassProperties& mass) {
  auto data = std::make_shared<ShapeData>();
  data->mass = mass;
  data->frame = to_principal_axes(data->mass);
  BallsGeometry geometry;
  data->smallest_feature = 2.0 * balls.front().radius;
  for (const Ball& b : balls) {
    geometry.balls.push_back({to_body(data->frame, b.centre), b.radius});
    data->bounding_radius = std::max(data->bounding_radius, geometry.balls.back().centre.norm() + b.radius);
    data->smallest_feature = std::min(data->smallest_feature, 2.0 * b.radius);
  }
  data->geometry = std::move(geometry);
  return Shape(data);
}

Shape make_cluster(const Vec3& size, const std::array<int, 3>& count, double sphere_diameter) {
  require_positive(sphere_diameter, "sphere diameter of a cluster");
  for (int c = 0; c < 3; ++c) {
    if (count[static_cast<std::size_t>(c)] < 1)
      throw InputError(
          "a cluster needs at least one sphere along each edge",
          {.key = "cluster", .expected = "three whole numbers above 0", .example = "cluster = [3, 3, 3]"});
    if (size[c] < sphere_diameter * (1.0 - 1e-12))
      throw InputError(fmt::format("spheres of {} m do not fit into a cluster whose edge is {} m",
                                   sphere_diameter, size[c]),
                       {.key = "sphere_diameter",
                        .expected = "at most the shortest edge",
                        .example = fmt::format("sphere_diameter = \"{:.3g} mm\"", 1e3 * size.minCoeff())});
  }
  const auto along = [&](int axis, int n) {
    const int last = count[static_cast<std::size_t>(axis)] - 1;
    return last == 0 ? 0.0 : (size[axis] - sphere_diameter) * (static_cast<double>(n) / last - 0.5);
  };
  std::vector<Ball> balls;
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i)
        balls.push_back({Vec3(along(0, i), along(1, j), along(2, k)), 0.5 * sphere_diameter});
  return make_multisphere(balls);
}

}  // namespace ejecta
