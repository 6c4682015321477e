#include "flow/turbulence/two_equation.hpp"

#include <utility>

#include "flow/stencil.hpp"
#include "flow/sweep.hpp"
#include "flow/turbulence/closures.hpp"
#include "flow/turbulence/gradient.hpp"
#include "flow/turbulence/grid_walls.hpp"
#include "flow/turbulence/sources.hpp"
#include "flow/turbulence/wall_cell.hpp"
#include "flow/turbulence/wall_law.hpp"

namespace ejecta {
namespace {

/// grad k . grad omega / omega along row (., j, k). omega of each direction is the mean of the neighbours
/// that make the difference: where it jumps by orders of magnitude, at the edge of a starting jet, the
/// quotient stays within 1/h.
struct ProductRow {
  const Real *a, *b, *span_x;
  std::ptrdiff_t sy, sz;
  Real span_y, span_z;

  EJECTA_KERNEL Real along(int i, std::ptrdiff_t step, Real span) const {
    const Real mean = Real(0.5) * (b[i + step] + b[i - step]);
    return derivative(a + i, step, span) * derivative(b + i, step, span) / mean;
  }
  EJECTA_KERNEL Real operator()(int i) const {
    return along(i, 1, span_x[i]) + along(i, sy, span_y) + along(i, sz, span_z);
  }
};

ProductRow product_row(const Grid& grid, ConstFieldView a, ConstFieldView b, int j, int k) {
  return {a.row(j, k),
          b.row(j, k),
          grid.metrics(0).inv_span,
          a.sy,
          a.sz,
          grid.metrics(1).inv_span[j],
          grid.metrics(2).inv_span[k]};
}

template <bool kSst>
struct ScalarFlux {
  ConstFieldView value[2], nut, f1;
  std::array<ConstFieldView, 3> q;
  Metrics m[3];
  Real nu, dt;

