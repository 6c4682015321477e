#include "flow/piso/cut_gas.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/cut_ghosts.hpp"
#include "flow/turbulence/wall_cell.hpp"

namespace ejecta::gas {

using namespace gas;

namespace {

Vec3 velocity_of(const CutWall& wall) { return {wall.velocity[0], wall.velocity[1], wall.velocity[2]}; }

/// Kinetic energy per volume, J/m3.
Real kinetic(const Block& w, int i, int j, int k) {
  const Real u = w[kU](i, j, k), v = w[kV](i, j, k), z = w[kW](i, j, k);
  return Real(0.5) * w[kRho](i, j, k) * (u * u + v * v + z * z);
}

/// visit(n, cell) for every cell that keeps its gas.
template <class Visit>
void for_each_carrier(const CutCells& cut, const Visit& visit) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier == n) visit(static_cast<std::size_t>(n), c);
  });
}

}  // namespace

CutGas::CutGas(const Grid& grid, const GasConstants& gas, double viscosity)
    : grid_(grid), gas_(gas), viscosity_(static_cast<Real>(viscosity)), flow_(grid, viscosity) {}

/// Carriers of cells that had gas of their own before.
void CutGas::merge(const CutCells& cut, Block& u, Block& w) {
  const ConstFieldView before = flow_.carried();
  for_each_carrier(cut, [&](std::size_t, const CutCell& c) {
    std::array<double, kComponents> sum{};
    double volume = 0.0;
    int parts = 0;
    for (int m = c.first_member; m < c.first_member + c.members; ++m) {
      const CutCell& member = cut.cells[static_cast<std::size_t>(cut.members[static_cast<std::size_t>(m)])];
      const double part =
          double(before(member.i, member.j, member.k)) * grid_.volume(member.i, member.j, member.k);
      if (part <= 0.0) continue;
      ++parts;
      volume += part;
      for (std::size_t e = 0; e < kComponents; ++e)
        sum[e] += part * double(u[e](member.i, member.j, member.k));
    }
    if (parts < 2) return;
    // Velocities stand at the centres of cells: that of the carrier stays.
    for (std::size_t e = 0; e < kComponents; ++e) u[e](c.i, c.j, c.k) = static_cast<Real>(sum[e] / volume);
    const Real rho = u[kRho](c.i, c.j, c.k);
    for (const std::size_t e : {kU, kV, kW}) u[e](c.i, c.j, c.k) = rho * w[e](c.i, c.j, c.k);
    for (std::size_t e = 0; e < kComponents; ++e)
      w[e](c.i, c.j, c.k) = e == kRho ? rho : u[e](c.i, c.j, c.k) / rho;
    w[kP](c.i, c.j, c.k) = (gas_.gamma - 1) * (u[kP](c.i, c.j, c.k) - kinetic(w, c.i, c.j, c.k));
  });
}

void CutGas::begin(const CutCells& cut, Block& u, Block& w, double dt) {
  merge(cut, u, w);
  flow_.begin(cut, {w[kU].view(), w[kV].view(), w[kW].view()}, w[kP].view(), false, dt);
  kept_.resize(cut.cells.size());
  shifted_.assign(cut.cells.size(), {});
  swept_.assign(cut.cells.size(), 0.0);
  const auto add = [&](int i, int j, int k, double flow) {
    if (i < 0 || j < 0 || k < 0 || i >= grid_.nx() || j >= grid_.ny() || k >= grid_.nz()) return;
    const int index = cut.index(i, j, k);
    if (index <= 0) return;
    const int carrier = cut.cells[static_cast<std::size_t>(index - 1)].carrier;
    if (carrier >= 0) swept_[static_cast<std::size_t>(carrier)] += flow;
  };
  const GridMetrics& metrics = grid_.metrics();
  for (const CutFace& f : cut.faces) {
    const double flow =
        double(f.closed) * double(face_area_of(metrics, f.d, {f.i, f.j, f.k})) * double(f.velocity);
    add(f.i, f.j, f.k, -flow);
    add(f.i - (f.d == 0), f.j - (f.d == 1), f.k - (f.d == 2), flow);
  }
}

WallTurbulence CutGas::turbulence_of(const Block& w, const Field* eddy_viscosity) const {
  WallTurbulence t;
  t.density = w[kRho].view();
  if (eddy_viscosity) {
    t.k = w[kK].view();
    t.eddy_viscosity = eddy_viscosity->view();
  }
  return t;
}

