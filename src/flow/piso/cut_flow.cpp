#include "flow/piso/cut_flow.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "flow/cut_geometry.hpp"
#include "flow/cut_ghosts.hpp"
#include "flow/turbulence/wall_law.hpp"

namespace ejecta {
namespace {

using Cell = std::array<int, 3>;
using Triple = std::array<Real, 3>;

/// Nearest a centre counts to its wall, parts of a cell: friction there is implicit anyway.
constexpr Real kNearest = Real(0.05);
/// Open part of the face to its carrier below which continuity says little of a small cell.
constexpr Real kLeast = Real(0.25);

/// Closed faces move with their solid.
void hold_closed(const CutCells& cut, const std::array<FieldView, 3>& q) {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    if (f.closed >= Real(1)) q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = f.velocity;
  });
}

}  // namespace

CutFlow::CutFlow(const Grid& grid, double viscosity, const std::array<bool, 6>& passable)
    : grid_(grid), nu_(static_cast<Real>(viscosity)), passable_(passable), carried_(grid.make_field()) {
  carried_.fill(Real(1));
}

Vec3 CutFlow::begin(const CutCells& cut, const std::array<ConstFieldView, 3>& u, ConstFieldView p,
                    double dt) {
  Vec3 sum{0, 0, 0};
  const auto add = [&](int i, int j, int k, double sign) {
    const double part = sign * double(carried_(i, j, k)) * grid_.volume(i, j, k);
    sum += part * Vec3(u[0](i, j, k), u[1](i, j, k), u[2](i, j, k));
  };
  // Cells of before and of now are counted before and after; one in both counts twice each way.
  for (const Cell& c : touched_) add(c[0], c[1], c[2], -1.0);
  for (const Cell& c : touched_) carried_(c[0], c[1], c[2]) = Real(1);
  for (const Cell& c : touched_) add(c[0], c[1], c[2], 1.0);
  touched_.clear();
  const auto touch = [&](int i, int j, int k, Real carried) {
    add(i, j, k, -1.0);
    carried_(i, j, k) = carried;
    add(i, j, k, 1.0);
    if (carried != Real(1)) touched_.push_back({i, j, k});
  };
  for (std::size_t n = 0; n < cut.cells.size(); ++n) {
    const CutCell& c = cut.cells[n];
    touch(c.i, c.j, c.k, c.carrier == static_cast<int>(n) ? c.carried : Real(0));
  }
  for (const GhostCell& g : cut.ghosts)
    if (cut.index(g.i, g.j, g.k) < 0) touch(g.i, g.j, g.k, Real(0));
  // As resume() finds them, so that the sums of a resumed run come out to the same bits.
  std::sort(touched_.begin(), touched_.end(), [](const Cell& a, const Cell& b) {
    return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
  });
  solid_volume_ = 0;
  for (const Cell& c : touched_)
    solid_volume_ += (1.0 - double(carried_(c[0], c[1], c[2]))) * grid_.volume(c[0], c[1], c[2]);
  gradient_.resize(cut.cells.size());
  kept_.resize(cut.cells.size());
  sums_.resize(cut.cells.size());
  values_.resize(cut.ghosts.size());
  list_open_faces(cut);
  step_ = static_cast<Real>(dt);
  held_.resize(cut.ghosts.size());
  for (std::size_t n = 0; n < cut.ghosts.size(); ++n)
    for (std::size_t e = 0; e < 3; ++e) held_[n][e] = u[e](cut.ghosts[n].i, cut.ghosts[n].j, cut.ghosts[n].k);
  if (p.origin) push_thin(cut, p, step_);
  list_closed_ends(cut);
  return sum;
}

void CutFlow::resume() {
  touched_.clear();
  const auto part = carried();
  for (int k = 0; k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i)
        if (part(i, j, k) != Real(1)) touched_.push_back({i, j, k});
}

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

