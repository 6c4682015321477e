#include "coupling/resolved/resolved.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"

namespace ejecta {
namespace {

/// Depth, in cells along the normal, over which the forcing of a cell grows to full strength as the surface
/// passes its centre: spreads the change of a whole cell over several steps.
constexpr double kRamp = 0.2;

}  // namespace

ResolvedCoupling::ResolvedCoupling(const Grid& grid, CouplingSetup setup)
    : grid_(grid),
      setup_(std::move(setup)),
      cut_map_(grid, setup_.periodic),
      planes_(static_cast<std::size_t>(grid.nz())) {}

ResolvedCoupling::Extent ResolvedCoupling::extent(const Body& body) const {
  Extent e{};
  const double r = body.shape.bounding_radius();
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    e.lower[d] = 0;
    e.upper[d] = axis.n;
    if (!grid_.active(d)) continue;  // two-dimensional flow: the body is cut by the plane of the cells
    const double low = body.position[d] - r, high = body.position[d] + r;
    if (high < axis.face.front() || low > axis.face.back()) e.empty = true;
    e.lower[d] = axis.cell_at(low);
    e.upper[d] = axis.cell_at(high) + 1;
  }
  return e;
}

SolidCell ResolvedCoupling::solid_cell(const Body& body, int index, int i, int j, int k,
                                       double distance) const {
  const Vec3 x = grid_.centre(i, j, k);
  const int at[3] = {i, j, k};
  SolidCell c;
  c.i = i;
  c.j = j;
  c.k = k;
  c.body = index;
  const Vec3 v = body.velocity_at(x);
  for (int d = 0; d < 3; ++d) c.solid[d] = static_cast<Real>(v[d]);

  Vec3 normal = body.orientation * body.shape.gradient(body.to_body(x));
  double across = 0.0;  // width of the cell along the normal, m
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) normal[d] = 0.0;
    across += std::abs(normal[d]) * grid_.axis(d).width[static_cast<std::size_t>(at[d])];
  }
  if (!(across > 0.0)) return c;
  c.weight = static_cast<Real>(std::min(1.0, -distance / (kRamp * across)));
  if (-distance >= across) return c;  // no fluid next to it
  c.ratio = static_cast<Real>(distance / across);
  const Vec3 image = x + (across - distance) * normal;
  int* lowest[3] = {&c.image_i, &c.image_j, &c.image_k};
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    if (!grid_.active(d)) continue;
    int cell = axis.cell_at(image[d]);
    if (image[d] < axis.centre[static_cast<std::size_t>(cell)]) --cell;
    cell = std::clamp(cell, 0, axis.n - 2);
    const std::size_t low = static_cast<std::size_t>(cell);
    const double span = axis.centre[low + 1] - axis.centre[low];
    *lowest[d] = cell;
    c.fraction[static_cast<std::size_t>(d)] =
        static_cast<Real>(std::clamp((image[d] - axis.centre[low]) / span, 0.0, 1.0));
  }
  return c;
}

/// One row of cells. The signed distance changes by no more than the way moved, so cells that cannot be near
/// the surface are passed over.
void ResolvedCoupling::map_row(const Body& body, int index, const Extent& e, int j, int k,
                               std::vector<SolidCell>& out) const {
  const Axis& axis = grid_.axis(0);
  double known = 0.0, known_at = 0.0;
  bool have = false;
  for (int i = e.lower[0]; i < e.upper[0]; ++i) {
    const double x = axis.centre[static_cast<std::size_t>(i)];
    if (have && known > x - known_at) continue;  // still outside
    const double width = grid_.axis(0).width[static_cast<std::size_t>(i)] +
                         grid_.axis(1).width[static_cast<std::size_t>(j)] +
                         grid_.axis(2).width[static_cast<std::size_t>(k)];
    if (have && -known - (x - known_at) > width) {  // deep inside
      SolidCell c;
      c.i = i, c.j = j, c.k = k, c.body = index;
      const Vec3 v = body.velocity_at(grid_.centre(i, j, k));
      for (int d = 0; d < 3; ++d) c.solid[d] = static_cast<Real>(v[d]);
      out.push_back(c);
      continue;
    }
    known = body.signed_distance(grid_.centre(i, j, k));
    known_at = x;
    have = true;
    if (known < 0.0) out.push_back(solid_cell(body, index, i, j, k, known));
  }
}

void ResolvedCoupling::map(std::span<const Body> bodies, SolidMask& mask) {
  if (setup_.bodies == BodiesAs::cut_cells) return cut_map_.map(bodies, setup_.roughness, mask.cut);
  mask.cells.clear();
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    const Body& body = bodies[static_cast<std::size_t>(b)];
    const Extent e = extent(body);
    if (e.empty) continue;
    for_each_index_dynamic(e.upper[2] - e.lower[2], [&](int plane) {
      std::vector<SolidCell>& list = planes_[static_cast<std::size_t>(plane)];
      list.clear();
      for (int j = e.lower[1]; j < e.upper[1]; ++j) map_row(body, b, e, j, e.lower[2] + plane, list);
    });
    for (int plane = 0; plane < e.upper[2] - e.lower[2]; ++plane) {
      const std::vector<SolidCell>& list = planes_[static_cast<std::size_t>(plane)];
      mask.cells.insert(mask.cells.end(), list.begin(), list.end());
    }
  }
  mask.resize_scratch();
}

