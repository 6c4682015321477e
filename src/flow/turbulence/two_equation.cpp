#include "flow/turbulence/two_equation.hpp"

#include <utility>

#include "flow/stencil.hpp"
#include "flow/sweep.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta {
namespace {

struct Strain {
  std::array<ConstFieldView, 3> u;
  Metrics m[3];
  bool axisymmetric;

  VelocityGradient operator()(int i, int j, int k) const {
    const Real span[3] = {m[0].inv_span[i], m[1].inv_span[j], m[2].inv_span[k]};
    VelocityGradient v;
    for (int c = 0; c < 3; ++c) {
      const Real* p = u[c].row(j, k) + i;
      v.g[c][0] = derivative(p, 1, span[0]);
      v.g[c][1] = derivative(p, u[c].sy, span[1]);
      v.g[c][2] = derivative(p, u[c].sz, span[2]);
    }
    if (axisymmetric) v.g[1][1] = u[0](i, j, k) / m[0].centre[i];  // hoop strain u_r / r
    return v;
  }
};

Strain strain(const Grid& grid, const std::array<ConstFieldView, 3>& u) {
  return {u, {grid.metrics(0), grid.metrics(1), grid.metrics(2)}, grid.axisymmetric()};
}

template <bool kSst>
struct ScalarFlux {
  ConstFieldView value[2], nut, f1;
  std::array<ConstFieldView, 3> q;
  Metrics m[3];
  Real nu, dt;

  template <int D>
  void flux(int j, int k, int i0, int i1, Real* const (&out)[2]) const {
    const std::ptrdiff_t s = stride(nut, D);
    const Real *velocity = q[D].row(j, k), *eddy = nut.row(j, k), *blend = kSst ? f1.row(j, k) : nullptr;
    const Real *one = value[0].row(j, k), *two = value[1].row(j, k);
    Real *out_one = out[0], *out_two = out[1];
    for_each_lane(i0, i1, [=, this](int i) {
      const int at = D == 0 ? i : D == 1 ? j : k;
      FaceMetrics f = face_metrics(m[D], at);
      const Real v = velocity[i], area = face_area<D>(m, i, j, k);
      // Time-centred upwind value: half a cell less the way travelled in half a step.
      const Real travelled = Real(0.5) * std::abs(v) * dt;
      f.half_low = std::max(f.half_low - travelled, Real(0));
      f.half_high = std::max(f.half_high - travelled, Real(0));
      const Real eddy_here = f.weight * eddy[i - s] + (Real(1) - f.weight) * eddy[i];
      Real sigma_k = Real(1) / k_epsilon::kSigmaK, sigma_2 = Real(1) / k_epsilon::kSigmaEpsilon;
      if constexpr (kSst) {
        const Real b = f.weight * blend[i - s] + (Real(1) - f.weight) * blend[i];
        sigma_k = k_omega_sst::blend(b, k_omega_sst::kSigmaK1, k_omega_sst::kSigmaK2);
        sigma_2 = k_omega_sst::blend(b, k_omega_sst::kSigmaW1, k_omega_sst::kSigmaW2);
      }
      const auto through = [&](const Real* p, Real sigma) {
        return area * (v * upwind_value(v, p[i - 2 * s], p[i - s], p[i], p[i + s], f) -
                       (nu + sigma * eddy_here) * (p[i] - p[i - s]) * f.inv_here);
      };
      out_one[i] = through(one, sigma_k);
      out_two[i] = through(two, sigma_2);
    });
  }
};

template <bool kSst, bool kRound>
void transport(const Grid& grid, const ScalarFlux<kSst>& face, const Strain& gradient, FieldView k_new,
               FieldView second_new) {
  sweep<2>(grid, face, [&](int j, int k, Real* const(&balance)[2]) {
    const Real *b0 = balance[0], *b1 = balance[1];
    const Real dt = face.dt, inv_jk = face.m[1].inv_volume[j] * face.m[2].inv_volume[k];
    for_each_lane(0, grid.nx(), [=, &face, &gradient](int i) {
      const Real inv_volume = face.m[0].inv_volume[i] * inv_jk;
      const Real k0 = face.value[0](i, j, k), s0 = face.value[1](i, j, k), nut = face.nut(i, j, k);
      const VelocityGradient v = gradient(i, j, k);
      const Real strain2 = strain_squared(v);
      const Real k_carried = k0 - dt * b0[i] * inv_volume, s_carried = s0 - dt * b1[i] * inv_volume;
      Real k1, s1;
      if constexpr (kSst) {
        using namespace k_omega_sst;
        const Real f1 = face.f1(i, j, k);
        const Real beta = blend(f1, kBeta1, kBeta2);
        const Real produced = std::min(nut * strain2, Real(20) * kBetaStar * k0 * s0);
        Real gradients = 0;
        const std::ptrdiff_t steps[3] = {1, face.nut.sy, face.nut.sz};
        const int at[3] = {i, j, k};
        for (int d = 0; d < 3; ++d)
          gradients += derivative(&face.value[0](i, j, k), steps[d], face.m[d].inv_span[at[d]]) *
                       derivative(&face.value[1](i, j, k), steps[d], face.m[d].inv_span[at[d]]);
        const Real cross = (Real(1) - f1) * cross_diffusion(s0, gradients);
        k1 = (k_carried + dt * produced) / (Real(1) + dt * kBetaStar * s0);
        s1 = (s_carried + dt * (gamma(f1) * std::min(strain2, Real(20) * kBetaStar * k0 * s0 /
                                                                  std::max(nut, Real(1e-12))) +
                                std::max(cross, Real(0)))) /
             (Real(1) + dt * (beta * s0 + std::max(-cross, Real(0)) / s0));
      } else {
        using namespace k_epsilon;
        const Real rate = s0 / k0, produced = nut * strain2;
        Real gain = kC1 * produced, loss = kC2;
        if constexpr (kRound) {
          const Real pope = kC3 * pope_chi(k0, s0, vortex_stretching(v));
          gain += std::max(pope, Real(0)) * s0;
          loss += std::max(-pope, Real(0));
        }
        k1 = (k_carried + dt * produced) / (Real(1) + dt * rate);
        s1 = (s_carried + dt * rate * gain) / (Real(1) + dt * loss * rate);
      }
      k_new(i, j, k) = std::max(k1, kMinimalK);
      second_new(i, j, k) = std::max(s1, kMinimalSecond);
    });
  });
}

}  // namespace

