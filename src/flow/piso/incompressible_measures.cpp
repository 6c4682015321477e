// What is read off an incompressible flow: the step it allows, its sums, whether it is finite.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "flow/piso/incompressible.hpp"
#include "flow/piso/projection.hpp"

namespace ejecta {
namespace {

/// What one cell says about the next step: convection r = sum |u| / h and viscosity 2 nu sum 1 / h2, 1/s, and
/// what the speed grows by, g = sum a / h, 1/s2. Ghosts and the inside of solids say nothing of their own:
/// what they hold is not fluid.
struct Rates {
  std::array<ConstFieldView, 3> u, before;  ///< now and at the beginning of the last step
  ConstFieldView nut, carried;
  Metrics x, y, z;
  Real on_x, on_y, on_z, nu;
  Real inv_last = 0;  ///< of the last step, 1/s

  EJECTA_KERNEL Real fluid(int i, int j, int k) const { return Real(carried(i, j, k) > Real(0)); }
  EJECTA_KERNEL Real convection(int i, int j, int k) const {
    return fluid(i, j, k) * (on_x * std::abs(u[0](i, j, k)) * x.inv_width[i] +
                             on_y * std::abs(u[1](i, j, k)) * y.inv_width[j] +
                             on_z * std::abs(u[2](i, j, k)) * z.inv_width[k]);
  }
  EJECTA_KERNEL Real viscosity(int i, int j, int k, Real eddy) const {
    const Real hx = x.inv_width[i], hy = y.inv_width[j], hz = z.inv_width[k];
    return Real(2) * (nu + eddy) * (on_x * hx * hx + on_y * hy * hy + on_z * hz * hz);
  }
  /// What the last step changed a velocity by, as far as the same again can raise |u| above what it is: a
  /// step of at most twice the last one slows |u| down, or turns it round within |u|, when it changed by
  /// less.
  EJECTA_KERNEL Real growth(ConstFieldView now, ConstFieldView then, int i, int j, int k) const {
    const Real v = now(i, j, k), change = v - then(i, j, k);
    const bool grows = (v * change >= 0) | (std::abs(change) > std::abs(v));  // without a branch
    return grows ? std::abs(change) : Real(0);
  }
  EJECTA_KERNEL Real acceleration(int i, int j, int k) const {
    return fluid(i, j, k) * inv_last *
           (on_x * growth(u[0], before[0], i, j, k) * x.inv_width[i] +
            on_y * growth(u[1], before[1], i, j, k) * y.inv_width[j] +
            on_z * growth(u[2], before[2], i, j, k) * z.inv_width[k]);
  }
};

/// Inverse of the step that solves dt (rate + g dt) = 1.
EJECTA_KERNEL Real rate_with(Real rate, Real g) {
  return Real(0.5) * (rate + std::sqrt(rate * rate + Real(4) * g));
}

Rates rates(const Grid& grid, const std::array<ConstFieldView, 3>& u,
            const std::array<ConstFieldView, 3>& before, ConstFieldView nut, ConstFieldView carried,
            double nu) {
  return {u,
          before,
          nut,
          carried,
          grid.metrics(0),
          grid.metrics(1),
          grid.metrics(2),
          Real(grid.active(0)),
          Real(grid.active(1)),
          Real(grid.active(2)),
          static_cast<Real>(nu)};
}

}  // namespace

double Incompressible::stable_dt(double courant, double last_dt, double most) {
  Rates r = rates(grid_, std::as_const(*this).views(u_), std::as_const(*this).views(u_old_),
                  turbulence_ ? turbulence_->eddy_viscosity() : ConstFieldView{}, cut_flow_.carried(),
                  setup_.viscosity);
  r.inv_last = last_dt > 0.0 ? static_cast<Real>(1.0 / last_dt) : Real(0);
  // Heun's method is stable to -2 on the negative real axis, where upwinding reaches -2 sum |u| dt/h and
  // viscosity -4 nu sum dt/h2; k and epsilon, explicit Euler, stay positive under the same sum.
  const Real by_courant = static_cast<Real>(1.0 / courant);
  // Smoothing ends at the sides of the box: a wave that goes on beyond them would be damped too little. A
  // channel that is periodic along the stream kept waves of two cells of a tenth of its speed.
  bool continues = false;
  for (int d = 0; d < 3; ++d)
    continues |= grid_.active(d) && boundaries_.kind(2 * d) == BoundaryKind::periodic;
  const Real unsmoothed = Real(!turbulence_ || continues);
  // A NaN stays one, so that the owner of the run hears of it at once.
  const auto step = [](double rate) { return rate < 1e-30 ? 1e30 : 1.0 / rate; };
  const auto largest = [&](auto turbulent) {  // known to the compiler: a load on a condition is no vector's
    return reduce_max<4>(grid_.range(), [=](int i, int j, int k, Real* rate) {
      rate[2] = turbulent() ? r.nut(i, j, k) : Real(0);
      rate[3] = r.convection(i, j, k);
      const Real convective = by_courant * rate[3], viscous = r.viscosity(i, j, k, rate[2]);
      rate[0] = convective + viscous;
      // With eddies: beyond the explicit limit increments are smoothed, up to the convective limit.
      rate[1] = rate_with(convective + unsmoothed * viscous, by_courant * r.acceleration(i, j, k));
    });
  };
  const auto [both, with_growth, eddy, convection] =
      turbulence_ ? largest(std::true_type{}) : largest(std::false_type{});
  convection_ = double(convection);
  if (turbulence_) {
    explicit_dt_ = step(double(both));
    largest_viscosity_ = setup_.viscosity + double(eddy);
  }
  return std::min(step(double(with_growth)), last_dt > 0.0 ? most * last_dt : 1e30);
}

/// Tries a step without solids and takes it back: a resume needs no more than state(). Returns the Courant
/// number it reached. In u_old_ it leaves what stable_dt reads as the velocity before a step of twice its
/// acceleration: twice, because bodies, of which it knows nothing, hasten what goes around them.
double Incompressible::try_step(double time, double dt) {
  std::vector<Field> kept;
  for (const NamedField& f : state()) kept.push_back(*f.field);
  const FlowLedger ledger = ledger_;
  const FlowTimes times = times_;
  CutCells none;
  advance(time, dt, none);
  const double reached = courant(dt);
  for (std::size_t c = 0; c < 3; ++c) std::swap(u_old_[c], u_[c]);
  const std::vector<NamedField> all = state();
  for (std::size_t n = 0; n < all.size(); ++n) *all[n].field = kept[n];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < u_[c].size(); ++n)
      u_old_[c].data()[n] = Real(3) * u_[c].data()[n] - Real(2) * u_old_[c].data()[n];
  ledger_ = ledger;
  times_ = times;
  convection_ = -1.0;
  resume(time);
  return reached;
}