void CutGas::extend(const CutCells& cut, Block& w, const Field* eddy_viscosity) {
  extend_to_ghosts(cut, w[kRho].view(), scratch_);
  if (eddy_viscosity)
    for (const int c : {kK, kE}) extend_to_ghosts(cut, w[static_cast<std::size_t>(c)].view(), scratch_);
  flow_.extend(cut, {w[kU].view(), w[kV].view(), w[kW].view()}, turbulence_of(w, eddy_viscosity));
}

void CutGas::advance_turbulence(const CutCells& cut, bool sst, const Block& before, Block& w, Block& u,
                                Field& eddy_viscosity, Field& f1, Real dt) {
  const std::array<ConstFieldView, 3> velocity{w[kU].view(), w[kV].view(), w[kW].view()};
  const auto advance = [&](auto model) {
    for_each_carrier(cut, [&](std::size_t, const CutCell& c) {
      const Real rho = w[kRho](c.i, c.j, c.k), nu = viscosity_ / rho;
      const Real k = std::max(before[kK](c.i, c.j, c.k), kMinimalK),
                 e = std::max(before[kE](c.i, c.j, c.k), kMinimalDissipation);
      const Real nut = wall_eddy_viscosity<model>(k, e, nu);
      const SourcePoint p{k, e, k, e, 0, 0, nut, 0, Real(1), 0};
      const SourceResult r = advance_wall_sources<model>(grid_, cut, c, velocity, p, nu, dt);
      set_turbulence(w, u, c.i, c.j, c.k, r.k, r.dissipation);
      eddy_viscosity(c.i, c.j, c.k) = rho * wall_eddy_viscosity<model>(r.k, r.dissipation, nu);
      if (model) f1(c.i, c.j, c.k) = 1;
    });
  };
  sst ? advance(std::true_type{}) : advance(std::false_type{});
  for (Field* f : {&w[kK], &w[kE], &eddy_viscosity, &f1}) extend_to_ghosts(cut, f->view(), scratch_);
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    if (g.donors > 0) return;  // deep inside nothing happens
    eddy_viscosity(g.i, g.j, g.k) = 0;
    set_turbulence(w, u, g.i, g.j, g.k, before[kK](g.i, g.j, g.k), before[kE](g.i, g.j, g.k));
  });
}

void CutGas::keep(const CutCells& cut, const Block& middle) {
  for_each_carrier(cut, [&](std::size_t n, const CutCell& c) {
    const auto value = [&](std::size_t component) { return middle[component](c.i, c.j, c.k); };
    kept_[n] = {value(kRho), {value(kU), value(kV), value(kW)}};
  });
}

void CutGas::push(const CutCells& cut, Block& middle, Real half_dt) const {
  const ConstFieldView p = middle[kP].view();
  for_each_carrier(cut, [&](std::size_t n, const CutCell& c) {
    const std::array<Real, 3> gradient = flow_.gradient(c, p).value;
    for (std::size_t d = 0; d < 3; ++d)
      middle[kU + d](c.i, c.j, c.k) = kept_[n].u[d] - half_dt / kept_[n].rho * gradient[d];
  });
}