void CutFlow::list_open_faces(const CutCells& cut) {
  faces_of_.resize(cut.cells.size());
  open_faces_.resize(6 * cut.members.size());
  const ConstFieldView at = carried();
  const auto offset = [&](const Cell& c) { return c[0] + c[1] * at.sy + c[2] * at.sz; };
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& carrier = cut.cells[static_cast<std::size_t>(n)];
    if (carrier.carrier != n) return;
    OpenFacesOf& faces = faces_of_[static_cast<std::size_t>(n)];
    faces = {6 * carrier.first_member, 0};
    Triple area_along{0, 0, 0};
    OpenFacePart* const first = open_faces_.data() + faces.first;
    for_each_open_face(
        grid_, cut, carrier,
        [&](const CutCell& c, int d, const Cell& face, const Cell& beyond, Real sign, Real open, Real area) {
          const Metrics& m = grid_.metrics(d);
          const int index = face[static_cast<std::size_t>(d)];
          const Real lower = m.weight[index], weight = sign > 0 ? Real(1) - lower : lower;
          first[faces.count++] = {offset({c.i, c.j, c.k}), offset(beyond), d,
                                  sign * open * area * m.inv_distance[index], sign * open * area * weight};
          area_along[static_cast<std::size_t>(d)] += open * area;
        });
    for (int f = 0; f < faces.count; ++f) first[f].slope /= area_along[static_cast<std::size_t>(first[f].d)];
  });
}

CutFlow::Gradient CutFlow::gradient(const CutCell& carrier, ConstFieldView p) const {
  const OpenFacesOf& faces = faces_of_[static_cast<std::size_t>(carrier.carrier)];
  Gradient g{};
  Triple balance{0, 0, 0};
  for (int f = faces.first; f < faces.first + faces.count; ++f) {
    const OpenFacePart& face = open_faces_[static_cast<std::size_t>(f)];
    const Real change = p.origin[face.beyond] - p.origin[face.here];
    g.value[static_cast<std::size_t>(face.d)] += face.slope * change;
    balance[static_cast<std::size_t>(face.d)] += face.pull * change;
  }
  const Real volume = carrier.carried * static_cast<Real>(grid_.volume(carrier.i, carrier.j, carrier.k));
  for (std::size_t d = 0; d < 3; ++d) g.beyond[d] = volume * g.value[d] - balance[d];
  return g;
}

void CutFlow::rub(CutCells& cut, const CutCell& c, const WallTurbulence& turbulence, Real step, double weight,
                  std::array<Real, 3>& v) const {
  const Real volume = c.carried * static_cast<Real>(grid_.volume(c.i, c.j, c.k));
  const bool turbulent = turbulence.present();
  // Laminar incompressible flow leaves grad u^T out of its stress, which no volume of fluid feels.
  const bool full_stress = turbulent || turbulence.density.origin;
  const Real nu = turbulence.density.origin ? nu_ / turbulence.density(c.i, c.j, c.k) : nu_;
  const Real y =
      turbulent ? wall_distance(grid_, c) : std::max(c.distance, kNearest * width_along_normal(grid_, c));
  for_each_wall(cut, c, [&](const CutWall& wall, int w) {
    const Real area = norm(wall.area);
    if (area <= Real(0)) return;
    const Triple solid = full_stress ? carried_on(wall, y) : wall.velocity;
    // There is no viscous stress along the normal of a wall.
    const Triple moved = along_wall({v[0] - solid[0], v[1] - solid[1], v[2] - solid[2]}, wall.area);
    const Real conductance =
        turbulent ? wall_law::conductance(norm(moved), y, nu, std::max(turbulence.k(c.i, c.j, c.k), Real(0)),
                                          wall.roughness)
                  : nu / y;
    const Real rate = step * area * conductance / volume, part = rate / (Real(1) + rate);
    for (std::size_t e = 0; e < 3; ++e) {
      const Real change = part * moved[e];
      v[e] -= change;
      cut.friction_impulse[static_cast<std::size_t>(w)][int(e)] += weight * double(volume) * double(change);
    }
  });
}

/// d/dt of the mean of x over fluid that walls sweep (Reynolds): sum of their flow times what x has there
/// beyond that mean, over the volume.
std::array<Real, 3> CutFlow::middle_moves(const CutCells& cut, const CutCell& carrier) const {
  const GridMetrics& m = grid_.metrics();
  const Real volume = carrier.carried * static_cast<Real>(grid_.volume(carrier.i, carrier.j, carrier.k));
  const auto from_carrier = [&](const CutCell& c) {
    return Triple{m[0].centre[c.i] - m[0].centre[carrier.i], m[1].centre[c.j] - m[1].centre[carrier.j],
                  m[2].centre[c.k] - m[2].centre[carrier.k]};
  };
  Triple sum{0, 0, 0};
  Real swept = 0;
  for_each_wall(cut, carrier, [&](const CutWall& w, int) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(w.cell)];
    const Triple centre = from_carrier(c);
    const Real through = dot(w.area, w.velocity);
    swept += through;
    for (std::size_t d = 0; d < 3; ++d) sum[d] += through * (centre[d] - c.distance * c.normal[d]);
  });
  if (swept == Real(0)) return {};
  for (int n = carrier.first_member; n < carrier.first_member + carrier.members; ++n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(cut.members[static_cast<std::size_t>(n)])];
    const Real share = c.fluid * static_cast<Real>(grid_.volume(c.i, c.j, c.k)) / volume;
    const Triple centre = from_carrier(c);
    for (std::size_t d = 0; d < 3; ++d) sum[d] -= swept * share * (centre[d] + c.middle[d]);
  }
  for (std::size_t d = 0; d < 3; ++d) sum[d] = grid_.active(int(d)) ? sum[d] / volume : Real(0);
  return sum;
}