double Incompressible::first_step(double time, double courant, double longest) {
  double dt = std::min({stable_dt(courant), longest, 1.0});
  // The beginning of the motion, before it has crossed a cell, is what counts. NaN is too far as well.
  while (!(try_step(time, dt) <= 1.5 * courant)) {
    dt *= 0.01;
    if (!(dt > 1e-30)) return std::numeric_limits<double>::quiet_NaN();
  }
  return stable_dt(courant, dt, 1e30);
}

double Incompressible::courant(double dt) const {
  if (convection_ >= 0.0) return dt * convection_;
  const Rates r = rates(grid_, views(u_), views(u_old_), {}, cut_flow_.carried(), 0.0);
  return dt * double(reduce_max(grid_.range(), [=](int i, int j, int k) { return r.convection(i, j, k); }));
}

double Incompressible::largest_divergence(const CutCells& cut) {
  if (fraction_ && fraction_step_) {
    fraction_step_->imbalance(*fraction_, fraction_dt_, views(q_), phi_.view());
    return ejecta::largest_divergence(grid_, std::as_const(*this).views(q_), phi_.view());
  }
  cut_flow_.close(cut, views(q_));
  divergence(grid_, std::as_const(*this).views(q_), Real(1), phi_.view());
  cut_flow_.reopen(cut, views(q_));
  cut_flow_.fold(cut, phi_.view());
  return ejecta::largest_divergence(grid_, std::as_const(*this).views(q_), phi_.view());
}

Vec3 Incompressible::momentum() const {
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  Vec3 sum;
  if (fraction_) {
    for (int c = 0; c < 3; ++c)
      sum[c] = setup_.density *
               reduce_sum(grid_.range(),
                          [=, u = u_[c].view(), solids = fraction_->solids.view()](int i, int j, int k) {
                            return (1.0 - double(solids(i, j, k))) * double(u(i, j, k)) *
                                   double(m[0].volume[i]) * double(m[1].volume[j]) * double(m[2].volume[k]);
                          });
    return sum;
  }
  for (int c = 0; c < 3; ++c)
    sum[c] = setup_.density * reduce_sum(grid_.range(), [=, u = u_[c].view(), part = cut_flow_.carried()](
                                                            int i, int j, int k) {
               return double(part(i, j, k)) * double(u(i, j, k)) * double(m[0].volume[i]) *
                      double(m[1].volume[j]) * double(m[2].volume[k]);
             });
  return sum;
}

double Incompressible::kinetic_energy() const {
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  const std::array<ConstFieldView, 3> u = views(u_);
  const ConstFieldView part = cut_flow_.carried();
  if (fraction_)
    return 0.5 * setup_.density *
           reduce_sum(grid_.range(), [=, solids = fraction_->solids.view()](int i, int j, int k) {
             const double x = u[0](i, j, k), y = u[1](i, j, k), z = u[2](i, j, k);
             return (1.0 - double(solids(i, j, k))) * (x * x + y * y + z * z) * double(m[0].volume[i]) *
                    double(m[1].volume[j]) * double(m[2].volume[k]);
           });
  return 0.5 * setup_.density * reduce_sum(grid_.range(), [=](int i, int j, int k) {
           const double x = u[0](i, j, k), y = u[1](i, j, k), z = u[2](i, j, k);
           return double(part(i, j, k)) * (x * x + y * y + z * z) * double(m[0].volume[i]) *
                  double(m[1].volume[j]) * double(m[2].volume[k]);
         });
}

bool Incompressible::finite(Vec3* where) const {
  const std::array<ConstFieldView, 3> u = views(u_);
  const Real largest = reduce_max(grid_.range(), [=](int i, int j, int k) {
    return std::abs(u[0](i, j, k)) + std::abs(u[1](i, j, k)) + std::abs(u[2](i, j, k));
  });
  if (std::isfinite(largest)) return true;
  for (int k = 0; where && k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i)
        if (!std::isfinite(u[0](i, j, k) + u[1](i, j, k) + u[2](i, j, k))) {
          *where = grid_.centre(i, j, k);
          return false;
        }
  return false;
}

}  // namespace ejecta
