// What is read off an incompressible flow: the step it allows, its sums, whether it is finite.
#include <algorithm>
#include <cmath>
#include <utility>

#include "flow/piso/incompressible.hpp"
#include "flow/piso/projection.hpp"

namespace ejecta {
namespace {

/// Inverse time scales of one cell: convection sum |u| / h and viscosity 2 nu sum 1 / h2, 1/s.
struct Rates {
  std::array<ConstFieldView, 3> u;
  ConstFieldView nut;
  Metrics x, y, z;
  Real on_x, on_y, on_z, nu;

  EJECTA_KERNEL Real convection(int i, int j, int k) const {
    return on_x * std::abs(u[0](i, j, k)) * x.inv_width[i] + on_y * std::abs(u[1](i, j, k)) * y.inv_width[j] +
           on_z * std::abs(u[2](i, j, k)) * z.inv_width[k];
  }
  EJECTA_KERNEL Real viscosity(int i, int j, int k, Real eddy) const {
    const Real hx = x.inv_width[i], hy = y.inv_width[j], hz = z.inv_width[k];
    return Real(2) * (nu + eddy) * (on_x * hx * hx + on_y * hy * hy + on_z * hz * hz);
  }
};

Rates rates(const Grid& grid, const std::array<ConstFieldView, 3>& u, ConstFieldView nut, double nu) {
  return {u,
          nut,
          grid.metrics(0),
          grid.metrics(1),
          grid.metrics(2),
          Real(grid.active(0)),
          Real(grid.active(1)),
          Real(grid.active(2)),
          static_cast<Real>(nu)};
}

}  // namespace

double Incompressible::stable_dt(double courant) {
  const Rates r = rates(grid_, std::as_const(*this).views(u_),
                        turbulence_ ? turbulence_->eddy_viscosity() : ConstFieldView{}, setup_.viscosity);
  // Heun's method is stable to -2 on the negative real axis, where upwinding reaches -2 sum |u| dt/h and
  // viscosity -4 nu sum dt/h2; k and epsilon, explicit Euler, stay positive under the same sum.
  const Real by_courant = static_cast<Real>(1.0 / courant);
  if (!turbulence_)
    return 1.0 / std::max(1e-30, double(reduce_max(grid_.range(), [=](int i, int j, int k) {
                            return by_courant * r.convection(i, j, k) + r.viscosity(i, j, k, Real(0));
                          })));
  // With eddies: beyond the explicit limit increments are smoothed, up to the convective limit.
  const auto [both, eddy, convection] = reduce_max<3>(grid_.range(), [=](int i, int j, int k, Real* rate) {
    rate[1] = r.nut(i, j, k);
    rate[2] = r.convection(i, j, k);
    rate[0] = by_courant * rate[2] + r.viscosity(i, j, k, rate[1]);
  });
  explicit_dt_ = 1.0 / std::max(1e-30, double(both));
  largest_viscosity_ = setup_.viscosity + double(eddy);
  convection_ = double(convection);
  return courant / std::max(1e-30, convection_);
}

double Incompressible::courant(double dt) const {
  if (convection_ >= 0.0) return dt * convection_;
  const Rates r = rates(grid_, views(u_), {}, 0.0);
  return dt * double(reduce_max(grid_.range(), [=](int i, int j, int k) { return r.convection(i, j, k); }));
}

double Incompressible::largest_divergence(const CutCells& cut) {
  cut_flow_.close(cut, views(q_));
  const double largest = ejecta::largest_divergence(grid_, std::as_const(*this).views(q_));
  cut_flow_.reopen(cut, views(q_));
  return largest;
}

Vec3 Incompressible::momentum() const {
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  Vec3 sum;
  for (int c = 0; c < 3; ++c)
    sum[c] = setup_.density * reduce_sum(grid_.range(), [=, u = u_[c].view(), part = cut_flow_.carried()](int i, int j, int k) {
               return double(part(i, j, k)) * double(u(i, j, k)) * double(m[0].volume[i]) * double(m[1].volume[j]) *
                      double(m[2].volume[k]);
             });
  return sum;
}

double Incompressible::kinetic_energy() const {
  const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  const std::array<ConstFieldView, 3> u = views(u_);
  const ConstFieldView part = cut_flow_.carried();
  return 0.5 * setup_.density * reduce_sum(grid_.range(), [=](int i, int j, int k) {
           const double x = u[0](i, j, k), y = u[1](i, j, k), z = u[2](i, j, k);
           return double(part(i, j, k)) * (x * x + y * y + z * z) * double(m[0].volume[i]) * double(m[1].volume[j]) *
                  double(m[2].volume[k]);
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