TwoEquation::TwoEquation(const Grid& grid, TwoEquationModel model, bool round_jet_correction,
                         double viscosity)
    : grid_(grid),
      model_(model),
      round_jet_(round_jet_correction),
      nu_(static_cast<Real>(viscosity)),
      k_(grid.make_field()),
      second_(grid.make_field()),
      nut_(grid.make_field()),
      f1_(grid.make_field()),
      k_new_(grid.make_field()),
      second_new_(grid.make_field()) {
  initialise(kMinimalK, kMinimalSecond);
}

void TwoEquation::initialise(double k, double second) {
  for (Field* f : {&k_, &k_new_}) f->fill(std::max(static_cast<Real>(k), kMinimalK));
  for (Field* f : {&second_, &second_new_}) f->fill(std::max(static_cast<Real>(second), kMinimalSecond));
}

void TwoEquation::set_at(int i, int j, int k_index, double k, double second) {
  k_(i, j, k_index) = std::max(static_cast<Real>(k), kMinimalK);
  second_(i, j, k_index) = std::max(static_cast<Real>(second), kMinimalSecond);
}

Real TwoEquation::wall_distance(int i, int j, int k) const {
  const int at[3] = {i, j, k};
  Real distance = Real(1e3);
  for (int d = 0; d < 3; ++d) {
    const Metrics m = grid_.metrics(d);
    if (is_wall_[2 * d]) distance = std::min(distance, m.centre[at[d]] - m.face[0]);
    if (is_wall_[2 * d + 1]) distance = std::min(distance, m.face[grid_.n(d)] - m.centre[at[d]]);
  }
  return distance;
}

