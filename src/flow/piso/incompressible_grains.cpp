// Incompressible flow with grains smaller than a cell in it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/piso/incompressible.hpp"
#include "flow/piso/momentum.hpp"
#include "flow/stencil.hpp"
#include "grid/faces.hpp"

namespace ejecta {
void Incompressible::advance(double time, double dt, CutCells& cut, FluidFraction& f) {
  if (!fraction_step_) fraction_step_ = std::make_unique<FractionStep>(grid_, boundaries_, poisson_);
  for (auto* group : {&f.seen, &f.push})
    for (Field& field : *group) field.fill(0);
  const bool takes_room = f.acts && cut.empty();
  fraction_ = takes_room ? &f : nullptr;
  fraction_dt_ = dt;
  if (takes_room && !superficial_) make_superficial(f);
  superficial_ = takes_room;
  if (takes_room) {
    advance_through_grains(time, dt, cut, f);
  } else {
    grains_ = f.acts ? &f : nullptr;
    advance(time, dt, cut);
    grains_ = nullptr;
    find_results(f);
    boundaries_.fill_velocity(views(u_), views(q_));
    add_friction(f, 1.0);
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
  move_displaced(cut_flow_.begin(cut, std::as_const(*this).views(u_), p_.view(), dt));
  cut_pressure_.begin(cut, boundaries_);
  smoothing_ = turbulence_ && dt > explicit_dt_;
  if (smoothing_) smoother_.prepare(0.5 * dt * largest_viscosity_, cut, cut_flow_.carried());
  for (Field* field : {&f.solids, &f.drag, &f.dragging[0], &f.dragging[1], &f.dragging[2]})
    boundaries_.fill_zero_gradient(field->view());

  const ConstFieldView now = f.solids.view(), before = f.solids_before.view();
  const auto gather = [&](Real stage, std::size_t c, ConstFieldView old, ConstFieldView u, Real a, Real b) {
    const Real acceleration = static_cast<Real>(setup_.acceleration[int(c)]);
    for_each_cell(
        grid_.range(), [=, m = u_star_[c].view(), friction = friction_[c].view()](int i, int j, int k) {
          const Real s = now(i, j, k);
          m(i, j, k) += a * (Real(1) - before(i, j, k)) * old(i, j, k) + b * (Real(1) - s) * u(i, j, k) +
                        stage * ((Real(1) - s) * acceleration - s * friction(i, j, k));
        });
  };
  {
    const BoundaryFlow through = predict_increment(time, dt);
    book_through(through, dt);
    add_friction(f, kStageWeight);
    ScopedTimer timer(times_.momentum);
    for (std::size_t c = 0; c < 3; ++c) gather(h, c, u_[c].view(), u_[c].view(), Real(1), Real(0));
  }
  {
    ScopedTimer timer(times_.boundaries);
    boundaries_.update(time + dt);
  }
  {
    ScopedTimer timer(times_.pressure);
    fraction_step_->project(f, dt, dt, views(u_star_), p_.view(), views(q_));
  }
  book_pressure(p_.view(), kStageWeight, dt);
  std::swap(u_, u_star_);
  std::swap(u_old_, u_star_);
  phi_ = p_;

  {
    const BoundaryFlow through = predict_increment(time + dt, 0.5 * dt);
    book_through(through, dt);
    add_friction(f, kStageWeight);
    ScopedTimer timer(times_.momentum);
    for (std::size_t c = 0; c < 3; ++c)
      gather(Real(0.5) * h, c, u_old_[c].view(), u_[c].view(), Real(0.5), Real(0.5));
  }
  {
    ScopedTimer timer(times_.pressure);
    fraction_step_->project(f, 0.5 * dt, dt, views(u_star_), p_.view(), views(q_));
  }
  book_pressure(p_.view(), kStageWeight, dt);
  std::swap(u_, u_star_);
  for_each_cell(grid_.range(), [p = p_.view(), first = phi_.view()](int i, int j, int k) {
    p(i, j, k) = Real(0.5) * (p(i, j, k) + first(i, j, k));
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
  if (no_pressure_.size() == 0) no_pressure_ = grid_.make_field();
  MomentumTerms t = momentum_terms();
  t.old = t.u;
  t.pressure = no_pressure_.view();
  t.a = 0;
  t.b = 1;
  t.dt = static_cast<Real>(h);
  t.increment_only = true;
  const BoundaryFlow through = predict_momentum(grid_, t, boundary_sums_);
  for (std::size_t c = 0; smoothing_ && c < 3; ++c)
    smoother_.apply(u_star_[c].view(), {t.u[c], Real(0), t.u[c], Real(0)});
  return through;
}

/// div tau / rho of the velocity as it is, as nu times the Laplacian: whatever it is, what the grains get the
/// fluid loses. `part` of it acts on the grains.
void Incompressible::add_friction(FluidFraction& f, double part) {
  if (friction_[0].size() == 0)
    for (Field& field : friction_) field = grid_.make_field();
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  const Real nu = static_cast<Real>(setup_.viscosity);
  const Real share = static_cast<Real>(part);
  const ConstFieldView eddy = turbulence_ ? turbulence_->eddy_viscosity() : ConstFieldView{};
  const bool active[3] = {grid_.active(0), grid_.active(1), grid_.active(2)};
  for (std::size_t c = 0; c < 3; ++c) {
    const ConstFieldView u = u_[c].view();
    for_each_cell(
        grid_.range(), [ =, push = f.push[c].view(), out = friction_[c].view() ](
                           int i, int j, int k) __attribute__((always_inline)) {
          const Real* at = u.row(j, k) + i;
          Real sum = 0;
          const auto add = [&](const Metrics& d, int n, std::ptrdiff_t s) __attribute__((always_inline)) {
            sum += ((at[s] - at[0]) * d.inv_distance[n + 1] - (at[0] - at[-s]) * d.inv_distance[n]) *
                   d.inv_width[n];
          };
          if (active[0]) add(m[0], i, 1);
          if (active[1]) add(m[1], j, u.sy);
          if (active[2]) add(m[2], k, u.sz);
          const Real stress = (eddy.origin ? nu + eddy(i, j, k) : nu) * sum;
          out(i, j, k) = stress;
          push(i, j, k) += share * stress;
        });
  }
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
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  boundaries_.fill_pressure(p_.view(), views(q_), true);
  for (int d = 0; d < 3; ++d) {
    const std::size_t c = static_cast<std::size_t>(d);
    if (!f.acts)
      for_each_cell(grid_.range(), [to = f.seen[c].view(), from = u_[c].view()](int i, int j, int k) {
        to(i, j, k) = from(i, j, k);
      });
    if (!grid_.active(d)) continue;
    const std::ptrdiff_t s = stride(p_.view(), d);
    for_each_cell(grid_.range(),
                  [=, to = f.push[c].view(), p = p_.view(), metrics = m[d]](int i, int j, int k) {
                    to(i, j, k) = -cell_gradient(p.row(j, k) + i, s, metrics, d == 0 ? i : d == 1 ? j : k);
                  });
  }
}

/// Momentum and mass of the step. What drags the fluid is counted from its fields, not from the grains.
void Incompressible::book_grains(const FluidFraction& f, double dt) {
  ScopedTimer timer(times_.ledger);
  impulse_on_grains_.setZero();
  if (!f.acts) return;
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  const ConstFieldView solids = f.solids.view(), drag = f.drag.view(), part = cut_flow_.carried();
  const bool room = fraction_ != nullptr;
  for (std::size_t c = 0; c < 3; ++c) {
    const double acceleration = setup_.acceleration[int(c)];
    impulse_on_grains_[int(c)] =
        dt * setup_.density *
        reduce_sum(grid_.range(), [=, seen = f.seen[c].view(), dragging = f.dragging[c].view(),
                                   push = f.push[c].view()](int i, int j, int k) {
          double rate = double(drag(i, j, k)) * double(seen(i, j, k)) - double(dragging(i, j, k));
          if (room) rate += double(solids(i, j, k)) * (double(push(i, j, k)) + acceleration);
          return rate * double(part(i, j, k)) * double(m[0].volume[i]) * double(m[1].volume[j]) *
                 double(m[2].volume[k]);
        });
  }
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
  const double taken = reduce_sum(grid_.range(), [=, before = f.solids_before.view()](int i, int j, int k) {
    return (double(solids(i, j, k)) - double(before(i, j, k))) * double(m[0].volume[i]) *
           double(m[1].volume[j]) * double(m[2].volume[k]);
  });
  ledger_.mass_through_boundaries += setup_.density * (dt * net + taken);
  ledger_.mass_in += setup_.density * (dt * in + std::abs(taken));
}

/// Momentum that crossed the boundaries in half a step.
void Incompressible::book_through(const BoundaryFlow& through, double dt) {
  ledger_.momentum_through_boundaries +=
      kStageWeight * dt * setup_.density * (through.momentum + setup_.acceleration * box_volume_);
}

}  // namespace ejecta
