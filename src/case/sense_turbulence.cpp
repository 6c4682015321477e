#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "case/expression.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/schema.hpp"

/// Formulas of k and epsilon: they must make sense at the start; later the solver takes what is below nothing
/// for still air.
namespace ejecta {
namespace {

// Along each axis: a formula that is wrong between so many places is not found, but the check stays quick.
constexpr std::size_t looks_at_face = 400, looks_at_region = 64;

using Points = std::array<std::vector<double>, 3>;
using Inside = std::function<bool(const Vec3&)>;

void check_formula(const std::string& key, const std::optional<std::string>& text, const Points& at,
                   const Inside& inside, Findings& found) {
  if (!text) return;
  const Expression formula(*text);
  if (formula.is_constant() && formula(0, 0, 0, 0) >= 0.0) return;
  for (const double z : at[2])
    for (const double y : at[1])
      for (const double x : at[0]) {
        const double value = inside({x, y, z}) ? formula(x, y, z, 0.0) : 0.0;
        if (value >= 0.0 && std::isfinite(value)) continue;
        return found.error(
            key,
            fmt::format("the formula gives {} at x, y, z = {:.4g}, {:.4g}, {:.4g} mm at the start",
                        std::isnan(value) ? "no number" : fmt::format("{:.4g}", value), 1e3 * x, 1e3 * y,
                        1e3 * z),
            "nothing below 0 there; max(0, ...) cuts it off", "k = \"= max(0, 0.1 * (1 - (x/0.02)^2))\"");
      }
}

void check_state(const std::string& key, const StateSpec& state, const Points& at, const Inside& inside,
                 Findings& found) {
  check_formula(key + ".k", state.k, at, inside, found);
  check_formula(key + ".epsilon", state.epsilon, at, inside, found);
}

std::vector<double> thinned(const std::vector<double>& all, std::size_t most_looks) {
  const std::size_t step = (all.size() + most_looks - 1) / most_looks;
  std::vector<double> some;
  for (std::size_t n = 0; n < all.size(); n += std::max<std::size_t>(step, 1)) some.push_back(all[n]);
  return some;
}

}  // namespace

void sense_turbulence(const Case& c, Findings& found) {
  const std::optional<Box> box = grid_box(c);
  if (c.flow.solver == FlowSolver::none || c.flow.turbulence == TurbulenceModel::laminar || !box) return;
  Points cells;
  for (std::size_t a = 0; a < 3; ++a) cells[a] = thinned(cell_centres(c.grid.axis[a]), looks_at_face);
  const auto everywhere = [](const Vec3&) { return true; };
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[f];
    const std::string key = std::string("boundary.") + face_names[f];
    const int normal = static_cast<int>(f / 2);
    Points at = cells;
    at[f / 2] = {f % 2 ? box->high[normal] : box->low[normal]};
    check_state(key, face.state, at, everywhere, found);
    for (std::size_t n = 0; n < face.patches.size(); ++n) {
      const PatchSpec& p = face.patches[n];
      const std::string patch_key = fmt::format("{}.patch.{}", key, n);
      check_state(
          patch_key, p.state, at, [&](const Vec3& x) { return (x - p.centre).norm() <= p.radius; }, found);
    }
  }
  for (std::vector<double>& along : cells) along = thinned(along, looks_at_region);
  for (std::size_t n = 0; n < c.initial.size(); ++n) {
    const InitialSpec& region = c.initial[n];
    const auto inside = [&](const Vec3& x) {
      if (!region.box) return true;
      const Vec3 low = (*region.box)[0].cwiseMin((*region.box)[1]);
      const Vec3 high = (*region.box)[0].cwiseMax((*region.box)[1]);
      return Box{low, high}.contains(x);
    };
    check_state(fmt::format("initial.{}", n), region.state, cells, inside, found);
  }
}

}  // namespace ejecta
