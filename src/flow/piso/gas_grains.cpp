#include "flow/piso/gas_grains.hpp"

#include "base/parallel.hpp"
#include "flow/stencil.hpp"
#include "grid/faces.hpp"

namespace ejecta::gas {
namespace {

/// kernel(std::integral_constant<int, axis>) for every axis that has cells.
template <class Kernel>
void for_each_axis(const Grid& grid, const Kernel& kernel) {
  if (grid.active(0)) kernel(std::integral_constant<int, 0>{});
  if (grid.active(1)) kernel(std::integral_constant<int, 1>{});
  if (grid.active(2)) kernel(std::integral_constant<int, 2>{});
}

/// Mean on a lower face along D of the cells on its sides.
template <int D>
struct FaceMean {
  Metrics metrics;
  std::ptrdiff_t s;
  EJECTA_KERNEL Real operator()(const Real* at, int i, int j, int k) const {
    return at[-s] + (1 - metrics.weight[D == 0 ? i : D == 1 ? j : k]) * (at[0] - at[-s]);
  }
};

/// What pressure and stress on its faces give to a component of a whole cell, per volume and second.
struct SurfaceGain {
  std::array<BlockView<const Real>, 3> through;
  std::array<Metrics, 3> metrics;
  EJECTA_KERNEL Real operator()(int c, int i, int j, int k) const {
    const std::ptrdiff_t o = through[0].offset(i, j, k);
    return metrics[0].inv_width[i] * (through[0].at(c, o) - through[0].at(c, o + 1)) +
           metrics[1].inv_width[j] * (through[1].at(c, o) - through[1].at(c, o + through[0].sy)) +
           metrics[2].inv_width[k] * (through[2].at(c, o) - through[2].at(c, o + through[0].sz));
  }
};

SurfaceGain surface_gain(const Grid& grid, const std::array<Block, 3>& surface) {
  return {{view_block<const Real>(surface[0]), view_block<const Real>(surface[1]),
           view_block<const Real>(surface[2])},
          {grid.metrics(0), grid.metrics(1), grid.metrics(2)}};
}

/// Momentum over volume after drag over dt: m + dt (S - D u), implicit. rho: kg/m3 of the cell's volume.
EJECTA_KERNEL Real dragged(Real momentum, Real rho, Real drag, Real dragging, Real dt) {
  return (momentum + dt * dragging) / (1 + dt * drag / rho);
}

}  // namespace

GasGrains::GasGrains(const Grid& grid, const GasConstants& gas, double density)
    : grid_(grid), gas_(gas), density_(density) {
  for (Field* f : {&part_, &middle_part_, &growth_, &nothing_}) *f = grid.make_field();
  part_.fill(1);
  for (auto* fields : {&open_, &flow_})
    for (Field& f : *fields) f = grid.make_field();
  for (Block& b : surface_)
    for (Field& f : b) f = grid.make_field();
}

void GasGrains::begin(FluidFraction& f, const Boundaries& boundaries, double dt) {
  dt_ = dt;
  for (Field* field : {&f.drag, &f.dragging[0], &f.dragging[1], &f.dragging[2]}) boundaries.extend(*field);
  for_each_cell(grid_.range(), [part = part_.view(), middle = middle_part_.view(), growth = growth_.view(),
                                before = f.solids_before.view(), now = f.solids.view(),
                                inv_dt = Real(1 / dt)](int i, int j, int k) {
    part(i, j, k) = 1 - now(i, j, k);
    middle(i, j, k) = 1 - Real(0.5) * (before(i, j, k) + now(i, j, k));
    growth(i, j, k) = (before(i, j, k) - now(i, j, k)) * inv_dt;
  });
  boundaries.extend(middle_part_);
  for_each_axis(grid_, [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    const FieldView open = open_[d].view(), middle = middle_part_.view();
    const FaceMean<d> mean{grid_.metrics(d), stride(middle, d)};
    for_each_cell(faces_along(grid_, d),
                  [=](int i, int j, int k) { open(i, j, k) = mean(middle.row(j, k) + i, i, j, k); });
  });
  acts_ = &f;
}

void GasGrains::fill_inlets(const Boundaries& boundaries, Block& w) const {
  const auto v = view_block<Real>(w);
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    if (!grid_.active(d) || boundaries.is_periodic(d)) continue;
    const Metrics& m = grid_.metrics(d);
    const std::ptrdiff_t s = stride(w[kP].view(), d), inward = face % 2 ? -s : s;
    for_each_face_cell(grid_, face, [&](std::size_t cell, const int(&at)[3]) {
      const BoundaryType type = boundaries.at(face, cell).type;
      if (type != BoundaryType::velocity && type != BoundaryType::jet) return;
      int c[3] = {at[0], at[1], at[2]};
      c[d] -= face % 2;
      const std::size_t n = static_cast<std::size_t>(d);
      const std::ptrdiff_t o = v.offset(c[0], c[1], c[2]);
      const Real part = middle_part_(c[0], c[1], c[2]), h = m.width[c[d]];
      Real* u = v.origin[kU + n] + o;
      u[-inward] /= part;
      u[-2 * inward] /= part;
      const Real slope = Real(density_) / part *
                         (acts_->dragging[n](c[0], c[1], c[2]) - acts_->drag(c[0], c[1], c[2]) * u[-inward]);
      const Real outward = face % 2 ? h : -h;
      v.at(kP, o - inward) += outward * slope;
      v.at(kP, o - 2 * inward) += 2 * outward * slope;
    });
  }
}

