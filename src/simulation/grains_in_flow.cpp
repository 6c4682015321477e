#include "simulation/grains_in_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"
#include "case/words.hpp"

namespace ejecta {
namespace {

const drag::Law& law_of(const Case& c) { return drag::kLaws[static_cast<std::size_t>(c.coupling.drag)]; }

Beyond beyond_face(const BoundarySpec& face) {
  switch (face.type) {
    case BoundaryType::wall:
    case BoundaryType::moving_wall:
    case BoundaryType::slip:
    case BoundaryType::symmetry:
    case BoundaryType::velocity:  // a plate that lets the fluid through
      return Beyond::mirror;
    case BoundaryType::periodic:
      return Beyond::periodic;
    default:
      return Beyond::outside;
  }
}

UnresolvedSetup setup_of(const Case& c, double fluid_density) {
  UnresolvedSetup s;
  s.fluid_density = fluid_density;
  s.viscosity = c.fluid.viscosity / fluid_density;
  s.gravity = c.environment.gravity;
  s.body_force = c.flow.body_force;
  s.kernel_width = c.coupling.kernel_width;
  s.drag = law_of(c).find;
  s.acts = c.coupling.exchange == GrainExchange::two_way;
  s.disperses = c.coupling.dispersion;
  s.seed = static_cast<std::uint64_t>(c.grains.front().seed);
  s.works = s.acts && c.flow.solver == FlowSolver::compressible_piso;
  for (std::size_t d = 0; d < 3; ++d)
    s.beyond[d] = {beyond_face(c.boundary[2 * d]), beyond_face(c.boundary[2 * d + 1])};
  return s;
}

constexpr double kFullFluid = 0.99;

}  // namespace

GrainsInFlow::GrainsInFlow(const Case& c, const Grid& grid, double fluid_density, std::size_t first)
    : case_(c), first_(first), fraction_(grid), coupling_(grid, setup_of(c, fluid_density)) {
  fraction_.acts = c.coupling.exchange == GrainExchange::two_way;
}

void GrainsInFlow::map(const Particles& particles, const FlowModel& flow, const CutCells& cut, double dt) {
  const auto grains = particles.bodies().subspan(first_);
  here_.resize(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n)
    here_[n] = particles.presence(static_cast<int>(first_ + n)) == Presence::here;
  coupling_.map(grains, here_, flow.seen(), cut, dt, fraction_);
  largest_reynolds_ = std::max(largest_reynolds_, coupling_.extremes().reynolds);
  least_fraction_ = std::min(least_fraction_, coupling_.extremes().fraction);
}

void GrainsInFlow::collect(const Particles& particles, std::span<Load> loads) {
  coupling_.collect(particles.bodies().subspan(first_), here_, fraction_, loads.subspan(first_));
}

double GrainsInFlow::fastest_drag() const {
  return double(reduce_max(fraction_.drag.cells(),
                           [drag = fraction_.drag.view(), solids = fraction_.solids.view()](
                               int i, int j, int k) { return drag(i, j, k) / (1 - solids(i, j, k)); }));
}

std::vector<CellField> GrainsInFlow::fields() const {
  return {scalar_field("void_fraction", fraction_.solids.view(), -1.0, 1.0),
          scalar_field("drag_coefficient", fraction_.drag.view())};
}

std::vector<std::string> GrainsInFlow::warnings() const {
  const drag::Law& law = law_of(case_);
  std::vector<std::string> all;
  if (largest_reynolds_ > law.most_reynolds)
    all.push_back(fmt::format("the drag law \"{}\" holds up to Re = {:.4g}; grains met {:.4g}",
                              word(case_.coupling.drag), law.most_reynolds, largest_reynolds_));
  if (least_fraction_ < law.least_fraction)
    all.push_back(
        fmt::format("the drag law \"{}\" holds down to a void fraction of {:.2f}; grains met {:.3f}",
                    word(case_.coupling.drag), law.least_fraction, least_fraction_));
  if (fraction_.acts && first_ > 0 && least_fraction_ < kFullFluid)
    all.push_back(
        fmt::format("grains take up to {:.3f} of the room between them; with bodies in the box the fluid "
                    "is dragged by grains but not displaced",
                    1.0 - least_fraction_));
  return all;
}

std::vector<NamedField> GrainsInFlow::state_fields() {
  std::vector<NamedField> all{{"solids", &fraction_.solids}};
  if (case_.flow.solver == FlowSolver::compressible_piso) {
    all.push_back({"work", &fraction_.work});
    all.push_back({"drag", &fraction_.drag});
  } else if (fraction_.acts) {
    all.push_back({"pressure_change_1", &fraction_.pressure_change[0]});
    all.push_back({"pressure_change_2", &fraction_.pressure_change[1]});
  }
  return all;
}

std::vector<double> GrainsInFlow::state() const {
  std::vector<double> s = coupling_.state();
  s.insert(s.begin(), {largest_reynolds_, least_fraction_});
  return s;
}

void GrainsInFlow::restore(std::span<const double> state, std::size_t grains) {
  StateReader in(state.first(std::min<std::size_t>(2, state.size())), "grains");
  largest_reynolds_ = in.number();
  least_fraction_ = in.number();
  in.end();
  coupling_.restore(state.subspan(2), grains);
}

GrainSums grain_sums(const Particles& particles, std::size_t first, const std::string& name) {
  GrainSums s;
  std::vector<double> heights;
  const auto bodies = particles.bodies();
  for (std::size_t n = first; n < bodies.size(); ++n) {
    const Body& b = bodies[n];
    if (particles.presence(static_cast<int>(n)) != Presence::here || (!name.empty() && b.name != name))
      continue;
    ++s.count;
    s.mass += b.mass;
    s.centre += b.mass * b.position;
    s.velocity += b.mass * b.velocity;
    s.kinetic_energy += 0.5 * b.mass * b.velocity.squaredNorm();
    heights.push_back(b.position.z());
  }
  if (s.count == 0) return s;
  s.centre /= s.mass;
  s.velocity /= s.mass;
  const auto at =
      heights.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), at, heights.end());
  s.height = *at;
  return s;
}

PressureDrop pressure_drop(const Grid& grid, ConstFieldView p, double scale) {
  const auto mean = [&](int k) {
    double sum = 0.0, area = 0.0;
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        const double a = grid.volume(i, j, k);
        sum += a * double(p(i, j, k));
        area += a;
      }
    return sum / area;
  };
  const Axis& z = grid.axis(2);
  if (z.n == 1) return {0.0, z.length()};
  // From the two layers next to a face, in a straight line.
  const auto at_face = [&](std::size_t first, std::size_t next, double width) {
    const double p0 = mean(static_cast<int>(first)), p1 = mean(static_cast<int>(next));
    return p0 + (p0 - p1) * 0.5 * width / std::abs(z.centre[next] - z.centre[first]);
  };
  const std::size_t last = static_cast<std::size_t>(z.n) - 1;
  return {scale * (at_face(0, 1, z.width.front()) - at_face(last, last - 1, z.width.back())), z.length()};
}

std::vector<output::Column> grain_columns(bool flow) {
  std::vector<output::Column> c{{"count", "1"}, {"mass", "kg"}};
  for (const char* name : {"x", "y", "z"}) c.push_back({name, "m"});
  for (const char* name : {"velocity_x", "velocity_y", "velocity_z"}) c.push_back({name, "m/s"});
  c.push_back({"height", "m"});
  c.push_back({"kinetic_energy", "J"});
  if (flow) c.push_back({"pressure_drop", "Pa"});
  return c;
}

}  // namespace ejecta
