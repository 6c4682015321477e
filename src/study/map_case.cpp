#include "study/map_case.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/symmetry.hpp"
#include "study/map_class.hpp"

namespace ejecta {
namespace {

/// The box goes half of the way with the body, so that its fine cells hold both the jet and the body, and
/// further where they would not hold the body; by whole cells, so that the jet lies in its cells as before.
void follow(AxisSpec& axis, double y, double half_width) {
  if (axis.points.size() < 2 || axis.cells.size() + 1 != axis.points.size()) return;
  const FineBlock fine = fine_block(axis);
  double way = 0.5 * y;
  if (y > 0.0) way = std::max(way, y + half_width - fine.high);
  if (y < 0.0) way = std::min(way, y - half_width - fine.low);
  way = std::round(way / fine.cell) * fine.cell;
  for (double& point : axis.points) point += way;
}

/// Half of what the body takes along the axes of the world, as it lies at first, m.
Vec3 turned_half_extent(const BodySpec& b) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(b.rotation_angle, b.rotation_axis.normalized()).toRotationMatrix();
  return turn.cwiseAbs() * half_extent(b);
}

}  // namespace

Case map_run_case(const Case& base, const Proposal& at) {
  Case c = base;
  BodySpec& body = c.bodies.at(mapped_body(base));
  become(body, drawn_member(base.map, at.at));
  body.along = at.at.x - c.launch.offset_along;
  body.across = at.at.y - c.launch.offset_across;
  if (at.fidelity == Fidelity::coarse) refine(c.grid, base.map.coarse_refinement);
  follow(c.grid.axis[1], at.at.y, turned_half_extent(body).y());
  c.splitter.solid = false;  // the margin is that of the flight, without the plate's blow
  c.run.until = RunUntil::verdict;
  c.output.fields_interval = c.output.slices_interval = 0.0;
  return c;
}

double MapFlight::clearance(const PlatePlace& plate) const {
  const double to_edge = edge_x + plate.x - x;
  if (!(velocity_x > 0.0)) return -(edge_x + plate.x);
  const double t = to_edge / velocity_x;
  return z + velocity_z * t + 0.5 * gravity_z * t * t - (edge_z + plate.z);
}

MapFlight map_flight(const Case& base, const nlohmann::ordered_json& result) {
  const auto& body = result.at("bodies").at(mapped_body(base));
  const auto position = body.at("final_position_m").get<std::array<double, 3>>(),
             velocity = body.at("final_velocity_m_s").get<std::array<double, 3>>();
  const auto edge = result.at("plate").at("edge_from_nozzle_m").get<std::array<double, 2>>();
  return {.outcome = body.value("outcome", "undecided"),
          .x = position[0] - base.jet.nozzle.x(),
          .z = position[2] - base.jet.nozzle.z(),
          .velocity_x = velocity[0],
          .velocity_z = velocity[2],
          .edge_x = edge[0],
          .edge_z = edge[1],
          .gravity_z = base.environment.gravity.z()};
}

double coarse_cost(const Case& base) {
  const double r = base.map.coarse_refinement;
  return r >= 1.0 || base.flow.solver == FlowSolver::none ? 0.0 : std::pow(r, 4);
}

Polygon footprint(const Case& base) {
  const BodySpec& b = base.bodies.at(mapped_body(base));
  const Vec3 half = half_extent(b);
  if (half.isZero()) return {};
  Polygon corners;
  if (b.shape == ShapeKind::sphere) {
    for (int n = 0; n < 48; ++n) {
      const double angle = 2.0 * std::numbers::pi * n / 48;
      corners.push_back({half.x() * std::cos(angle), half.x() * std::sin(angle)});
    }
    return corners;
  }
  // The convex hull of the turned corners of its box.
  const Eigen::AngleAxisd turn(b.rotation_angle, b.rotation_axis.normalized());
  std::vector<Point2> points;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner =
        turn * Vec3(half.x() * (n & 1 ? 1 : -1), half.y() * (n & 2 ? 1 : -1), half.z() * (n & 4 ? 1 : -1));
    points.push_back({corner.x(), corner.y()});
  }
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto turns_left = [](const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 1e-15;
  };
  for (int side = 0; side < 2; ++side) {  // lower, then upper hull (Andrew 1979)
    const std::size_t start = corners.size();
    for (const Point2& p : points) {
      while (corners.size() >= start + 2 &&
             !turns_left(corners[corners.size() - 2], corners[corners.size() - 1], p))
        corners.pop_back();
      corners.push_back(p);
    }
    corners.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return corners;
}

}  // namespace ejecta