void GasGrains::drag_faces(const Block& middle, std::array<Field, 3>& velocity,
                           std::array<Field, 3>& conductance) const {
  const Real half = Real(0.5 * dt_ * density_);
  for_each_axis(grid_, [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    const FieldView q = velocity[d].view(), c = conductance[d].view();
    const ConstFieldView drag = acts_->drag.view(), dragging = acts_->dragging[d].view(),
                         rho = middle[kRho].view(), part = middle_part_.view();
    const FaceMean<d> mean{grid_.metrics(d), stride(q, d)};
    for_each_cell(
        faces_along(grid_, d), [=](int i, int j, int k) __attribute__((always_inline)) {
          const auto at = [&](ConstFieldView v) { return mean(v.row(j, k) + i, i, j, k); };
          const Real per_mass = half / (at(rho) * at(part));
          const Real slower = 1 / (1 + per_mass * at(drag));
          q(i, j, k) = slower * (q(i, j, k) + per_mass * at(dragging));
          c(i, j, k) *= slower;
        });
  });
}

template <class Change>
void GasGrains::change_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance,
                             const Change& change) const {
  for_each_axis(grid_, [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    for_each_cell(faces_along(grid_, d), [=, q = velocity[d].view(), c = conductance[d].view(),
                                          open = open_[d].view()](int i, int j, int k) {
      q(i, j, k) = change(q(i, j, k), open(i, j, k));
      c(i, j, k) = change(c(i, j, k), open(i, j, k));
    });
  });
}

void GasGrains::narrow_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance) const {
  change_faces(velocity, conductance, [](Real value, Real open) { return value * open; });
}

void GasGrains::widen_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance) const {
  change_faces(velocity, conductance, [](Real value, Real open) { return value / open; });
}

void GasGrains::leave_to_gas(const Block& middle, Field& residual, Field& diagonal) const {
  const Metrics x = grid_.metrics(0), y = grid_.metrics(1), z = grid_.metrics(2);
  for_each_cell(grid_.range(), [=, rhs = residual.view(), diagonal = diagonal.view(), p = middle[kP].view(),
                                part = middle_part_.view(), growth = growth_.view(), gas = gas_,
                                dt = Real(dt_)](int i, int j, int k) {
    const Real volume = x.volume[i] * y.volume[j] * z.volume[k];
    rhs(i, j, k) -= volume * growth(i, j, k);
    diagonal(i, j, k) -= (1 - part(i, j, k)) * volume / (dt * gas.stiffness(p(i, j, k)));
  });
}

void GasGrains::drag_middle(Block& middle) const {
  const Real half = Real(0.5 * dt_ * density_);
  for (std::size_t c = 0; c < 3; ++c)
    for_each_cell(grid_.range(),
                  [=, u = middle[kU + c].view(), rho = middle[kRho].view(), part = middle_part_.view(),
                   drag = acts_->drag.view(), dragging = acts_->dragging[c].view()](int i, int j, int k) {
                    const Real per_mass = half / (rho(i, j, k) * part(i, j, k));
                    u(i, j, k) = dragged(u(i, j, k), Real(1), drag(i, j, k), dragging(i, j, k), per_mass);
                  });
}

