// Incompressible flow with grains smaller than a cell in it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/grain_exchange.hpp"
#include "flow/piso/incompressible.hpp"
#include "flow/piso/momentum.hpp"
#include "flow/stencil.hpp"
#include "grid/faces.hpp"

namespace ejecta {
void Incompressible::advance(double time, double dt, CutCells& cut, FluidFraction& f) {
  if (!fraction_step_) fraction_step_ = std::make_unique<FractionStep>(grid_, boundaries_, poisson_);
  const bool takes_room = f.acts && cut.empty();
  fraction_ = takes_room ? &f : nullptr;
  fraction_dt_ = dt;
  if (takes_room && !superficial_) make_superficial(f);
  superficial_ = takes_room;
  if (takes_room) {
    advance_through_grains(time, dt, cut, f);
  } else {
    for (Field& field : f.seen) field.fill(0);
    grains_ = f.acts ? &f : nullptr;
    advance(time, dt, cut);
    grains_ = nullptr;
    find_results(f);
  }
  book_grains(f, dt);
}

/// Grains are in a flow that did not know them.
void Incompressible::make_superficial(FluidFraction& f) {
  boundaries_.fill_zero_gradient(f.solids_before.view());
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) continue;
    const std::ptrdiff_t s = stride(p_.view(), d);
    for_each_cell(faces_along(grid_, d), [q = q_[static_cast<std::size_t>(d)].view(),
                                          solids = f.solids_before.view(), s](int i, int j, int k) {
      const Real* at = solids.row(j, k) + i;
      q(i, j, k) *= Real(1) - Real(0.5) * (at[-s] + at[0]);
    });
  }
  boundaries_.prescribe_face_velocity(views(q_));
}

/// As advance(), with e = 1 - solids of the grains:
///
///   stage 1:  e1 u1 = e0 u + dt (R(u) - e1 grad p1) + dt (S - D u1)            R = -div(q u) + div tau + ...
///   stage 2:  e1 u' = (e0 u + e1 u1 + dt (R(u1) - e1 grad p2) + dt (S - D u')) / 2
///
/// with div q = -(e1 - e0) / dt in both: drag as by backward Euler, the rest by Heun's method. The pressure
/// of the step is the mean of p1 and p2. Stresses act on the grains' part of a cell through the grains.
void Incompressible::advance_through_grains(double time, double dt, CutCells& cut, FluidFraction& f) {
  const Real h = static_cast<Real>(dt);
  convection_ = -1.0;
  move_displaced(cut_flow_.begin(cut, std::as_const(*this).views(u_), p_.view(), true, dt));
  cut_pressure_.begin(cut, boundaries_);
  smoothing_ = turbulence_ && dt > explicit_dt_;
  if (smoothing_) smoother_.prepare(0.5 * dt * largest_viscosity_, cut, cut_flow_.carried());
  for (Field* field : {&f.solids, &f.drag, &f.dragging[0], &f.dragging[1], &f.dragging[2]})
    boundaries_.fill_zero_gradient(field->view());

  book_through(predict_increment(time, dt), dt);
  gather_momentum(f, dt, true);
  {
    ScopedTimer timer(times_.boundaries);
    boundaries_.update(time + dt);
  }
  {
    ScopedTimer timer(times_.pressure);
    fraction_step_->project(f, true, dt, dt, views(u_star_), p_.view(), views(q_));
  }
  book_pressure(p_.view(), kStageWeight, dt);
  std::swap(u_, u_star_);
  std::swap(u_old_, u_star_);

  book_through(predict_increment(time + dt, 0.5 * dt), dt);
  gather_momentum(f, 0.5 * dt, false);
  {
    ScopedTimer timer(times_.pressure);
    fraction_step_->project(f, false, 0.5 * dt, dt, views(u_star_), p_.view(), views(q_));
  }
  book_pressure(p_.view(), kStageWeight, dt);
  std::swap(u_, u_star_);
  for_each_cell(grid_.range(), [p = p_.view(), change = f.pressure_change[1].view()](int i, int j, int k) {
    p(i, j, k) -= Real(0.5) * change(i, j, k);
  });
  boundaries_.fill_pressure(p_.view(), views(q_), true);

  if (turbulence_) {
    ScopedTimer timer(times_.turbulence);
    boundaries_.fill_velocity(views(u_), views(q_));
    turbulence_->advance(boundaries_, std::as_const(*this).views(u_), views(q_), cut, h,
                         smoothing_ ? &smoother_ : nullptr);
  }
}

