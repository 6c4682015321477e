#include "flow/piso/incompressible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "flow/piso/momentum.hpp"
#include "flow/piso/projection.hpp"
#include "flow/piso/sealed.hpp"
#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// What may pass closed faces after a correction, of what would without it. Pressure is incremental: what is
/// left over is met again in the next correction.
constexpr double kClosedTolerance = 0.01;
/// Time of the pressure's filter (projection.hpp), parts of the step at Courant number 1: takes a quarter of
/// what alternates in each correction and is the same for all Courant numbers from this one on.
constexpr double kFilter = 0.25;

std::array<PoissonBoundary, 6> poisson_boundaries(const std::array<Boundary, 6>& faces) {
  std::array<PoissonBoundary, 6> b;
  for (std::size_t f = 0; f < 6; ++f)
    b[f] = faces[f].kind == BoundaryKind::open       ? PoissonBoundary::dirichlet
           : faces[f].kind == BoundaryKind::periodic ? PoissonBoundary::periodic
                                                     : PoissonBoundary::neumann;
  return b;
}

std::array<bool, 6> passable(const std::array<Boundary, 6>& faces) {
  std::array<bool, 6> p;
  for (std::size_t f = 0; f < 6; ++f)
    p[f] = faces[f].kind == BoundaryKind::open || faces[f].kind == BoundaryKind::inflow;
  return p;
}

void check_periodic(const Grid& grid, const std::array<Boundary, 6>& faces) {
  for (int d = 0; d < 3; ++d) {
    const bool low = faces[2 * d].kind == BoundaryKind::periodic,
               high = faces[2 * d + 1].kind == BoundaryKind::periodic;
    if (low != high)
      throw InputError(fmt::format("boundary {0}_min and {0}_max must both be periodic", "xyz"[d]));
    const Axis& a = grid.axis(d);
    if (low && std::abs(a.width.front() - a.width.back()) > 1e-9 * a.width.front())
      throw InputError(
          fmt::format("a periodic direction needs equal first and last cells, in {} they are {} and {} m",
                      "xyz"[d], a.width.front(), a.width.back()));
  }
}

}  // namespace

Incompressible::Incompressible(const Grid& grid, std::array<Boundary, 6> boundaries,
                               const IncompressibleSetup& setup)
    : grid_(grid),
      setup_(setup),
      boundaries_(grid, boundaries),
      poisson_(grid, poisson_boundaries(boundaries)),
      cut_flow_(grid, setup.viscosity, passable(boundaries)),
      cut_pressure_(grid, poisson_, poisson_boundaries(boundaries)),
      p_(grid.make_field()),
      phi_(grid.make_field()),
      smoother_(grid) {
  check_periodic(grid, boundaries);
  for (auto* group : {&u_, &u_old_, &u_star_, &q_})
    for (Field& f : *group) f = grid.make_field();
  if (setup.source)
    for (Field& f : source_) f = grid.make_field();
  if (setup.turbulence)
    turbulence_ =
        std::make_unique<TwoEquation>(grid, *setup.turbulence, setup.round_jet_correction, setup.viscosity);
  boundary_sums_.reserve(static_cast<std::size_t>(2 * grid.ny() + grid.nz()));
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  box_volume_ = reduce_sum(grid.range(), [=](int i, int j, int k) {
    return double(m[0].volume[i]) * double(m[1].volume[j]) * double(m[2].volume[k]);
  });
}

std::array<FieldView, 3> Incompressible::views(std::array<Field, 3>& f) {
  return {f[0].view(), f[1].view(), f[2].view()};
}

std::array<ConstFieldView, 3> Incompressible::views(const std::array<Field, 3>& f) const {
  return {f[0].view(), f[1].view(), f[2].view()};
}

void Incompressible::initialise(const std::function<Vec3(const Vec3&)>& velocity,
                                const std::function<double(const Vec3&)>& pressure, double time) {
  for (int k = 0; k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i) {
        const Vec3 x = grid_.centre(i, j, k), v = velocity(x);
        for (int c = 0; c < 3; ++c) u_[c](i, j, k) = static_cast<Real>(v[c]);
        p_(i, j, k) = static_cast<Real>(pressure(x));
      }
  boundaries_.update(time);
  // One projection with an arbitrary step: only velocities change, the pressure is the one given.
  const Real dt = 1;
  const CutCells none;
  cut_pressure_.begin(none, boundaries_);
  Field given = p_;
  p_.fill(0);
  for (int c = 0; c < 3; ++c) u_star_[c] = u_[c];
  boundaries_.fill_velocity(views(u_star_), views(q_));
  correct(none, dt);
  p_ = given;
  boundaries_.fill_pressure(p_.view(), views(q_), true);
  times_ = {};
  boundaries_.fill_velocity(views(u_), views(q_));
  if (turbulence_) turbulence_->advance(boundaries_, this->velocity(), views(q_), none, Real(0));
}

