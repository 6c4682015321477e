#include "flow/piso/cut_flow.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "flow/cut_geometry.hpp"
#include "flow/turbulence/wall_law.hpp"

/// CutFlow: the balance of carriers.
namespace ejecta {
namespace {

using Cell = std::array<int, 3>;
using Triple = std::array<Real, 3>;

}  // namespace

CutFlow::CutFlow(const Grid& grid, double viscosity, const std::array<bool, 6>& passable)
    : grid_(grid), nu_(static_cast<Real>(viscosity)), passable_(passable), carried_(grid.make_field()) {
  carried_.fill(Real(1));
}

Vec3 CutFlow::begin(const CutCells& cut, const std::array<ConstFieldView, 3>& u, ConstFieldView p,
                    bool moves_gaps, double dt) {
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
  list_differences(cut, p);
  step_ = static_cast<Real>(dt);
  held_.resize(cut.ghosts.size());
  for (std::size_t n = 0; n < cut.ghosts.size(); ++n)
    for (std::size_t e = 0; e < 3; ++e) held_[n][e] = u[e](cut.ghosts[n].i, cut.ghosts[n].j, cut.ghosts[n].k);
  if (moves_gaps) push_thin(cut, p, step_);
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
      const Real shifted = moves == Triple{} ? Real(0) : dot(moves, mean_gradient(c, t.u[e]));
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