const std::array<Field, 3>& GasGrains::carry(const std::array<const Field*, 3>& velocity) {
  for_each_axis(grid_, [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    for_each_cell(faces_along(grid_, d),
                  [to = flow_[d].view(), q = velocity[d]->view(), open = open_[d].view()](
                      int i, int j, int k) { to(i, j, k) = open(i, j, k) * q(i, j, k); });
  });
  return flow_;
}

void GasGrains::balance(FluidFraction& f, const Block& middle, Block& start, Block& u) {
  const SurfaceGain gain = surface_gain(grid_, surface_);
  const Real dt = Real(dt_), inv_density = Real(1 / density_);
  for (const int c : {kRho, kU, kV, kW, kP, kK, kE}) {
    const std::size_t n = static_cast<std::size_t>(c);
    const bool moves = c == kU || c == kV || c == kW;
    for_each_cell(grid_.range(), [=, before = f.solids_before.view(), now = f.solids.view(),
                                  growth = growth_.view(), p = middle[kP].view(), work = f.work.view(),
                                  push = f.push[moves ? n - kU : 0].view(), from = start[n].view(),
                                  to = u[n].view(), enthalpy = gas_.reference_enthalpy](int i, int j, int k) {
      const Real by_surface = gain(c, i, j, k);
      const Real contents = (1 - before(i, j, k)) * from(i, j, k);
      Real change = to(i, j, k) - from(i, j, k) - dt * now(i, j, k) * by_surface;
      if (moves) push(i, j, k) = inv_density * by_surface;
      if (c == kP) change -= dt * (p(i, j, k) + enthalpy) * growth(i, j, k) + work(i, j, k);
      from(i, j, k) = contents;
      to(i, j, k) = contents + change;
    });
  }
}

void GasGrains::settle(FluidFraction& f, Block& u) {
  for (const int c : {kRho, kP, kK, kE})
    for_each_cell(grid_.range(), [v = u[static_cast<std::size_t>(c)].view(), now = f.solids.view()](
                                     int i, int j, int k) { v(i, j, k) /= 1 - now(i, j, k); });
  const Real dt = Real(dt_ * density_);
  for (std::size_t c = 0; c < 3; ++c)
    for_each_cell(grid_.range(),
                  [=, m = u[kU + c].view(), rho = u[kRho].view(), now = f.solids.view(), drag = f.drag.view(),
                   dragging = f.dragging[c].view(), seen = f.seen[c].view()](int i, int j, int k) {
                    const Real part = 1 - now(i, j, k), gas = part * rho(i, j, k);
                    const Real contents = dragged(m(i, j, k), gas, drag(i, j, k), dragging(i, j, k), dt);
                    m(i, j, k) = contents / part;
                    seen(i, j, k) = contents / gas;
                  });
}

void GasGrains::drag_alone(FluidFraction& f, double dt, Block& u) const {
  const Real step = Real(dt * density_);
  for_each_cell(grid_.range(), [e = u[kP].view(), work = f.work.view()](int i, int j, int k) {
    e(i, j, k) -= work(i, j, k);
  });
  for (std::size_t c = 0; c < 3; ++c)
    for_each_cell(grid_.range(),
                  [=, m = u[kU + c].view(), rho = u[kRho].view(), drag = f.drag.view(),
                   dragging = f.dragging[c].view(), seen = f.seen[c].view()](int i, int j, int k) {
                    m(i, j, k) = dragged(m(i, j, k), rho(i, j, k), drag(i, j, k), dragging(i, j, k), step);
                    seen(i, j, k) = m(i, j, k) / rho(i, j, k);
                  });
}

double GasGrains::energy_taken(const FluidFraction& f, const Block& middle, bool room,
                               ConstFieldView part) const {
  if (!room)
    return reduce_sum(grid_.range(), [=, work = f.work.view(), &grid = grid_](int i, int j, int k) {
      return grid.volume(i, j, k) * double(part(i, j, k)) * double(work(i, j, k));
    });
  const SurfaceGain gain = surface_gain(grid_, surface_);
  return reduce_sum(grid_.range(), [=, now = f.solids.view(), growth = growth_.view(), p = middle[kP].view(),
                                    work = f.work.view(), dt = dt_, &grid = grid_,
                                    enthalpy = double(gas_.reference_enthalpy)](int i, int j, int k) {
    const double by_surface = double(now(i, j, k)) * double(gain(kP, i, j, k));
    const double displaced = (double(p(i, j, k)) + enthalpy) * double(growth(i, j, k));
    return grid.volume(i, j, k) * (dt * (by_surface + displaced) + double(work(i, j, k)));
  });
}

}  // namespace ejecta::gas