void Incompressible::evaluate_source(double time) {
  for_each_index(grid_.nz(), [&](int k) {
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i) {
        const Vec3 s = setup_.source(grid_.centre(i, j, k), time);
        for (int c = 0; c < 3; ++c) source_[c](i, j, k) = static_cast<Real>(s[c]);
      }
  });
}

/// What every predictor reads and writes: the flow as it is, friction and sources.
MomentumTerms Incompressible::momentum_terms() {
  MomentumTerms t;
  t.u = std::as_const(*this).views(u_);
  t.face_velocity = std::as_const(*this).views(q_);
  if (turbulence_) t.eddy_viscosity = turbulence_->eddy_viscosity();
  if (setup_.source) t.source = std::as_const(*this).views(source_);
  t.out = views(u_star_);
  t.viscosity = static_cast<Real>(setup_.viscosity);
  return t;
}

/// `weight`: what the friction of this stage counts in the step.
BoundaryFlow Incompressible::predict(double a, double b, double time, Real dt, CutCells& cut, double weight) {
  {
    ScopedTimer timer(times_.boundaries);
    boundaries_.fill_velocity(views(u_), views(q_));
    boundaries_.fill_pressure(p_.view(), views(q_), true);
    if (setup_.source) evaluate_source(time);
  }
  ScopedTimer timer(times_.momentum);
  MomentumTerms t = momentum_terms();
  t.old = std::as_const(*this).views(u_old_);
  t.pressure = p_.view();
  for (int c = 0; c < 3; ++c) t.acceleration[c] = static_cast<Real>(setup_.acceleration[c]);
  t.a = static_cast<Real>(a);
  t.b = static_cast<Real>(b);
  t.dt = dt;
  t.increment_only = smoothing_;
  BoundaryFlow through = predict_momentum(grid_, t, boundary_sums_);
  through -= cut_flow_.through_closed(t);
  move_displaced(kStageWeight * double(dt) *
                 cut_flow_.predict(cut, t, wall_turbulence(), weight * setup_.density));
  for (int c = 0; smoothing_ && c < 3; ++c) smoother_.apply(u_star_[c].view(), {t.old[c], t.a, t.u[c], t.b});
  if (grains_) drag_cells(b * double(dt));
  return through;
}

WallTurbulence Incompressible::wall_turbulence() const {
  return turbulence_ ? WallTurbulence{turbulence_->k().view(), turbulence_->eddy_viscosity(), {}}
                     : WallTurbulence{};
}

void Incompressible::correct(const CutCells& cut, Real dt) {
  {
    ScopedTimer timer(times_.faces);
    const Real filter_time = std::min(dt, filter_time_);
    bool periodic = false;
    for (int f = 0; f < 6; ++f)
      periodic = periodic || (grid_.active(f / 2) && boundaries_.kind(f) == BoundaryKind::periodic);
    if (periodic) boundaries_.fill_velocity(views(u_star_), views(q_));
    face_velocities(grid_, std::as_const(*this).views(u_star_), p_.view(), filter_time, views(q_));
    cut_flow_.face_velocities(cut, std::as_const(*this).views(u_star_), p_.view(), filter_time, views(q_));
    boundaries_.fill_face_velocity(views(q_), views(u_star_), p_.view(), dt);
    const auto open = [this](int side, const std::array<int, 3>& face) {
      return boundaries_.kind(side) == BoundaryKind::open && !boundaries_.prescribed_on(side / 2, face);
    };
    cut_flow_.end_velocities(cut, open, std::as_const(*this).views(u_star_), p_.view(), dt, views(q_));
    cut_flow_.close(cut, views(q_));
    divergence(grid_, std::as_const(*this).views(q_), dt, phi_.view());
    CutFlow::fold(cut, phi_.view());
    cut_flow_.reopen(cut, views(q_));
  }
  {
    ScopedTimer timer(times_.pressure);
    if (!cut_pressure_.solve(cut, phi_.view(), kClosedTolerance)) refuse_sealed(cut);
  }
  ScopedTimer timer(times_.correction);
  cut_flow_.extend_to_small(cut, phi_.view());
  boundaries_.fill_pressure(phi_.view(), views(q_), false);
  cut_flow_.keep(cut, std::as_const(*this).views(u_star_));
  apply_correction(grid_, phi_.view(), dt, views(q_), views(u_star_), p_.view());
  cut_pressure_.balance(cut, phi_.view(), dt, views(q_));
  cut_flow_.correct(cut, phi_.view(), dt, views(q_), views(u_star_));
  boundaries_.prescribe_face_velocity(views(q_));
  cut_flow_.extend(cut, views(u_star_), wall_turbulence());
  cut_flow_.move_small(cut, std::as_const(*this).views(q_), views(u_star_));
  std::swap(u_, u_star_);
}