  template <int D>
  [[gnu::noinline]] void flux(int j, int k, int i0, int i1, Real* const (&out)[2]) const {
    const std::ptrdiff_t s = stride(nut, D);
    const Real *velocity = q[D].row(j, k), *eddy = nut.row(j, k), *blend = kSst ? f1.row(j, k) : nullptr;
    const Real *one = value[0].row(j, k), *two = value[1].row(j, k);
    Real *out_one = out[0], *out_two = out[1];
    for_each_lane(
        i0, i1, [ =, this ](int i) __attribute__((always_inline)) {
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

/// Where a transport step writes.
struct ScalarOut {
  FieldView k, dissipation, nut, f1;
  bool unfinished;  ///< k and dissipation are increments still to be smoothed: nu_t is taken from what they
                    ///< are now
};

template <bool kSst, bool kRound>
void transport(const Grid& grid, const ScalarFlux<kSst>& face, const std::array<ConstFieldView, 3>& u,
               const GridWalls& walls, const TwoEquation::WallDistance& wall, ConstFieldView solid_distance,
               const ScalarOut& out) {
  const Real most = kLargestViscosityRatio * face.nu;
  sweep<2>(grid, face, [&](int j, int k, Real* const(&balance)[2]) {
    const Real *b0 = balance[0], *b1 = balance[1], *inv_volume = face.m[0].inv_volume;
    const Real dt = face.dt, inv_jk = face.m[1].inv_volume[j] * face.m[2].inv_volume[k];
    const Real *old_k = face.value[0].row(j, k), *old_second = face.value[1].row(j, k),
               *eddy = face.nut.row(j, k);
    const Real* blending = kSst ? face.f1.row(j, k) : nullptr;
    Real *out_k = out.k.row(j, k), *out_dissipation = out.dissipation.row(j, k), *out_nut = out.nut.row(j, k);
    Real* out_f1 = kSst ? out.f1.row(j, k) : nullptr;
    const Real* from_solid = kSst ? solid_distance.row(j, k) : nullptr;
    const Real nu = face.nu, *distance_x = wall[0].data();
    const Real distance_jk =
        std::min(wall[1][static_cast<std::size_t>(j)], wall[2][static_cast<std::size_t>(k)]);
    const GradientRow gradient = gradient_row(grid, u, j, k);
    const ProductRow product = product_row(grid, face.value[0], face.value[1], j, k);
    const int nx = grid.nx();
    const auto update = [=, &walls](auto axisymmetric, auto unfinished, auto beside_wall) {
      GradientRow row = gradient;
      if constexpr (!axisymmetric) row.radius = nullptr;
      const auto cell = [ =, &walls ](int i) __attribute__((always_inline)) {
        const Real k0 = old_k[i], s0 = old_second[i], nut = eddy[i];
        const VelocityGradient v = row(i);
        Real strain2 = strain_squared(v), produced = nut * strain2;
        if constexpr (beside_wall) {
          const WallShear shear = walls.shear(i, j, k, k0, nu);
          strain2 = shear.strain2;
          produced = shear.produced;
        }
        const Real by_volume = dt * inv_volume[i] * inv_jk;
        const Real k_carried = k0 - by_volume * b0[i], s_carried = s0 - by_volume * b1[i];
        SourcePoint p{k0, s0, k_carried, s_carried, strain2, produced, nut, Real(0), Real(0), Real(0)};
        if constexpr (kSst) {
          p.f1 = blending[i];
          p.gradients = product(i);
        }
        if constexpr (kRound && !beside_wall) p.stretching = vortex_stretching(v);
        const auto [k1, s1] = advance_sources<kSst, kRound>(p, dt);
        out_k[i] = unfinished ? k1 - k0 : positive_sum(k0, k1 - k0);
        out_dissipation[i] = unfinished ? s1 - s0 : positive_sum(s0, s1 - s0);
        const Real rate_of_strain = std::sqrt(strain2), kn = unfinished ? k0 : out_k[i],
                   sn = unfinished ? s0 : out_dissipation[i];
        if constexpr (kSst) {
          using namespace k_omega_sst;
          const Real d = std::min(std::min(distance_x[i], distance_jk), from_solid[i]);
          out_f1[i] = k_omega_sst::f1(kn, sn, nu, d, Real(2) * kSigmaW2 * product(i));
          out_nut[i] = std::min(eddy_viscosity(kn, sn, rate_of_strain, f2(kn, sn, nu, d)), most);
        } else {
          out_nut[i] =
              std::min(k_epsilon::eddy_viscosity(kn, sn, k_epsilon::longest_time(rate_of_strain)), most);
        }
      };
      if constexpr (beside_wall) walls.for_each_in_row(j, k, cell);
      else for_each_lane(0, nx, cell);
    };
    // Decided outside the loop: it would not vectorise.
    const auto choose = [&](auto beside_wall) {
      using Yes = std::true_type;
      using No = std::false_type;
      if (grid.axisymmetric())
        out.unfinished ? update(Yes{}, Yes{}, beside_wall) : update(Yes{}, No{}, beside_wall);
      else out.unfinished ? update(No{}, Yes{}, beside_wall) : update(No{}, No{}, beside_wall);
    };
    choose(std::false_type{});
    if (walls.beside_row(j, k)) [&]() __attribute__((noinline)) {
        choose(std::true_type{});
      }
    ();
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
      dissipation_(grid.make_field()),
      nut_(grid.make_field()),
      f1_(grid.make_field()),
      k_new_(grid.make_field()),
      dissipation_new_(grid.make_field()),
      nut_new_(grid.make_field()),
      f1_new_(grid.make_field()),
      solid_distance_(grid) {
  initialise(kMinimalK, kMinimalDissipation);
}

void TwoEquation::initialise(double k, double dissipation) {
  for (Field* f : {&k_, &k_new_}) f->fill(std::max(static_cast<Real>(k), kMinimalK));
  for (Field* f : {&dissipation_, &dissipation_new_})
    f->fill(std::max(static_cast<Real>(dissipation), kMinimalDissipation));
}

void TwoEquation::set_at(int i, int j, int k_index, double k, double dissipation) {
  k_(i, j, k_index) = std::max(static_cast<Real>(k), kMinimalK);
  dissipation_(i, j, k_index) = std::max(static_cast<Real>(dissipation), kMinimalDissipation);
}

void TwoEquation::measure_walls(const Boundaries& b) {
  for (int d = 0; d < 3; ++d) {
    const Metrics m = grid_.metrics(d);
    std::vector<Real>& distance = wall_distance_[static_cast<std::size_t>(d)];
    distance.assign(static_cast<std::size_t>(grid_.n(d) + kRealLanes),
                    SolidDistance::kNone);  // whole registers
    for (int side = 0; side < 2; ++side) {
      const bool wall = grid_.active(d) && b.kind(2 * d + side) == BoundaryKind::wall;
      is_wall_[static_cast<std::size_t>(2 * d + side)] = wall;
      for (int i = 0; wall && i < grid_.n(d); ++i) {
        Real& here = distance[static_cast<std::size_t>(i)];
        here = std::min(here, std::abs(m.centre[i] - m.face[side ? grid_.n(d) : 0]));
      }
    }
  }
}

/// Equilibrium of dissipation and eddy viscosity in the cells next to walls.
void TwoEquation::apply_walls(const GridWalls& walls) {
  const auto apply = [&](auto sst) {
    walls.for_each_cell([&](int i, int j, int k) {
      const Real kn = k_(i, j, k), dissipation = walls.dissipation<sst>(i, j, k, kn, nu_);
      dissipation_(i, j, k) = dissipation;
      nut_(i, j, k) = wall_eddy_viscosity<sst>(kn, dissipation, nu_);
      walls.shear_by(nut_.view(), i, j, k, kn, nu_);
    });
  };
  model_ == TwoEquationModel::k_omega_sst ? apply(std::true_type{}) : apply(std::false_type{});
}

void TwoEquation::advance(const Boundaries& b, const std::array<ConstFieldView, 3>& u,
                          const std::array<FieldView, 3>& q, const CutCells& cut, Real dt,
                          const IncrementSmoother* smoother) {
  if (wall_distance_[0].empty()) measure_walls(b);
  const GridWalls walls(grid_, is_wall_, u);
  if (model_ == TwoEquationModel::k_omega_sst) solid_distance_.measure(cut);
  b.fill_turbulence(k_.view(), dissipation_.view(), q);
  const std::array<ConstFieldView, 3> faces{q[0], q[1], q[2]};
  const ScalarOut out{k_new_.view(), dissipation_new_.view(), nut_new_.view(), f1_new_.view(),
                      smoother != nullptr};
  const auto run = [&](auto sst, auto round) {
    const ScalarFlux<sst> face{{k_.view(), dissipation_.view()},
                               nut_.view(),
                               f1_.view(),
                               faces,
                               {grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)},
                               nu_,
                               dt};
    transport<sst, round>(grid_, face, u, walls, wall_distance_, solid_distance_.view(), out);
  };
  if (model_ == TwoEquationModel::k_omega_sst) run(std::true_type{}, std::false_type{});
  else if (round_jet_) run(std::false_type{}, std::true_type{});
  else run(std::false_type{}, std::false_type{});
  advance_cut_cells(cut, u, q, dt, smoother != nullptr);
  if (smoother) {
    smoother->apply(k_new_.view(), {k_.view(), Real(1), k_.view(), Real(0), true});
    smoother->apply(dissipation_new_.view(),
                    {dissipation_.view(), Real(1), dissipation_.view(), Real(0), true});
  }
  std::swap(k_, k_new_);
  std::swap(dissipation_, dissipation_new_);
  std::swap(nut_, nut_new_);
  std::swap(f1_, f1_new_);
  finish_cut_cells(cut);
  b.fill_zero_gradient(nut_.view());
  if (model_ == TwoEquationModel::k_omega_sst) b.fill_zero_gradient(f1_.view());
  apply_walls(walls);
}

}  // namespace ejecta