void ResolvedCoupling::collect(std::span<const Body> bodies, const SolidMask& mask, double dt,
                               std::span<Load> loads) {
  motion_.resize(bodies.size());
  parts_.assign(bodies.size(), {});
  for (Load& l : loads) l = Load{};
  if (setup_.bodies == BodiesAs::cut_cells) collect_walls(bodies, mask.cut, dt, loads);
  else collect_forcing(bodies, mask, dt, loads);
}

void ResolvedCoupling::collect_walls(std::span<const Body> bodies, const CutCells& cut, double dt,
                                     std::span<Load> loads) {
  std::vector<double>& area = wetted_;
  area.assign(bodies.size(), 0.0);
  for (std::size_t n = 0; n < cut.walls.size(); ++n) {
    const CutWall& w = cut.walls[n];
    const std::size_t b = static_cast<std::size_t>(w.body);
    const Vec3 pressure = cut.pressure_impulse[n] / dt, friction = cut.friction_impulse[n] / dt;
    parts_[b].pressure += pressure;
    parts_[b].friction += friction;
    loads[b].torque += (w.point - bodies[b].position).cross(pressure + friction);
    area[b] += Vec3(w.area[0], w.area[1], w.area[2]).norm();
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    const double displaced = setup_.fluid_density * body.shape.mass_properties().volume;
    loads[b].force = parts_[b].pressure + parts_[b].friction;
    if (area[b] > 0.0) loads[b].force += displaced * (setup_.body_force - setup_.gravity);
    Before& m = motion_[b];
    if (m.known && body.motion == Motion::free && area[b] > 0.0) {
      const double lambda = displaced / (body.mass + displaced);
      loads[b].force += lambda * (m.push.force - loads[b].force);
      loads[b].torque += lambda * (m.push.torque - loads[b].torque);
    }
    m.push = loads[b];
    m.known = true;
  }
}

void ResolvedCoupling::collect_forcing(std::span<const Body> bodies, const SolidMask& mask, double dt,
                                       std::span<Load> loads) {
  std::vector<double>& volume = wetted_;
  volume.assign(bodies.size(), 0.0);
  for (std::size_t n = 0; n < mask.cells.size(); ++n) {
    const SolidCell& c = mask.cells[n];
    const std::size_t b = static_cast<std::size_t>(c.body);
    const Vec3 force = -1.0 / dt * Vec3(mask.impulse[n][0], mask.impulse[n][1], mask.impulse[n][2]);
    loads[b].force += force;
    loads[b].torque += (grid_.centre(c.i, c.j, c.k) - bodies[b].position).cross(force);
    volume[b] += double(c.weight) * grid_.volume(c.i, c.j, c.k);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    Before& m = motion_[b];
    const double fluid_share = setup_.fluid_density * body.shape.mass_properties().volume / body.mass;
    const Vec3 momentum = fluid_share * body.angular_momentum();
    if (m.known && body.motion == Motion::free) {
      loads[b].force += setup_.fluid_density * volume[b] * (body.velocity - m.velocity) / dt;
      if (volume[b] > 0.0) loads[b].torque += (momentum - m.angular_momentum) / dt;
    }
    m.velocity = body.velocity;
    m.angular_momentum = momentum;
    m.known = true;
    if (volume[b] > 0.0)
      loads[b].force -= setup_.fluid_density * body.shape.mass_properties().volume * setup_.gravity;
  }
}

bool ResolvedCoupling::any_inside(std::span<const Body> bodies) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& b) { return !extent(b).empty; });
}

std::vector<double> ResolvedCoupling::state() const {
  std::vector<double> out;
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    const Before& m = motion_[b];
    for (const Vec3& v : {m.velocity, m.angular_momentum, m.push.force, m.push.torque, parts_[b].pressure,
                          parts_[b].friction})
      out.insert(out.end(), v.data(), v.data() + 3);
    out.push_back(m.known);
  }
  return out;
}

void ResolvedCoupling::restore(std::span<const double> state) {
  StateReader in(state, "forces on the bodies");
  motion_.resize(state.size() / 19);
  parts_.resize(motion_.size());
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    for (Vec3* v : {&motion_[b].velocity, &motion_[b].angular_momentum, &motion_[b].push.force,
                    &motion_[b].push.torque, &parts_[b].pressure, &parts_[b].friction})
      *v = in.vec3();
    motion_[b].known = in.whole(0, 1) == 1;
  }
  in.end();
}

}  // namespace ejecta
