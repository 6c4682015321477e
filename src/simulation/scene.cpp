#include "simulation/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "case/copies.hpp"
#include "dem/grains.hpp"
#include "dem/walls.hpp"
#include "flow/model/flow_model.hpp"
#include "simulation/grid_walls.hpp"

namespace ejecta {
namespace {

constexpr const char* kFlight = "a body that flies towards +x, or splitter.edge for the place of the plate";
constexpr const char* kOnBelt = "edge = [\"250 mm\", \"60 mm\"]";

/// Height of the path that nothing disturbs, above the plate's edge: that of [launch], or of the first body
/// that moves, m.
double undisturbed_height(const Case& c, const Scene& s) {
  const double edge_x = c.jet.nozzle.x() + c.splitter.distance;
  if (c.launch.enabled) return launch_height_at(c.launch, c.jet.nozzle, c.environment.gravity, edge_x);
  const auto bodies = s.particles.bodies();
  const auto first =
      std::find_if(bodies.begin(), bodies.end(), [](const Body& b) { return b.motion != Motion::fixed; });
  if (first == bodies.end())
    throw InputError("no body moves, so none comes to the plate",
                     {.key = "splitter", .expected = kFlight, .example = kOnBelt});
  const FlightState& start = s.starts[static_cast<std::size_t>(first - bodies.begin())];
  if (!(start.velocity.x() > 0.0))
    throw InputError(
        fmt::format("the first that moves, \"{}\", does not fly towards +x, to the plate", first->name),
        {.key = "splitter", .expected = kFlight, .example = kOnBelt});
  return free_flight(start, c.environment.gravity, (edge_x - start.position.x()) / start.velocity.x()).z();
}

}  // namespace

namespace {

Scene scene_of_bodies(const Case& c, const Grid* grid) {
  Scene s{make_particles(c), {}, {}};
  Particles& particles = s.particles;
  if (grid)
    for (const Wall& wall : grid_walls(c, *grid, particles)) particles.add(wall);
  s.starts = flight_starts(c, particles.bodies());
  if (c.launch.enabled)
    for (std::size_t n = 0; n < c.bodies.size(); ++n) {
      if (!c.bodies[n].on_belt) continue;
      const Body& b = particles.bodies()[n];
      particles.place(static_cast<int>(n), s.starts[n].position, b.orientation, s.starts[n].velocity,
                      b.angular_velocity);
    }
  // What make_particles() could not look at: bodies from the belt, and the walls of the grid.
  if (grid || c.launch.enabled) particles.require_apart();
  if (!c.splitter.enabled || particles.bodies().empty()) return s;
  const double height = c.splitter.edge ? 0.0 : undisturbed_height(c, s);
  s.splitter.emplace(c.splitter, c.jet.nozzle, height, c.environment.gravity.z());
  s.splitter->resize(particles.bodies().size());
  for (std::size_t n = 0; n < particles.bodies().size(); ++n)
    if (particles.bodies()[n].motion == Motion::fixed) s.splitter->leave_out(n);
  if (!c.splitter.solid) return s;
  WallSpec plate = s.splitter->wall();
  if (plate.material.empty()) plate.material = c.bodies.front().material;
  particles.add(make_wall(plate, particles.materials(), ""));
  particles.require_apart();
  return s;
}

}  // namespace

Scene make_scene(const Case& c, const Grid* grid) {
  Scene s = scene_of_bodies(c, grid);
  s.bodies = s.particles.bodies().size();
  if (c.grains.empty()) return s;
  add_grains(c, s.particles);
  s.particles.require_apart();
  return s;
}

Scene scene_of(const Case& c) {
  std::optional<Grid> grid;
  if (c.flow.solver != FlowSolver::none) grid.emplace(make_grid(c));
  return make_scene(with_first_copies(c), grid ? &*grid : nullptr);
}

}  // namespace ejecta
