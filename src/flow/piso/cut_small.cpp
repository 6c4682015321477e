#include <algorithm>
#include <cmath>

#include "flow/cut_geometry.hpp"
#include "flow/cut_ghosts.hpp"
#include "flow/piso/cut_flow.hpp"
#include "flow/turbulence/wall_law.hpp"

/// CutFlow: cells that others carry and ghosts in solids take what the stencils should see.
namespace ejecta {
namespace {

using Cell = std::array<int, 3>;
using Triple = std::array<Real, 3>;

/// Open part of the face to its carrier below which continuity says little of a small cell.
constexpr Real kLeast = Real(0.25);

}  // namespace

bool CutFlow::thin(const CutCells& cut, const GhostCell& g) const {
  return g.donors == 0 && cut.small_at(g.i, g.j, g.k);
}

void CutFlow::push_thin(const CutCells& cut, ConstFieldView p, Real dt) {
  const GridMetrics& metrics = grid_.metrics();
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    if (!thin(cut, g)) return;
    Triple sum{0, 0, 0}, total{0, 0, 0};
    for_each_open_face_of(
        grid_, cut, *cut.small_at(g.i, g.j, g.k),
        [&](const CutCell& c, int d, const Cell& face, const Cell& beyond, Real sign, Real open, Real) {
          const std::size_t s = static_cast<std::size_t>(d);
          const Real change = p(beyond[0], beyond[1], beyond[2]) - p(c.i, c.j, c.k);
          sum[s] += sign * open * change * metrics[s].inv_distance[face[s]];
          total[s] += open;
        });
    for (std::size_t d = 0; d < 3; ++d)
      if (total[d] > Real(0)) held_[static_cast<std::size_t>(n)][d] -= dt * sum[d] / total[d];
  });
}

/// What the carrier's fluid mixes into it over the time that it passes a cell, and the friction of a plane
/// gap, 12 nu u / gap^2.
std::array<Real, 3> CutFlow::in_gap(const CutCells& cut, const GhostCell& g, const Triple& held,
                                    const std::array<FieldView, 3>& u,
                                    const WallTurbulence& turbulence) const {
  const CutCell& c = *cut.small_at(g.i, g.j, g.k);
  const CutCell& carrier = cut.cells[static_cast<std::size_t>(c.carrier)];
  Real wetted = 0;
  for (int w = c.first_wall; w < c.first_wall + c.walls; ++w)
    wetted += norm(cut.walls[static_cast<std::size_t>(w)].area);
  const Real width = width_along_normal(grid_, c), volume = static_cast<Real>(grid_.volume(c.i, c.j, c.k));
  const Real gap = Real(2) * c.fluid * volume / std::max(wetted, kNearest * volume / width);
  const Real nu = turbulence.density.origin ? nu_ / turbulence.density(carrier.i, carrier.j, carrier.k) : nu_;
  const Real mixes = step_ * norm(held) / width, rubs = Real(12) * step_ * nu / (gap * gap);
  Triple value;
  for (std::size_t e = 0; e < 3; ++e)
    value[e] = (held[e] + mixes * u[e](carrier.i, carrier.j, carrier.k) + rubs * g.solid[e]) /
               (Real(1) + mixes + rubs);
  return value;
}

void CutFlow::extend(const CutCells& cut, const std::array<FieldView, 3>& u,
                     const WallTurbulence& turbulence) {
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    Triple& value = values_[static_cast<std::size_t>(n)];
    value = g.solid;
    if (thin(cut, g)) value = in_gap(cut, g, held_[static_cast<std::size_t>(n)], u, turbulence);
    if (g.donors == 0) return;
    const auto from = [&](ConstFieldView f) { return from_donors(g, f); };
    Triple w{from(u[0]) - g.solid[0], from(u[1]) - g.solid[1], from(u[2]) - g.solid[2]};
    const Real through = dot(w, g.normal);
    Triple along;
    for (std::size_t e = 0; e < 3; ++e) along[e] = w[e] - through * g.normal[e];
    const Real thinner = turbulence.density.origin ? Real(1) / from(turbulence.density) : Real(1);
    const Real nu = thinner * nu_;
    Real linear = nu > Real(0);  // 1: the profile from the image to the wall is linear; 0: the flow slips
    if (turbulence.present()) {
      const Real k = std::max(from(turbulence.k), Real(0)), eddy = thinner * from(turbulence.eddy_viscosity);
      linear =
          std::min(wall_law::conductance(norm(along), g.image, nu, k, 0) * g.image / (nu + eddy), linear);
    }
    const Real tangential = Real(1) - linear * (Real(1) - g.ratio);
    for (std::size_t e = 0; e < 3; ++e) value[e] += g.ratio * through * g.normal[e] + tangential * along[e];
    // A small cell comes to this in the time that the stream takes to pass its fluid: one that has just
    // become small would shake the pressure otherwise.
    const CutCell* small = cut.small_at(g.i, g.j, g.k);
    if (!small) return;
    const Real width = width_along_normal(grid_, *small);
    const Real rate = step_ * (norm(w) + nu / width) / (width * std::max(small->fluid, kNearest));
    const Triple& held = held_[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < 3; ++e) value[e] = (held[e] + rate * value[e]) / (Real(1) + rate);
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < 3; ++e) u[e](g.i, g.j, g.k) = values_[static_cast<std::size_t>(n)][e];
    const CutCell* small = cut.small_at(g.i, g.j, g.k);
    if (!small) return;
    const CutCell& carrier = cut.cells[static_cast<std::size_t>(small->carrier)];
    const std::array<bool, 3> bound = bound_to_carrier(*small);
    for (std::size_t e = 0; e < 3; ++e)
      if (bound[e]) u[e](g.i, g.j, g.k) = u[e](carrier.i, carrier.j, carrier.k);
  });
}