Vec3 CutFlow::predict(CutCells& cut, const MomentumTerms& t, const WallTurbulence& turbulence,
                      double weight) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    Vec3& displaced = sums_[static_cast<std::size_t>(n)];
    displaced = Vec3::Zero();
    if (c.carrier != n) return;
    const Triple here{t.u[0](c.i, c.j, c.k), t.u[1](c.i, c.j, c.k), t.u[2](c.i, c.j, c.k)};
    Triple balance{0, 0, 0};
    double outflow = 0.0;
    for_each_open_face(
        grid_, cut, c,
        [&](const CutCell&, int d, const Cell& f, const Cell&, Real sign, Real open, Real area) {
          const FaceMomentum at = momentum_at_face(grid_, t, d, f[0], f[1], f[2]);
          const Real through =
              sign * area * open * t.face_velocity[static_cast<std::size_t>(d)](f[0], f[1], f[2]);
          outflow += double(through);
          for (std::size_t e = 0; e < 3; ++e)
            balance[e] += through * (at.carried[e] - here[e]) - sign * open * area * at.stress[e];
        });
    const Triple g = gradient(c, t.pressure).value;
    gradient_[static_cast<std::size_t>(n)] = g;
    const Real volume = c.carried * static_cast<Real>(grid_.volume(c.i, c.j, c.k)), step = t.b * t.dt;
    // What is balanced is the mean of the fluid; what is kept, the velocity at the centre of the cell.
    const Triple moves = middle_moves(cut, c);
    Triple base, v;
    for (std::size_t e = 0; e < 3; ++e) {
      Real rate = t.acceleration[e] - balance[e] / volume - g[e];
      const Real shifted = moves == Triple{} ? Real(0) : dot(moves, gradient(c, t.u[e]).value);
      rate -= shifted;
      if (t.source[e].origin) rate += t.source[e](c.i, c.j, c.k);
      base[e] = t.b * here[e];
      if (t.a != Real(0)) base[e] += t.a * t.old[e](c.i, c.j, c.k);
      v[e] = base[e] + step * rate;
      displaced[int(e)] = outflow * double(here[e]) - double(volume) * double(shifted);
    }
    rub(cut, c, turbulence, step, weight, v);
    for (std::size_t e = 0; e < 3; ++e) t.out[e](c.i, c.j, c.k) = t.increment_only ? v[e] - base[e] : v[e];
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < 3; ++e)
      t.out[e](g.i, g.j, g.k) = t.increment_only ? Real(0) : t.u[e](g.i, g.j, g.k);
  });
  Vec3 total{0, 0, 0};
  for (const Vec3& s : sums_) total += s;
  return total;
}

void CutFlow::list_closed_ends(const CutCells& cut) {
  closed_ends_.clear();
  const GridMetrics& metrics = grid_.metrics();
  const auto look = [&](int d, const Cell& face, Real closed) {
    const int along = face[static_cast<std::size_t>(d)];
    if (along == 0 || along == grid_.n(d))
      closed_ends_.push_back(
          {d, face, along == 0 ? 1.0 : -1.0, double(closed) * double(face_area_of(metrics, d, face))});
  };
  for (const CutFace& f : cut.faces) look(f.d, {f.i, f.j, f.k}, f.closed);
  for (const CutCell& c : cut.cells) {
    if (!c.locked) continue;
    for (int side = 0; side < 6; ++side) {
      const std::size_t d = static_cast<std::size_t>(side / 2);
      Cell face{c.i, c.j, c.k};
      face[d] += side % 2;
      if (grid_.active(side / 2)) look(side / 2, face, Real(1) - cut.closed[d](face[0], face[1], face[2]));
    }
  }
}