void TwoEquation::update_eddy_viscosity(const Boundaries& b, const std::array<ConstFieldView, 3>& u,
                                        const std::array<FieldView, 3>& q, const SolidMask& solids) {
  for (int face = 0; face < 6; ++face)
    is_wall_[face] = grid_.active(face / 2) && b.kind(face) == BoundaryKind::wall;
  b.fill_turbulence(k_.view(), second_.view(), q);
  const FieldView nut = nut_.view(), f1 = f1_.view();
  const ConstFieldView k = k_.view(), second = second_.view();
  const Real nu = nu_;
  if (model_ == TwoEquationModel::k_epsilon) {
    for_each_cell(grid_.range(), [=](int i, int j, int l) {
      nut(i, j, l) = k_epsilon::eddy_viscosity(k(i, j, l), second(i, j, l));
    });
  } else {
    const Strain gradient = strain(grid_, u);
    const Metrics m[3] = {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
    for_each_cell(grid_.range(), [=, this](int i, int j, int l) {
      using namespace k_omega_sst;
      const Real d = wall_distance(i, j, l), kk = k(i, j, l), w = second(i, j, l);
      const std::ptrdiff_t steps[3] = {1, k.sy, k.sz};
      const int at[3] = {i, j, l};
      Real gradients = 0;
      for (int c = 0; c < 3; ++c)
        gradients += derivative(&k(i, j, l), steps[c], m[c].inv_span[at[c]]) *
                     derivative(&second(i, j, l), steps[c], m[c].inv_span[at[c]]);
      f1(i, j, l) = k_omega_sst::f1(kk, w, nu, d, cross_diffusion(w, gradients));
      nut(i, j, l) = eddy_viscosity(kk, w, std::sqrt(strain_squared(gradient(i, j, l))), f2(kk, w, nu, d));
    });
    b.fill_zero_gradient(f1);
  }
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    nut(c.i, c.j, c.k) *= Real(1) - c.weight;
  });
  b.fill_zero_gradient(nut);
  apply_walls();
}

/// Equilibrium values in the cells next to walls and the wall's eddy viscosity in the ghosts (Launder &
/// Spalding 1974).
void TwoEquation::apply_walls() {
  for (int face = 0; face < 6; ++face) {
    if (!is_wall_[face]) continue;
    const int d = face / 2, n = grid_.n(d), cell = face % 2 ? n - 1 : 0, ghost = face % 2 ? n : -1;
    const Metrics m = grid_.metrics(d);
    const Real y = Real(0.5) * m.width[cell];
    const int na = grid_.n((d + 1) % 3), nb = grid_.n((d + 2) % 3);
    const auto at = [&](Field& f, int a, int bb, int along) -> Real& {
      return d == 0 ? f(along, a, bb) : d == 1 ? f(bb, along, a) : f(a, bb, along);
    };
    constexpr Real kappa = Real(0.41), quarter = Real(0.5477226);  // 0.09^(1/4)
    for_each_index(nb, [&](int bb) {
      for (int a = 0; a < na; ++a) {
        const Real k = at(k_, a, bb, cell), friction = quarter * std::sqrt(k);
        const Real y_plus = friction * y / nu_;
        const Real on_wall = nu_ * wall_eddy_viscosity(y_plus);
        at(nut_, a, bb, ghost) = Real(2) * on_wall - at(nut_, a, bb, cell);
        if (model_ == TwoEquationModel::k_epsilon) {
          at(second_, a, bb, cell) =
              std::max(friction * friction * friction / (kappa * y), Real(2) * nu_ * k / (y * y));
        } else {
          const Real viscous = Real(6) * nu_ / (k_omega_sst::kBeta1 * y * y),
                     log = friction / (Real(0.3) * kappa * y);
          at(second_, a, bb, cell) = std::sqrt(viscous * viscous + log * log);
        }
      }
    });
  }
}

void TwoEquation::advance(const Boundaries& b, const std::array<ConstFieldView, 3>& u,
                          const std::array<FieldView, 3>& q, const SolidMask& solids, Real dt) {
  b.fill_turbulence(k_.view(), second_.view(), q);
  const Strain gradient = strain(grid_, u);
  const std::array<ConstFieldView, 3> faces{q[0], q[1], q[2]};
  const auto run = [&](auto sst, auto round) {
    const ScalarFlux<sst> face{{k_.view(), second_.view()},
                               nut_.view(),
                               f1_.view(),
                               faces,
                               {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)},
                               nu_,
                               dt};
    transport<sst, round>(grid_, face, gradient, k_new_.view(), second_new_.view());
  };
  if (model_ == TwoEquationModel::k_omega_sst) run(std::true_type{}, std::false_type{});
  else if (round_jet_) run(std::false_type{}, std::true_type{});
  else run(std::false_type{}, std::false_type{});
  std::swap(k_, k_new_);
  std::swap(second_, second_new_);
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {  // no turbulence inside a solid
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    k_(c.i, c.j, c.k) += c.weight * (kMinimalK - k_(c.i, c.j, c.k));
  });
  update_eddy_viscosity(b, u, q, solids);
}

}  // namespace ejecta