void CutGas::balance(CutCells& cut, const std::array<Block, 3>& flux, const Block& start, const Block& middle,
                     const Field* eddy_viscosity, Block& u, Block& w, Real dt) {
  flow_.press(cut, middle[kP].view(), double(dt));
  const WallTurbulence turbulence = turbulence_of(w, eddy_viscosity);
  for_each_carrier(cut, [&](std::size_t n, const CutCell& c) {
    std::array<double, kComponents> out{};
    for_each_open_face(grid_, cut, c,
                       [&](const CutCell&, int d, const std::array<int, 3>& f, const std::array<int, 3>&,
                           Real sign, Real open, Real area) {
                         const Block& through = flux[static_cast<std::size_t>(d)];
                         for (std::size_t e = 0; e < kComponents; ++e)
                           out[e] += double(sign * open * area * through[e](f[0], f[1], f[2]));
                       });
    for (std::size_t e = 0; e < kComponents; ++e)
      out[e] = double(dt) * (out[e] + swept_[n] * double(start[e](c.i, c.j, c.k)));
    out[kP] += double(dt) * double(gas_.reference_enthalpy) * swept_[n];
    for_each_wall(cut, c, [&](const CutWall& wall, int at) {
      const Vec3& push = cut.pressure_impulse[static_cast<std::size_t>(at)];
      for (std::size_t d = 0; d < 3; ++d) out[kU + d] += push[int(d)];
      out[kP] += push.dot(velocity_of(wall));
    });
    const double volume = double(c.carried) * grid_.volume(c.i, c.j, c.k);
    std::array<Real, kComponents> now;
    for (std::size_t e = 0; e < kComponents; ++e)
      now[e] = static_cast<Real>(double(start[e](c.i, c.j, c.k)) - out[e] / volume);
    const Real rho = now[kRho];
    w[kRho](c.i, c.j, c.k) = rho;
    w[kK](c.i, c.j, c.k) = now[kK] / rho;
    std::array<Real, 3> v{now[kU] / rho, now[kV] / rho, now[kW] / rho};
    flow_.rub(cut, c, turbulence, dt, double(rho), v);
    const std::array<Real, 3> moves = flow_.middle_moves(cut, c);
    shifted_[n] = {};
    if (moves != std::array<Real, 3>{}) {
      const Real before = dot(v, v);
      for (std::size_t d = 0; d < 3; ++d) {
        const Real change = -dt * dot(moves, flow_.mean_gradient(c, middle[kU + d].view()));
        v[d] += change;
        shifted_[n].momentum[int(d)] = double(rho) * volume * double(change);
      }
      const Real change = Real(0.5) * rho * (dot(v, v) - before);
      now[kP] += change;
      shifted_[n].energy = volume * double(change);
    }
    for (std::size_t d = 0; d < 3; ++d) now[kU + d] = rho * v[d];
    for_each_wall(cut, c, [&](const CutWall& wall, int at) {
      now[kP] -= static_cast<Real>(cut.friction_impulse[static_cast<std::size_t>(at)].dot(velocity_of(wall)) /
                                   volume);
    });
    for (std::size_t e = 0; e < kComponents; ++e) u[e](c.i, c.j, c.k) = now[e];
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < kComponents; ++e) u[e](g.i, g.j, g.k) = start[e](g.i, g.j, g.k);
  });
}

void CutGas::settle(const CutCells& cut, const Field* eddy_viscosity, Block& u, Block& w) {
  extend(cut, w, eddy_viscosity);
  for_each_small(cut, [&w](const CutCell& c, const CutCell& carrier) {
    for (Field& f : w) f(c.i, c.j, c.k) = f(carrier.i, carrier.j, carrier.k);
  });
  extend_pressure(cut, w[kP]);
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    const Real rho = w[kRho](g.i, g.j, g.k);
    for (std::size_t e = 0; e < kComponents; ++e)
      u[e](g.i, g.j, g.k) = e == kRho ? rho : rho * w[e](g.i, g.j, g.k);
    u[kP](g.i, g.j, g.k) = w[kP](g.i, g.j, g.k) * gas_.inv_gamma_minus_1 + kinetic(w, g.i, g.j, g.k);
  });
}

CutGas::Given CutGas::given(const CutCells& cut, const Block& start, double dt) const {
  Given sum;
  for (std::size_t n = 0; n < cut.walls.size(); ++n) {
    const Vec3 push = cut.pressure_impulse[n] + cut.friction_impulse[n];
    sum.by_walls.momentum -= push;
    sum.by_walls.energy -= push.dot(velocity_of(cut.walls[n]));
  }
  for (std::size_t n = 0; n < cut.cells.size(); ++n) {
    const CutCell& c = cut.cells[n];
    const double volume = dt * swept_[n];
    const auto at = [&](std::size_t component) { return volume * double(start[component](c.i, c.j, c.k)); };
    sum.by_walls.energy -= double(gas_.reference_enthalpy) * volume;
    sum.displaced.mass -= at(kRho);
    sum.displaced.momentum -= Vec3(at(kU), at(kV), at(kW));
    sum.displaced.energy -= at(kP);
    sum.displaced.momentum += shifted_[n].momentum;
    sum.displaced.energy += shifted_[n].energy;
  }
  return sum;
}

}  // namespace ejecta::gas