std::array<bool, 3> CutFlow::bound_to_carrier(const CutCell& small) const {
  const Cell at{small.i, small.j, small.k};
  std::array<bool, 3> bound{};
  for (std::size_t d = 0; d < 3; ++d)
    bound[d] = (passable_[2 * d] && at[d] == 0) ||
               (passable_[2 * d + 1] && at[d] + 1 == grid_.n(static_cast<int>(d)));
  return bound;
}

void CutFlow::move_small(const CutCells& cut, const std::array<ConstFieldView, 3>& q,
                         const std::array<FieldView, 3>& u) const {
  const GridMetrics& metrics = grid_.metrics();
  for_each_small(cut, [&](const CutCell& c, const CutCell& carrier) {
    const Cell at{c.i, c.j, c.k}, to{carrier.i, carrier.j, carrier.k};
    const int apart = std::abs(to[0] - at[0]) + std::abs(to[1] - at[1]) + std::abs(to[2] - at[2]);
    const Real near = std::min(Real(4) * c.fluid - Real(1), Real(1));  // to a cell of its own
    if (apart != 1 || near <= Real(0) || c.walls == 0) return;
    // What passes between two small cells follows from both: each by the other they would run away.
    const Cell opposite{2 * at[0] - to[0], 2 * at[1] - to[1], 2 * at[2] - to[2]};
    bool inside = true;
    for (std::size_t d = 0; d < 3; ++d)
      inside = inside && opposite[d] >= 0 && opposite[d] < grid_.n(static_cast<int>(d));
    if (inside && cut.small_at(opposite[0], opposite[1], opposite[2])) return;
    // Relative to the solid, so that round-off of the geometry does not count where all moves with it.
    const Triple solid = cut.walls[static_cast<std::size_t>(c.first_wall)].velocity;
    Real out = 0, across = 0;
    std::size_t along = 0;
    Cell between{};
    for_each_open_face_of(
        grid_, cut, c,
        [&](const CutCell&, int d, const Cell& face, const Cell& beyond, Real sign, Real open, Real area) {
          const std::size_t s = static_cast<std::size_t>(d);
          if (beyond != to) {
            out += sign * open * area * (q[s](face[0], face[1], face[2]) - solid[s]);
          } else if (open >= kLeast) {
            across = sign * open * area;
            along = s;
            between = face;
          }
        });
    if (across == Real(0)) return;
    for (int w = c.first_wall; w < c.first_wall + c.walls; ++w) {
      const CutWall& wall = cut.walls[static_cast<std::size_t>(w)];
      for (std::size_t d = 0; d < 3; ++d) out += wall.area[d] * (wall.velocity[d] - solid[d]);
    }
    const Real velocity = solid[along] - out / across, lower = metrics[along].weight[between[along]];
    const Real own = to[along] > at[along] ? lower : Real(1) - lower;
    const Real asked = (velocity - (Real(1) - own) * u[along](carrier.i, carrier.j, carrier.k)) / own;
    // No further than what the face passes: extrapolated beyond it, what one cell has too much drives the
    // next, and three bodies that meet in the jet end in no number.
    Real& here = u[along](c.i, c.j, c.k);
    here += near * (std::clamp(asked, std::min(here, velocity), std::max(here, velocity)) - here);
  });
}

void CutFlow::extend_to_small(const CutCells& cut, FieldView p) const {
  const auto own = [&](const Cell& at) {
    const int index = cut.index(at[0], at[1], at[2]);
    return index == 0 || (index > 0 && cut.cells[static_cast<std::size_t>(index - 1)].carrier == index - 1);
  };
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    if (!cut.small(static_cast<std::size_t>(n))) return;
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    const CutCell& carrier = cut.cells[static_cast<std::size_t>(c.carrier)];
    const Cell from{carrier.i, carrier.j, carrier.k}, to{c.i, c.j, c.k};
    const Real here = p(from[0], from[1], from[2]);
    Real sum = here;
    const int apart = std::abs(from[0] - to[0]) + std::abs(from[1] - to[1]) + std::abs(from[2] - to[2]);
    for (int d = 0; apart == 1 && d < 3; ++d) {
      const std::size_t s = static_cast<std::size_t>(d);
      if (from[s] == to[s]) continue;
      const Metrics& m = grid_.metrics(d);
      const int away = from[s] > to[s] ? 1 : -1;  // from the small cell
      Cell beyond = from, face = from;
      beyond[s] += away;
      face[s] += away > 0;
      if (face[s] <= 0 || face[s] >= grid_.n(d) || cut.closed[s](face[0], face[1], face[2]) >= Real(1) ||
          !own(beyond))
        continue;
      const Real slope = (p(beyond[0], beyond[1], beyond[2]) - here) * m.inv_distance[face[s]];
      sum -= slope * std::abs(m.centre[from[s]] - m.centre[to[s]]);
    }
    p(c.i, c.j, c.k) = sum;
  });
}

void CutFlow::fold(const CutCells& cut, FieldView f) {
  for_each_small(cut, [f](const CutCell& c, const CutCell& carrier) {
    f(carrier.i, carrier.j, carrier.k) += f(c.i, c.j, c.k);
    f(c.i, c.j, c.k) = 0;
  });
}

void CutFlow::extend_to_solids(const CutCells& cut, FieldView p) {
  extend_to_ghosts(cut, p, scalars_, [&cut](const GhostCell& g) {
    const int index = cut.index(g.i, g.j, g.k);
    return index < 0 || cut.cells[static_cast<std::size_t>(index - 1)].carrier < 0;
  });
}

}  // namespace ejecta
