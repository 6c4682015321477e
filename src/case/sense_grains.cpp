#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/names.hpp"
#include "case/size_distribution.hpp"
#include "case/size_law.hpp"
#include "case/words.hpp"

/// Grains: how many, how large, where, and whether the grid and the flow suit them.
namespace ejecta {
namespace {

constexpr double kClosePacking = std::numbers::pi / (3 * std::numbers::sqrt2);  // 0.7405
constexpr double kRandomPacking = 0.3;  // what one after the other still finds a place
constexpr double kCellsOfGrains = 3.0;  // least width of a cell, in diameters
constexpr double kWideKernel = 6.0;     // diameters: over several cells of less width
constexpr double kDilute = 0.01;        // solids: more is not one grain alone

/// Lognormal, Rosin-Rammler and sieves spread over decades: beyond the largest hundredth, by number, single
/// grains are.
double largest_size(const GrainsSpec& g, const SizeDistribution& sizes) {
  if (g.sizes == SizeLaw::one) return g.size;
  return sizes.quantile(g.sizes == SizeLaw::uniform ? 1.0 : 0.99);
}

/// Nothing where they are not sound, which is told.
std::optional<SizeDistribution> sizes_of(const Case& c, const GrainsSpec& g, const std::string& at,
                                         Findings& found) {
  const std::ptrdiff_t before = found.errors();
  check_size_law(c, g, at, "1 mm", found);
  if (found.errors() > before) return std::nullopt;
  try {
    return size_distribution(g, folder_of(c));
  } catch (const InputError& e) {
    for (Problem p : problems_of(e)) {
      p.key = at + "sieves";
      found.list.push_back(std::move(p));
    }
    return std::nullopt;
  }
}

void check_amount(const GrainsSpec& g, const std::string& at, Findings& found) {
  const int ways = (g.count > 0) + g.mass.has_value() + g.solids_fraction.has_value();
  if (ways == 1) return;
  found.error(at + (ways == 0 ? "count"
                    : g.mass  ? "mass"
                              : "solids_fraction"),
              ways == 0 ? "it is not said how many grains there are"
                        : "it is said more than once how many grains there are",
              "one of `count`, `mass` and `solids_fraction`", "count = 10000");
}

/// kg/m3: its own, or its material's; without a name that is the first.
double density_of(const Case& c, const GrainsSpec& g) {
  if (g.density) return *g.density;
  for (const MaterialSpec& m : c.materials)
    if (m.name == g.material || g.material.empty()) return m.density;
  return 0.0;  // no such material: told elsewhere
}

/// m, of the cells along the axes that have more than one; 1e300: none has.
double narrowest_cell(const Case& c) {
  double narrowest = 1e300;
  for (const AxisSpec& axis : c.grid.axis)
    if (const std::vector<double> centres = cell_centres(axis); centres.size() > 1)
      for (const double x : centres) narrowest = std::min(narrowest, widest_cell(axis, x, x));
  return narrowest;
}

/// Part of the region that is grains.
double packing_of(const Case& c, const GrainsSpec& g, const SizeDistribution& sizes) {
  if (g.solids_fraction) return *g.solids_fraction;
  const Vec3 edges = (*g.region)[1] - (*g.region)[0];
  const double volume =
      g.mass ? *g.mass / density_of(c, g) : g.count * std::numbers::pi / 6 * sizes.mean_power(3);
  return volume / edges.prod();
}

std::string region_line(const Vec3& low, const Vec3& high) {
  return fmt::format("region = [{}, {}]", place_text(low), place_text(high));
}

void check_place(const Case& c, const GrainsSpec& g, const SizeDistribution& sizes, const std::string& at,
                 Findings& found) {
  if (!g.region)
    return found.error(at + "region", "it is not said where the grains start", "two corners of a box",
                       R"(region = [["0 mm", "0 mm", "0 mm"], ["10 mm", "10 mm", "5 mm"]])");
  const Vec3 &low = (*g.region)[0], &high = (*g.region)[1];
  const double d = largest_size(g, sizes);
  if (!((high - low).minCoeff() >= d * (1 - 1e-9)))
    return found.error(
        at + "region",
        fmt::format("the region is {:.4g} x {:.4g} x {:.4g} mm, grains are {:.4g} mm", 1e3 * (high - low).x(),
                    1e3 * (high - low).y(), 1e3 * (high - low).z(), 1e3 * d),
        "the lower and the upper corner, at least a grain apart along each axis",
        region_line(low.cwiseMin(high), low.cwiseMin(high) + Vec3::Constant(10 * d)));
  if (const auto box = grid_box(c); box && c.flow.solver != FlowSolver::none)
    for (int a = 0; a < 3; ++a) {
      const double slack = 1e-9 * (box->high[a] - box->low[a]);
      if (low[a] >= box->low[a] - slack && high[a] <= box->high[a] + slack) continue;
      return found.error(
          at + "region",
          fmt::format("grains start outside the box: {:.4g} to {:.4g} mm along {}, the box is "
                      "{:.4g} to {:.4g} mm",
                      1e3 * low[a], 1e3 * high[a], "xyz"[a], 1e3 * box -> low[a], 1e3 * box -> high[a]),
          "a region inside the box, or a larger box", region_line(box->low, box->high));
    }
  if (g.over > 0.0) return;  // they go on while others come
  const double packed = packing_of(c, g, sizes);
  if (packed > kClosePacking)
    found.error(at + "region",
                fmt::format("grains would fill {:.3f} of the region: closest packing is {:.3f}", packed,
                            kClosePacking),
                "fewer grains or a larger region", "solids_fraction = 0.5");
  else if (packed > kRandomPacking && g.packing == GrainPacking::random)
    found.error(at + "packing",
                fmt::format("grains that fill {:.3f} of the region find no places at random: at most {}",
                            packed, kRandomPacking),
                "\"lattice\", or fewer grains", "packing = \"lattice\"");
}

/// True where they suit.
bool check_cells(const Case& c, const GrainsSpec& g, const SizeDistribution& sizes, const std::string& at,
                 Findings& found) {
  const double narrowest = narrowest_cell(c), d = largest_size(g, sizes), cells = narrowest / d;
  if (cells >= kCellsOfGrains * (1 - 1e-9) || narrowest > 1e299) return true;
  if (c.coupling.kernel_width >= kWideKernel && cells >= 1.0) return true;
  found.error(
      at + "size",
      fmt::format("cells of {:.4g} mm are {:.2f} grains of {:.4g} mm wide: below {:.0f} a grain is no "
                  "longer small in its cell",
                  1e3 * narrowest, cells, 1e3 * d, kCellsOfGrains),
      fmt::format("coarser cells; or grains as [[body]] that the grid resolves (8 cells each); or, down "
                  "to one grain a cell, a wider kernel: coupling.kernel_width of {:.0f}",
                  kWideKernel),
      fmt::format("[coupling] kernel_width = {:.0f}", kWideKernel));
  return false;
}

/// A kernel reaches over so many cells at most (coupling/unresolved/kernel.hpp).
constexpr double kMostCells = 10.0;

void check_kernel(const Case& c, const GrainsSpec& g, const SizeDistribution& sizes, Findings& found) {
  const double most = (kMostCells - 1.0) * narrowest_cell(c) / largest_size(g, sizes);
  if (c.coupling.kernel_width <= most) return;
  found.error("coupling.kernel_width",
              fmt::format("a grain of \"{}\" would spread over more than {:.0f} cells", g.name, kMostCells),
              fmt::format("at most {:.3g} grain diameters in these cells", most),
              fmt::format("kernel_width = {:.3g}", std::floor(most)));
}

/// The fluid that light grains push aside weighs more than they: their exchange, which takes the gradient of
/// pressure as it was a step before, and no added mass, swings up.
constexpr double kLeastDensityRatio = 0.1;

void check_weight(const Case& c, const GrainsSpec& g, const std::string& at, Findings& found) {
  const double density = density_of(c, g), least = kLeastDensityRatio * c.fluid.density;
  if (c.coupling.exchange != GrainExchange::two_way || g.held || density >= least) return;
  found.error(
      at + "density",
      fmt::format("grains of {:.4g} kg/m3 in a fluid of {:.4g} kg/m3: lighter than a tenth of it they "
                  "need their added mass, which is not computed",
                  density, c.fluid.density),
      fmt::format("at least {:.4g} kg/m3, or grains that do not act on the flow", least),
      "[coupling] exchange = \"one-way\"");
}

/// Bodies see walls; through all else grains fly.
void warn_of_open_sides(const Case& c, Findings& found) {
  constexpr const char* kSides[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  if (!c.walls.empty() || std::ranges::all_of(c.grains, [](const GrainsSpec& g) { return g.held; })) return;
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundaryType type = c.boundary[f].type;
    if (cell_centres(c.grid.axis[f / 2]).size() < 2) continue;
    if (type != BoundaryType::slip && type != BoundaryType::symmetry) continue;
    found.warning(
        fmt::format("boundary.{}.type", kSides[f]),
        fmt::format("grains that come to a {} side fly out through it: only walls hold them", word(type)),
        "a plane as [[wall]] there, if they are to bounce", "[[wall]] kind = \"plane\"");
  }
}

/// Where the flow is periodic, grains have to be.
void check_periodic_sides(const Case& c, Findings& found) {
  const auto box = grid_box(c);
  const std::vector<double>* extents[] = {&c.domain.x, &c.domain.y, &c.domain.z};
  for (std::size_t a = 0; box && a < 3; ++a) {
    const int d = static_cast<int>(a);
    const double size = box->high[d] - box->low[d];
    const bool joined = std::find(c.domain.periodic.begin(), c.domain.periodic.end(),
                                  std::string(1, "xyz"[a])) != c.domain.periodic.end();
    const bool same = extents[a]->size() == 2 && std::abs(extents[a]->front() - box->low[d]) < 1e-9 * size &&
                      std::abs(extents[a]->back() - box->high[d]) < 1e-9 * size;
    if (joined != (c.boundary[2 * a].type == BoundaryType::periodic) || (joined && !same))
      found.error(c.bodies.empty() ? "domain.periodic" : "grains.0",
                  fmt::format("grains and flow must both be periodic in {}, over the same length: the box is "
                              "{:.4g} to {:.4g} mm",
                              "xyz"[a], 1e3 * box -> low[d], 1e3 * box -> high[d]),
                  "no [domain] along periodic sides of the box; it follows from them",
                  fmt::format("[boundary.{}_min] type = \"periodic\"", "xyz"[a]));
  }
}

}  // namespace

void sense_grains(const Case& c, Findings& found) {
  if (c.grains.empty()) return;
  check_file_names(c.grains, "grains", found);
  const bool flows = c.flow.solver != FlowSolver::none;
  if (c.flow.solver == FlowSolver::compressible)
    found.error("grains.0", fmt::format("flow.solver \"{}\" does not know grains", word(c.flow.solver)),
                "\"compressible-piso\", \"incompressible\" or \"none\"",
                "[flow] solver = \"compressible-piso\"");
  if (flows && c.grid.geometry == Geometry::axisymmetric)
    found.error("grains.0", "axisymmetric geometry cannot hold grains", "cartesian geometry",
                "geometry = \"cartesian\"");
  if (flows && !(c.fluid.viscosity > 0.0))
    found.error("fluid.viscosity", "drag laws of grains need a viscosity", "a viscosity, more than 0",
                "viscosity = \"1.8e-5 Pa s\"");
  if (c.coupling.dispersion && (!flows || c.flow.turbulence == TurbulenceModel::laminar))
    found.error(
        "coupling.dispersion",
        flows ? "laminar flow has no eddies that spread grains" : "there is no flow that spreads grains",
        "a turbulence model, or no dispersion", "[flow] turbulence = \"k-epsilon\"");
  if (flows) check_periodic_sides(c, found);
  if (flows) warn_of_open_sides(c, found);
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const GrainsSpec& g = c.grains[n];
    const std::string at = fmt::format("grains.{}.", n);
    const std::ptrdiff_t before = found.errors();
    if (!g.material.empty() && std::none_of(c.materials.begin(), c.materials.end(),
                                            [&](const auto& m) { return m.name == g.material; }))
      found.error(at + "material", fmt::format("there is no material \"{}\"", g.material),
                  "a [[material]] of that name", fmt::format("[[material]] name = \"{}\"", g.material));
    if (g.held && !g.velocity.isZero())
      found.error(at + "velocity", "`velocity` does nothing here: the grains are held",
                  "held = false, or no velocity", "held = false");
    const std::optional<SizeDistribution> drawn = sizes_of(c, g, at, found);
    check_amount(g, at, found);
    if (found.errors() > before) continue;
    const SizeDistribution& sizes = *drawn;
    check_place(c, g, sizes, at, found);
    if (flows && check_cells(c, g, sizes, at, found)) check_kernel(c, g, sizes, found);
    if (flows) check_weight(c, g, at, found);
    if (g.from >= c.run.end_time)
      found.error(at + "from",
                  fmt::format("the run ends at {:.4g} ms, before they come", 1e3 * c.run.end_time),
                  "a time before run.end_time", "from = \"0 s\"");
    const bool alone =
        c.coupling.drag == GrainDragLaw::schiller_naumann || c.coupling.drag == GrainDragLaw::stokes;
    if (flows && alone && g.region && g.over == 0.0 && packing_of(c, g, sizes) > kDilute)
      found.warning("coupling.drag",
                    fmt::format("\"{}\" is the drag of one grain alone, but grains fill {:.3f} of the region "
                                "of \"{}\"",
                                word(c.coupling.drag), packing_of(c, g, sizes), g.name),
                    "the drag of grains among others", "drag = \"di-felice\"");
  }
}

}  // namespace ejecta
