#include "simulation/replay_header.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "case/load.hpp"
#include "jet/source.hpp"
#include "jet/valve.hpp"
#include "output/body_surface.hpp"

namespace ejecta {
namespace {

constexpr double kPixels = 24000.0, kPixelsAbove = 8000.0;  ///< of the rasters
constexpr double kChordShare = 0.02;  ///< of a body's radius: how far its triangles may lie from its surface

/// The grid begins at a plane of symmetry through the origin.
bool holds_half(const Case& c, const Grid& grid, int axis) {
  return grid.lower()[axis] == 0.0 &&
         c.boundary[static_cast<std::size_t>(2 * axis)].type == BoundaryType::symmetry;
}

std::array<int, 2> pixels_of(const output::SliceRaster& r, double count) {
  const double width = r.upper[0] - r.lower[0], height = r.upper[1] - r.lower[1];
  const double pixel = std::sqrt(width * height / count);
  return {std::clamp(int(width / pixel), 8, 600), std::clamp(int(height / pixel), 8, 600)};
}

/// The plane through the jet's axis, else the middle of the box; drawn whole where the grid holds the half
/// beyond a plane of symmetry through the origin.
output::SliceRaster side_view(const Case& c, const Grid& grid) {
  output::SliceRaster r;
  r.name = "side";
  r.axis = grid.active(2) ? 1 : 2;
  const int up = r.axis == 1 ? 2 : 1;
  const Vec3 low = grid.lower(), high = grid.upper();
  const double nozzle = c.jet.nozzle[r.axis];
  const bool cuts = r.axis == 1 && grid.active(1) && nozzle >= low[1] && nozzle <= high[1];
  r.position = cuts ? nozzle : 0.5 * (low[r.axis] + high[r.axis]);
  r.mirror_x = grid.axisymmetric() || holds_half(c, grid, 0);
  r.mirror_y = up == 1 && holds_half(c, grid, 1);
  r.lower = {r.mirror_x ? -high.x() : low.x(), r.mirror_y ? -high.y() : low[up]};
  r.upper = {high.x(), high[up]};
  r.pixels = pixels_of(r, kPixels);
  return r;
}

/// The plane across the jet through the bodies' way, in a box with three directions.
std::optional<output::SliceRaster> view_from_above(const Case& c, const Grid& grid) {
  const Vec3 low = grid.lower(), high = grid.upper();
  const double at = c.jet.nozzle.z() + c.launch.stand_off;
  if (!c.launch.enabled || grid.axisymmetric() || !grid.active(1) || at < low.z() || at > high.z()) return {};
  output::SliceRaster r;
  r.name = "above";
  r.axis = 2;
  r.position = at;
  r.mirror_x = holds_half(c, grid, 0);
  r.mirror_y = holds_half(c, grid, 1);
  r.lower = {r.mirror_x ? -high.x() : low.x(), r.mirror_y ? -high.y() : low.y()};
  r.upper = {high.x(), high.y()};
  r.pixels = pixels_of(r, kPixelsAbove);
  return r;
}

/// The opening law from the start until it is closed, with its kinks.
std::vector<std::array<double, 2>> opening_of(const Valve& valve) {
  constexpr int kPoints = 200;
  std::vector<double> times = valve.events();
  for (int n = 0; n <= kPoints; ++n) times.push_back(valve.closed_from() * n / kPoints);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<std::array<double, 2>> line;
  for (const double t : times)
    if (t >= 0.0) line.push_back({t, valve.opening(t)});
  return line;
}

}  // namespace

output::ReplayHeader replay_header(const Case& c, const CoupledModel& model) {
  output::ReplayHeader h;
  if (model.flow()) {
    h.domain = {model.grid().lower(), model.grid().upper()};
    h.rasters.push_back(side_view(c, model.grid()));
    if (const auto above = view_from_above(c, model.grid())) h.rasters.push_back(*above);
  }
  for (const Body& b : model.lumps())
    h.bodies.push_back(
        output::make_body_surface(b.name, b.shape.surface(kChordShare * b.shape.bounding_radius())));
  if (model.splitter())
    h.plates.push_back({"dividing plate", model.splitter()->edge(), Vec3(1, 0, 0), Vec3(0, 1, 0),
                        c.splitter.length, Splitter::kWidth, c.splitter.thickness});
  if (model.flow() && has_jet(c)) {
    const Vec3 along = c.jet.direction.normalized();
    h.nozzles.push_back({c.jet.nozzle, along, c.valve.orifice_diameter});
    for (const Vec3& x : c.jet.more_nozzles) h.nozzles.push_back({x, along, c.valve.orifice_diameter});
    h.valve_open.push_back({c.valve.opens_at, c.valve.opens_at + c.valve.duration});
    for (double t : c.valve.more_pulses) h.valve_open.push_back({t, t + c.valve.duration});
    h.valve_opening = opening_of(Valve(c.valve, folder_of(c)));
  }
  if (const std::size_t count = model.particles().bodies().size() - model.first_grain(); count > 0) {
    h.grains = {count, std::min(count, kGrainsShown), 0.0};
    std::vector<double> diameters;
    for (const Body& g : model.particles().bodies().subspan(model.first_grain()))
      diameters.push_back(2 * g.shape.bounding_radius());
    const auto middle = diameters.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(diameters.begin(), middle, diameters.end());
    h.grains.diameter = *middle;
  }
  h.undisturbed = model.undisturbed();
  return h;
}

}  // namespace ejecta