void Incompressible::refuse_sealed(const CutCells& cut) const {
  const auto sealed = find_sealed(grid_, cut, boundaries_, views(q_));
  if (!sealed) return;
  throw DivergedError(fmt::format(
      "bodies close off a part of the box: {:.3g} m3/s of fluid {} near x, y, z = {:.4g}, {:.4g}, {:.4g} mm, "
      "and "
      "no open face of the box leads {} there; leave a gap around the body, or open a face",
      std::abs(sealed->flow), sealed->flow > 0.0 ? "enters it" : "leaves it", 1e3 * sealed->at.x(),
      1e3 * sealed->at.y(), 1e3 * sealed->at.z(), sealed->flow > 0.0 ? "out of" : "into"));
}

void Incompressible::advance(double time, double dt, CutCells& cut) {
  const Real h = static_cast<Real>(dt);
  filter_time_ = static_cast<Real>(kFilter / std::max(courant(1.0), 1e-30));
  convection_ = -1.0;
  cut_flow_.extend_to_small(cut, p_.view());
  move_displaced(cut_flow_.begin(cut, std::as_const(*this).views(u_), p_.view(), true, dt));
  cut_pressure_.begin(cut, boundaries_);
  smoothing_ = turbulence_ && dt > explicit_dt_;
  if (smoothing_) smoother_.prepare(0.5 * dt * largest_viscosity_, cut, cut_flow_.carried());

  book_boundaries(predict(0.0, 1.0, time, h, cut, kStageWeight), dt);
  cut_flow_.extend(cut, views(u_star_), wall_turbulence());
  {
    ScopedTimer timer(times_.boundaries);
    boundaries_.update(time + dt);
  }
  correct(cut, h);
  book_pressure(phi_.view(), kStageWeight, dt);
  std::swap(u_old_, u_star_);  // correct() left the velocity of the step's beginning there

  book_boundaries(predict(0.5, 0.5, time + dt, h, cut, 1.0), dt);
  for (int n = 1; n < setup_.corrections; ++n) {
    cut_flow_.extend(cut, views(u_star_), wall_turbulence());
    correct(cut, h);
    book_pressure(phi_.view(), 1.0, dt);
    if (n + 1 < setup_.corrections) {
      std::swap(u_, u_star_);
      boundaries_.fill_pressure(p_.view(), views(q_), true);
    }
  }
  if (!cut.empty())
    boundaries_.fill_pressure(p_.view(), views(q_), true);  // of bodies across the faces of the box
  cut_flow_.press(cut, p_.view(), dt * setup_.density);
  cut_flow_.extend_to_solids(cut, p_.view());
  for (std::size_t w = 0; w < cut.walls.size(); ++w)
    ledger_.impulse_on_solids += cut.pressure_impulse[w] + cut.friction_impulse[w];

  if (turbulence_) {
    ScopedTimer timer(times_.turbulence);
    boundaries_.fill_velocity(views(u_), views(q_));
    turbulence_->advance(boundaries_, std::as_const(*this).views(u_), views(q_), cut, h,
                         smoothing_ ? &smoother_ : nullptr);
  }
}

void Incompressible::book_boundaries(const BoundaryFlow& through, double dt) {
  const double factor = kStageWeight * dt * setup_.density;
  ledger_.momentum_through_boundaries +=
      factor * (through.momentum + setup_.acceleration * (box_volume_ - cut_flow_.solid_volume()));
  ledger_.mass_through_boundaries += factor * through.volume;
  ledger_.mass_in += factor * through.volume_in;
  book_pressure(p_.view(), kStageWeight, dt);
}

void Incompressible::book_pressure(ConstFieldView p, double weight, double dt) {
  ScopedTimer timer(times_.ledger);
  ledger_.momentum_through_boundaries +=
      weight * dt * setup_.density * (boundary_pressure(grid_, p) - cut_flow_.pressure_on_closed(p));
}

std::vector<NamedField> Incompressible::state() {
  std::vector<NamedField> all{{"velocity_x", &u_[0]},      {"velocity_y", &u_[1]},
                              {"velocity_z", &u_[2]},      {"face_velocity_x", &q_[0]},
                              {"face_velocity_y", &q_[1]}, {"face_velocity_z", &q_[2]},
                              {"pressure", &p_},           {"carried", &cut_flow_.carried_field()}};
  if (turbulence_)
    for (const NamedField& f : turbulence_->state()) all.push_back(f);
  return all;
}

}  // namespace ejecta
