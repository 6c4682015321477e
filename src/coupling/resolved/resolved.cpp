#include "coupling/resolved/resolved.hpp"

#include <algorithm>

#include "base/state_reader.hpp"

namespace ejecta {

ResolvedCoupling::ResolvedCoupling(const Grid& grid, CouplingSetup setup)
    : grid_(grid), setup_(std::move(setup)), cut_map_(grid, setup_.periodic) {}

void ResolvedCoupling::map(std::span<const Body> bodies, CutCells& cut) {
  cut_map_.map(bodies, setup_.roughness, cut);
}

void ResolvedCoupling::collect(std::span<const Body> bodies, const CutCells& cut, double dt,
                               std::span<Load> loads) {
  motion_.resize(bodies.size());
  added_.resize(bodies.size());
  parts_.assign(bodies.size(), {});
  for (Load& l : loads) l = Load{};
  wetted_.assign(bodies.size(), 0.0);
  for (std::size_t n = 0; n < cut.walls.size(); ++n) {
    const CutWall& w = cut.walls[n];
    const std::size_t b = static_cast<std::size_t>(w.body);
    const Vec3 pressure = cut.pressure_impulse[n] / dt, friction = cut.friction_impulse[n] / dt;
    parts_[b].pressure += pressure;
    parts_[b].friction += friction;
    loads[b].torque += (w.point - bodies[b].position).cross(pressure + friction);
    wetted_[b] += Vec3(w.area[0], w.area[1], w.area[2]).norm();
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    const MassProperties& shape = body.shape.mass_properties();
    const double displaced = setup_.fluid_density * shape.volume;
    loads[b].force = parts_[b].pressure + parts_[b].friction;
    if (wetted_[b] > 0.0) {
      loads[b].force += displaced * (setup_.body_force - setup_.gravity);
      loads[b].torque -= 2.0 * setup_.viscosity * shape.volume * body.angular_velocity;
    }
    Before& m = motion_[b];
    if (!m.known) m.push = Load{-body.mass * setup_.gravity, Vec3::Zero()};  // it was held
    if (body.motion == Motion::free && wetted_[b] > 0.0) {
      const AddedMass& with = accelerated_with(b, shape);
      const auto lag = [&](const Vec3& before, Vec3& now, const Vec3& fluid, const Vec3& own) {
        const Vec3 weight = fluid.array() / (own + fluid).array();
        now += body.orientation * weight.cwiseProduct(body.orientation.conjugate() * (before - now));
      };
      lag(m.push.force, loads[b].force, with.mass, Vec3::Constant(body.mass));
      lag(m.push.torque, loads[b].torque, with.inertia, body.inertia);
    }
    m.push = loads[b];
    m.known = true;
  }
}

/// At least what clings to a body however it moves: half of the fluid it displaces, which is all of a
/// sphere's added mass, and in turning what it displaces.
const AddedMass& ResolvedCoupling::accelerated_with(std::size_t body, const MassProperties& shape) {
  AddedMass& a = added_[body];
  if (a.mass.isZero()) {
    a = added_mass(shape, setup_.fluid_density);
    a.mass = a.mass.cwiseMax(0.5 * setup_.fluid_density * shape.volume);
    a.inertia = a.inertia.cwiseMax(setup_.fluid_density * shape.inertia.diagonal());
  }
  return a;
}

/// Whether the sphere around a body reaches into the box.
bool ResolvedCoupling::inside(const Body& body) const {
  const double r = body.shape.bounding_radius();
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    if (grid_.active(d) &&
        (body.position[d] + r < axis.face.front() || body.position[d] - r > axis.face.back()))
      return false;
  }
  return true;
}

bool ResolvedCoupling::any_inside(std::span<const Body> bodies) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& b) { return inside(b); });
}

std::vector<double> ResolvedCoupling::state() const {
  std::vector<double> out;
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    const Before& m = motion_[b];
    for (const Vec3& v : {m.push.force, m.push.torque, parts_[b].pressure, parts_[b].friction})
      out.insert(out.end(), v.data(), v.data() + 3);
    out.push_back(m.known);
  }
  return out;
}

void ResolvedCoupling::restore(std::span<const double> state) {
  StateReader in(state, "forces on the bodies");
  motion_.resize(state.size() / 13);
  parts_.resize(motion_.size());
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    for (Vec3* v :
         {&motion_[b].push.force, &motion_[b].push.torque, &parts_[b].pressure, &parts_[b].friction})
      *v = in.vec3();
    motion_[b].known = in.whole(0, 1) == 1;
  }
  in.end();
}

}  // namespace ejecta
