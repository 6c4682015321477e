#include "simulation/sorter_shot.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "case/extent.hpp"

namespace ejecta {
namespace {

BodySpec body_of(const Case& c, const ShotBody& shot_body, std::size_t n) {
  const FeedParticle& p = shot_body.particle;
  const ParticleClassSpec& k = c.classes[static_cast<std::size_t>(p.kind)];
  BodySpec b;
  b.name = fmt::format("{}-{}", k.name, n);
  b.material = c.materials.front().name;
  b.density = k.density;
  b.on_belt = true;
  const double size = p.size();
  const Vec3 dimensions(size / k.elongation, size, size * k.flatness);
  switch (k.form) {
    case ParticleForm::box:
      b.shape = ShapeKind::box;
      b.size = dimensions;
      break;
    case ParticleForm::sphere:
      b.shape = ShapeKind::sphere;
      b.diameter = size;
      break;
    case ParticleForm::cluster:
      b.shape = ShapeKind::cluster;
      b.size = dimensions;
      b.cluster = {3, 3, k.flatness <= 0.5 ? 1 : 3};
      b.sphere_diameter = 0.5 * size;
      b.true_box_mass = true;
      break;
    case ParticleForm::rock:
      b.shape = ShapeKind::polyhedron;
      for (const Vec3& v : p.prototype->shape.surface().vertices) b.vertices.push_back(p.scale * v);
      break;
    case ParticleForm::mesh:
      b.shape = ShapeKind::mesh;
      b.file = k.file;
      b.scale = p.scale * p.prototype->file_scale;
  }
  const Eigen::AngleAxisd turned(p.turned * orientation_of(p));
  b.rotation_axis = turned.axis();
  b.rotation_angle = turned.angle();
  b.spin = p.spin;
  b.along =
      c.launch.belt_speed * (c.launch.arrives_at - c.valve.opens_at - shot_body.at) - c.launch.offset_along;
  b.across = shot_body.y - c.launch.offset_across;
  return b;
}

/// More fine cells across, where they do not hold all bodies and orifices of the shot.
void widen(AxisSpec& axis, double low, double high) {
  if (axis.points.size() < 2 || axis.cells.size() + 1 != axis.points.size()) return;
  const FineBlock fine = fine_block(axis);
  const auto more = [&](double by) { return std::max(0, static_cast<int>(std::ceil(by / fine.cell))); };
  const int below = more(fine.low - low), above = more(high - fine.high);
  axis.cells[fine.block] += below + above;
  for (std::size_t n = 0; n < axis.points.size(); ++n)
    axis.points[n] += (n <= fine.block ? -below : above) * fine.cell;
}

}  // namespace

Case resolved_case(const Case& sorter, const Shot& shot) {
  Case c = sorter;
  c.sorter = {};
  c.feed = {};
  c.camera = {};
  c.controller = {};
  c.manifold = {};
  c.classes.clear();
  c.run.title = fmt::format("A shot of {}", sorter.run.title);
  c.run.until = RunUntil::verdict;
  c.output.fields_interval = c.output.slices_interval = 0.0;
  c.valve.duration = shot.lasts;
  const Vec3 centre = c.jet.nozzle;
  std::vector<double> places = shot.valves;
  std::sort(places.begin(), places.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  c.jet.nozzle = centre + Vec3(0, places.front(), 0);
  for (std::size_t n = 1; n < places.size(); ++n)
    c.jet.more_nozzles.push_back(centre + Vec3(0, places[n], 0));
  c.bodies.clear();
  for (std::size_t n = 0; n < shot.bodies.size(); ++n) {
    c.bodies.push_back(body_of(sorter, shot.bodies[n], n));
    c.bodies.back().across -= places.front();  // the belt's middle is the first orifice's
  }
  double low = places.front(), high = places.front();
  for (const double place : places) {
    low = std::min(low, place);
    high = std::max(high, place);
  }
  for (const ShotBody& b : shot.bodies) {
    const double radius = b.particle.scale * b.particle.prototype->shape.bounding_radius();
    low = std::min(low, b.y - radius);
    high = std::max(high, b.y + radius);
  }
  widen(c.grid.axis[1], centre.y() + low, centre.y() + high);
  return c;
}

std::vector<ResolvedBody> resolved_bodies(const nlohmann::ordered_json& result) {
  std::vector<ResolvedBody> list;
  for (const auto& body : result.at("bodies"))
    list.push_back({body.value("outcome", "") == "ejected", body.value("velocity_change_z_m_s", 0.0)});
  return list;
}

}  // namespace ejecta