BoundaryFlow CutFlow::through_closed(const MomentumTerms& t) const {
  BoundaryFlow sum;
  for (const ClosedEnd& e : closed_ends_) {
    const auto [i, j, k] = e.face;
    const FaceMomentum at = momentum_at_face(grid_, t, e.d, i, j, k);
    const double q = double(t.face_velocity[static_cast<std::size_t>(e.d)](i, j, k));
    for (std::size_t c = 0; c < 3; ++c)
      sum.momentum[int(c)] += e.sign * e.area * (q * double(at.carried[c]) - double(at.stress[c]));
    sum.volume += e.sign * e.area * q;
    sum.volume_in += std::max(e.sign * e.area * q, 0.0);
  }
  return sum;
}

Vec3 CutFlow::pressure_on_closed(ConstFieldView p) const {
  Vec3 sum{0, 0, 0};
  for (const ClosedEnd& e : closed_ends_) {
    const Real *here = &p(e.face[0], e.face[1], e.face[2]),
               w = grid_.metrics(e.d).weight[e.face[static_cast<std::size_t>(e.d)]];
    sum[e.d] += e.sign * e.area * double(w * here[-stride(p, e.d)] + (Real(1) - w) * here[0]);
  }
  return sum;
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

Real CutFlow::to_middle_of_open(const Grid& grid, const CutCells& cut, int d, const Cell& face,
                                ConstFieldView u) {
  const std::size_t s = static_cast<std::size_t>(d);
  const Real w = grid.metrics(d).weight[face[s]], closed = cut.closed[s](face[0], face[1], face[2]);
  if (closed <= Real(0) || closed >= Real(1)) return 0;
  const auto below = [s](Cell at) {
    --at[s];
    return at;
  };
  const auto between = [&](const Cell& at) {
    const Cell low = below(at);
    return w * u(low[0], low[1], low[2]) + (Real(1) - w) * u(at[0], at[1], at[2]);
  };
  Triple normal{0, 0, 0};
  for (const Cell& side : {below(face), face}) {
    const int index = cut.index(side[0], side[1], side[2]);
    for (std::size_t e = 0; index > 0 && e < 3; ++e)
      if (e != s && grid.active(int(e)))
        normal[e] += cut.cells[static_cast<std::size_t>(index - 1)].normal[e];
  }
  const Real length = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
  Real change = 0;
  for (std::size_t e = 0; e < 3; ++e) {
    if (normal[e] == Real(0)) continue;
    Cell next = face;
    next[e] += normal[e] > 0 ? 1 : -1;
    const Cell low = below(next);
    if (next[e] < 0 || next[e] >= grid.n(int(e)) || cut.index(next[0], next[1], next[2]) < 0 ||
        cut.index(low[0], low[1], low[2]) < 0 || cut.closed[s](next[0], next[1], next[2]) >= Real(1))
      continue;
    change += Real(0.5) * closed * std::abs(normal[e]) / length * (between(next) - between(face));
  }
  return change;
}

void CutFlow::face_velocities(const CutCells& cut, const std::array<ConstFieldView, 3>& u, ConstFieldView p,
                              Real filter_time, const std::array<FieldView, 3>& q) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier == n) gradient_[static_cast<std::size_t>(n)] = gradient(c, p).value;
  });
  // The pressure gradient that moved a cell; false where none did of its own.
  const auto gradient_at = [&](const Cell& c, int d, Real& value) {
    const int index = cut.index(c[0], c[1], c[2]);
    if (index == 0) {
      const Real* at = &p(c[0], c[1], c[2]);
      value = cell_gradient(at, stride(p, d), grid_.metrics(d), c[static_cast<std::size_t>(d)]);
      return true;
    }
    if (index < 0) return false;
    if (cut.cells[static_cast<std::size_t>(index - 1)].carrier != index - 1) return false;
    value = gradient_[static_cast<std::size_t>(index - 1)][static_cast<std::size_t>(d)];
    return true;
  };
  const auto roughness = [&](int d, const Cell& face, Real& value) {
    const std::size_t s = static_cast<std::size_t>(d);
    Real below = 0, above = 0;
    if (face[s] <= 0 || face[s] >= grid_.n(d) || cut.closed[s](face[0], face[1], face[2]) >= Real(1))
      return false;
    Cell low = face;
    --low[s];
    if (!gradient_at(low, d, below) || !gradient_at(face, d, above)) return false;
    const Metrics& m = grid_.metrics(d);
    const Real w = m.weight[face[s]];
    value = w * below + (Real(1) - w) * above -
            (p(face[0], face[1], face[2]) - p(low[0], low[1], low[2])) * m.inv_distance[face[s]];
    return true;
  };
  const auto set = [&](int d, const Cell& face) {
    const std::size_t s = static_cast<std::size_t>(d);
    if (face[s] <= 0 || face[s] >= grid_.n(d)) return;  // of the box
    Cell low = face;
    --low[s];
    const Real w = grid_.metrics(d).weight[face[s]];
    const Real velocity = w * u[s](low[0], low[1], low[2]) + (Real(1) - w) * u[s](face[0], face[1], face[2]) +
                          to_middle_of_open(grid_, cut, d, face, u[s]);
    // As in face_velocities() of the whole grid; not on the last face before a wall, where the gradient of
    // the cell is one-sided and its roughness is not that of p.
    Cell below = face, above = face;
    --below[s];
    ++above[s];
    Real filter = 0, here = 0, low_face = 0, high_face = 0;
    if (roughness(d, face, here) && roughness(d, below, low_face) && roughness(d, above, high_face))
      filter = Real(0.5) * here - Real(0.25) * (low_face + high_face);
    q[s](face[0], face[1], face[2]) = velocity + filter_time * filter;
  };
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    for (int d = 0; d < 3; ++d) {
      if (!grid_.active(d)) continue;
      Cell face{c.i, c.j, c.k};
      set(d, face);
      const std::size_t s = static_cast<std::size_t>(d);
      ++face[s];
      // The cell above sets its lower face itself when it is cut.
      if (face[s] < grid_.n(d) && cut.index(face[0], face[1], face[2]) <= 0) set(d, face);
    }
  });
  hold_closed(cut, q);
}