/// u_star = h R(u): convection and viscous stress of the whole cell.
BoundaryFlow Incompressible::predict_increment(double time, double h) {
  {
    ScopedTimer timer(times_.boundaries);
    boundaries_.fill_velocity(views(u_), views(q_));
    if (setup_.source) evaluate_source(time);
  }
  ScopedTimer timer(times_.momentum);
  MomentumTerms t = momentum_terms();
  t.old = t.u;
  t.a = 0;
  t.b = 1;
  t.dt = static_cast<Real>(h);
  t.increment_only = true;
  const BoundaryFlow through = predict_momentum(grid_, t, boundary_sums_);
  for (std::size_t c = 0; smoothing_ && c < 3; ++c)
    smoother_.apply(u_star_[c].view(), {t.u[c], Real(0), t.u[c], Real(0)});
  return through;
}

/// Of the increment of a stage of h (s) makes the fluid's momentum before pressure and drag. Friction on the
/// grains' part of a cell acts on them.
void Incompressible::gather_momentum(FluidFraction& f, double h, bool first) {
  ScopedTimer timer(times_.momentum);
  const Real stage = static_cast<Real>(h), kept = first ? Real(0) : Real(1);
  const Real old = first ? Real(1) : Real(0.5), here = first ? Real(0) : Real(0.5);
  const std::array<ConstFieldView, 3> from = std::as_const(*this).views(first ? u_ : u_old_);
  const auto gather = [&](int j, int k, std::size_t c, const auto& friction) {
    for_each_lane(
        0, grid_.nx(), [
          =, m = u_star_[c].view().row(j, k), push = f.push[c].view().row(j, k), u = u_[c].view().row(j, k),
          before = f.solids_before.view().row(j, k), now = f.solids.view().row(j, k),
          from = from[c].row(j, k), acceleration = static_cast<Real>(setup_.acceleration[int(c)])
        ](int i) __attribute__((always_inline)) {
          const Real s = now[i], stress = friction(i);
          m[i] += old * (Real(1) - before[i]) * from[i] + here * (Real(1) - s) * u[i] +
                  stage * ((Real(1) - s) * acceleration - s * stress);
          push[i] = kept * push[i] + Real(kStageWeight) * stress;
        });
  };
  for_each_friction_row(grid_, std::as_const(*this).views(u_),
                        turbulence_ ? turbulence_->eddy_viscosity() : ConstFieldView{}, setup_.viscosity,
                        gather);
}

/// Drag over a stage of h, implicit in the velocity of the cells: for grains that are too few for the
/// pressure to notice.
void Incompressible::drag_cells(double h) {
  const Real step = static_cast<Real>(h);
  for (std::size_t c = 0; c < 3; ++c)
    for_each_cell(grid_.range(),
                  [=, u = u_star_[c].view(), seen = grains_->seen[c].view(), drag = grains_->drag.view(),
                   dragging = grains_->dragging[c].view()](int i, int j, int k) {
                    const Real v = (u(i, j, k) + step * dragging(i, j, k)) / (Real(1) + step * drag(i, j, k));
                    u(i, j, k) = v;
                    seen(i, j, k) += Real(0.5) * v;
                  });
}

/// What grains see of a flow that they have not displaced.
void Incompressible::find_results(FluidFraction& f) {
  boundaries_.fill_pressure(p_.view(), views(q_), true);
  boundaries_.fill_velocity(views(u_), views(q_));
  find_undisplaced(grid_, p_.view(), std::as_const(*this).views(u_),
                   turbulence_ ? turbulence_->eddy_viscosity() : ConstFieldView{}, setup_.viscosity, 1.0, f);
}

/// Momentum and mass of the step. What drags the fluid is counted from its fields, not from the grains.
void Incompressible::book_grains(const FluidFraction& f, double dt) {
  ScopedTimer timer(times_.ledger);
  impulse_on_grains_.setZero();
  if (!f.acts) return;
  const bool room = fraction_ != nullptr;
  const TakenByGrains taken =
      taken_by_grains(grid_, f, setup_.acceleration, room ? ConstFieldView{} : cut_flow_.carried());
  impulse_on_grains_ = dt * setup_.density * taken.force;
  ledger_.impulse_on_solids += impulse_on_grains_;
  if (!room) return;
  // What came in must be what the grains made room for.
  double net = 0.0, in = 0.0;
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    if (!grid_.active(d)) continue;
    for_each_face_cell(grid_, face, [&, sign = face % 2 ? -1.0 : 1.0](std::size_t, const int(&at)[3]) {
      const double area = double(face_area_of(grid_.metrics(), d, {at[0], at[1], at[2]}));
      const double flow = sign * area * double(q_[static_cast<std::size_t>(d)](at[0], at[1], at[2]));
      net += flow;
      in += std::max(flow, 0.0);
    });
  }
  ledger_.mass_through_boundaries += setup_.density * (dt * net + taken.volume);
  ledger_.mass_in += setup_.density * (dt * in + std::abs(taken.volume));
}

/// Momentum that crossed the boundaries in half a step.
void Incompressible::book_through(const BoundaryFlow& through, double dt) {
  ledger_.momentum_through_boundaries +=
      kStageWeight * dt * setup_.density * (through.momentum + setup_.acceleration * box_volume_);
}

}  // namespace ejecta