void CutFlow::end_velocities(const CutCells& cut, const OpenFace& open,
                             const std::array<ConstFieldView, 3>& u, ConstFieldView p, Real dt,
                             const std::array<FieldView, 3>& q) const {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier < 0) return;
    const Cell at{c.i, c.j, c.k};
    for (int side = 0; side < 6; ++side) {
      const int d = side / 2;
      const std::size_t s = static_cast<std::size_t>(d);
      Cell face = at;
      face[s] += side % 2;
      if (!grid_.active(d) || face[s] != (side % 2 ? grid_.n(d) : 0) || !open(side, face)) continue;
      // Of a small cell that of its carrier: they share one pressure, which could not stop what circles
      // through two open ends of one cell.
      const CutCell& mover = cut.cells[static_cast<std::size_t>(c.carrier)];
      const Real* above = &p(face[0], face[1], face[2]);
      const Real at_face = (above[0] - above[-stride(p, d)]) * grid_.metrics(d).inv_distance[face[s]];
      q[s](face[0], face[1], face[2]) = u[s](mover.i, mover.j, mover.k) +
                                        dt * (gradient_[static_cast<std::size_t>(c.carrier)][s] - at_face);
    }
  });
}

void CutFlow::close(const CutCells& cut, const std::array<FieldView, 3>& q) {
  open_velocity_.resize(cut.faces.size());
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    Real& velocity = q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
    open_velocity_[static_cast<std::size_t>(n)] = velocity;
    velocity += f.closed * (f.velocity - velocity);
  });
}

void CutFlow::reopen(const CutCells& cut, const std::array<FieldView, 3>& q) const {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = open_velocity_[static_cast<std::size_t>(n)];
  });
}

void CutFlow::keep(const CutCells& cut, const std::array<ConstFieldView, 3>& u) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < 3; ++e) kept_[static_cast<std::size_t>(n)][e] = u[e](c.i, c.j, c.k);
  });
}

void CutFlow::correct(const CutCells& cut, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
                      const std::array<FieldView, 3>& u) {
  hold_closed(cut, q);
  push_thin(cut, phi, dt);
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Triple g = gradient(c, phi).value;
    for (std::size_t e = 0; e < 3; ++e)
      u[e](c.i, c.j, c.k) = kept_[static_cast<std::size_t>(n)][e] - dt * g[e];
  });
}

void CutFlow::press(CutCells& cut, ConstFieldView p, double dt_density) const {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Gradient g = gradient(c, p);
    Real total = 0;
    for_each_wall(cut, c, [&](const CutWall& w, int) { total += norm(w.area); });
    if (total <= Real(0)) return;
    for_each_wall(cut, c, [&](const CutWall& w, int at) {
      const CutCell& cell = cut.cells[static_cast<std::size_t>(w.cell)];
      const Real pressure = p(cell.i, cell.j, cell.k), share = norm(w.area) / total;
      for (std::size_t e = 0; e < 3; ++e)
        cut.pressure_impulse[static_cast<std::size_t>(at)][int(e)] +=
            dt_density * double(pressure * w.area[e] + share * g.beyond[e]);
    });
  });
}

}  // namespace ejecta
