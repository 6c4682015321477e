#include "flow/piso/momentum.hpp"

#include <algorithm>
#include <type_traits>

#include "flow/stencil.hpp"
#include "flow/sweep.hpp"

namespace ejecta {
namespace {

template <bool kTurbulent>
struct MomentumFlux {
  std::array<ConstFieldView, 3> u, q;
  ConstFieldView nut;
  Metrics m[3];
  Real nu;

  template <int D>
  [[gnu::noinline]] void flux(int j, int k, int i0, int i1, Real* const (&out)[3]) const {
    constexpr int A = (D + 1) % 3, B = (D + 2) % 3;  // the two directions across the face
    const std::ptrdiff_t s = stride(u[0], D), sa = stride(u[0], A), sb = stride(u[0], B);
    const Real* velocity = q[D].row(j, k);
    const Real* normal = u[D].row(j, k);
    const Real* across_a = u[A].row(j, k);
    const Real* across_b = u[B].row(j, k);
    const Real* eddy = kTurbulent ? nut.row(j, k) : nullptr;
    Real *out_d = out[D], *out_a = out[A], *out_b = out[B];
    for_each_lane(
        i0, i1, [ =, this ](int i) __attribute__((always_inline)) {
          const int at[3] = {i, j, k};
          const FaceMetrics f = face_metrics(m[D], at[D]);
          const Real area = face_area<D>(m, i, j, k);
          const Real v = velocity[i];
          const auto convected = [&](const Real* p) __attribute__((always_inline)) {
            return v * upwind_value(v, p[i - 2 * s], p[i - s], p[i], p[i + s], f);
          };
          const auto gradient = [&](const Real* p) __attribute__((always_inline)) {
            return (p[i] - p[i - s]) * f.inv_here;
          };
          if constexpr (kTurbulent) {
            const Real viscosity = nu + f.weight * eddy[i - s] + (Real(1) - f.weight) * eddy[i];
            const auto cross = [&](std::ptrdiff_t step, Real inv_span_low, Real inv_span_high) {
              return f.weight * derivative(normal + i - s, step, inv_span_low) +
                     (Real(1) - f.weight) * derivative(normal + i, step, inv_span_high);
            };
            const Real span_a = m[A].inv_span[at[A]], span_b = m[B].inv_span[at[B]];
            // The transposed part of the normal stress by wide differences too: it must not halve the stable
            // step.
            out_d[i] =
                area * (convected(normal) - viscosity * (gradient(normal) + cross(s, m[D].inv_span[at[D] - 1],
                                                                                  m[D].inv_span[at[D]])));
            out_a[i] =
                area * (convected(across_a) - viscosity * (gradient(across_a) + cross(sa, span_a, span_a)));
            out_b[i] =
                area * (convected(across_b) - viscosity * (gradient(across_b) + cross(sb, span_b, span_b)));
          } else {
            out_d[i] = area * (convected(normal) - nu * gradient(normal));
            out_a[i] = area * (convected(across_a) - nu * gradient(across_a));
            out_b[i] = area * (convected(across_b) - nu * gradient(across_b));
          }
        });
  }
};

/// rows: of planes k (faces in x and y), then of rows j on the lower and on the upper face in z.
template <bool kTurbulent>
BoundaryFlow predict(const Grid& grid, const MomentumTerms& t, std::vector<BoundaryFlow>& rows) {
  const MomentumFlux<kTurbulent> face{t.u,
                                      t.face_velocity,
                                      t.eddy_viscosity,
                                      {grid.metrics(0), grid.metrics(1), grid.metrics(2)},
                                      t.viscosity};
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  const auto component = [&](auto which, int j, int k, const Real* balance) {
    constexpr int C = decltype(which)::value;
    const Real* source = t.source[C].origin ? t.source[C].row(j, k) : nullptr;
    Real* out = t.out[C].row(j, k);
    const Real step = t.b * t.dt, acceleration = t.acceleration[C];
    const Real base_a = t.increment_only ? Real(0) : t.a, base_b = t.increment_only ? Real(0) : t.b;
    const Real *now = t.u[C].row(j, k), *p = t.pressure.origin ? t.pressure.row(j, k) : nullptr;
    const Real* old = base_a == Real(0) ? now : t.old[C].row(j, k);  // not needed: not fetched either
    const Real inv_jk = m[1].inv_volume[j] * m[2].inv_volume[k];
    const std::ptrdiff_t s = stride(t.pressure, C);
    const Metrics mc = m[C];
    const Real* inv_volume = m[0].inv_volume;
    const int nx = grid.nx();
    const auto finish = [=](auto with_source, auto with_pressure) {
      for_each_lane(0, nx, [=](int i) {
        const int at = C == 0 ? i : C == 1 ? j : k;
        Real rate = acceleration - balance[i] * inv_volume[i] * inv_jk;
        if constexpr (with_pressure) rate -= cell_gradient(p + i, s, mc, at);
        if constexpr (with_source) rate += source[i];
        out[i] = base_a * old[i] + base_b * now[i] + step * rate;
      });
    };
    using Yes = std::true_type;
    using No = std::false_type;
    const bool pressed = p && grid.active(C);
    if (source) pressed ? finish(Yes{}, Yes{}) : finish(Yes{}, No{});
    else pressed ? finish(No{}, Yes{}) : finish(No{}, No{});
    if (C == 0 && grid.axisymmetric()) {
      // - tau_theta_theta / r, tau = 2 nu u_r / r (nu u_r / r without the transposed gradient), implicit:
      // next to the axis it is stiffer than any other term.
      const Real* eddy = kTurbulent ? t.eddy_viscosity.row(j, k) : nullptr;
      const Real* r = m[0].centre;
      const Real nu = t.viscosity;
      for_each_lane(0, grid.nx(), [=](int i) {
        const Real rate = step * (kTurbulent ? Real(2) * (nu + eddy[i]) : nu) / (r[i] * r[i]);
        const Real base = base_a * old[i] + base_b * now[i];
        out[i] = base + (out[i] - base - rate * now[i]) / (Real(1) + rate);
      });
    }
  };
  const int nx = grid.nx(), ny = grid.ny(), nz = grid.nz();
  rows.assign(static_cast<std::size_t>(nz + 2 * ny), {});
  sweep<3>(
      grid, face,
      [&](int j, int k, Real* const(&balance)[3]) {
        component(std::integral_constant<int, 0>{}, j, k, balance[0]);
        component(std::integral_constant<int, 1>{}, j, k, balance[1]);
        component(std::integral_constant<int, 2>{}, j, k, balance[2]);
      },
      [&](auto direction, int side, int j, int k, Real* const(&flux)[3]) {
        constexpr int D = decltype(direction)::value;
        const int i0 = D == 0 && side ? nx : 0, i1 = D == 0 ? i0 + 1 : nx;
        const double sign = side ? -1.0 : 1.0;
        BoundaryFlow& sum = rows[static_cast<std::size_t>(D < 2 ? k : nz + side * ny + j)];
        const Real* q = t.face_velocity[D].row(j, k);
        for (int i = i0; i < i1; ++i) {
          for (int c = 0; c < 3; ++c) sum.momentum[c] += sign * double(flux[c][i]);
          const double volume = sign * double(face_area<D>(m, i, j, k)) * double(q[i]);
          sum.volume += volume;
          sum.volume_in += std::max(volume, 0.0);
        }
      });
  BoundaryFlow total;
  for (const BoundaryFlow& part : rows) {
    total.momentum += part.momentum;
    total.volume += part.volume;
    total.volume_in += part.volume_in;
  }
  return total;
}

}  // namespace

/// As MomentumFlux, for one face.
FaceMomentum momentum_at_face(const Grid& grid, const MomentumTerms& t, int d, int i, int j, int k) {
  const std::array<Metrics, 3>& m = grid.metrics();
  const int at[3] = {i, j, k};
  const std::ptrdiff_t s = stride(t.u[0], d);
  const FaceMetrics f = face_metrics(m[d], at[d]);
  const Real v = t.face_velocity[static_cast<std::size_t>(d)](i, j, k);
  Real viscosity = t.viscosity;
  if (t.eddy_viscosity.origin) {
    const Real* eddy = &t.eddy_viscosity(i, j, k);
    viscosity += f.weight * eddy[-s] + (Real(1) - f.weight) * eddy[0];
  }
  const Real* normal = &t.u[static_cast<std::size_t>(d)](i, j, k);
  FaceMomentum out;
  for (int c = 0; c < 3; ++c) {
    const Real* p = &t.u[static_cast<std::size_t>(c)](i, j, k);
    out.carried[static_cast<std::size_t>(c)] = upwind_value(v, p[-2 * s], p[-s], p[0], p[s], f);
    Real strain = (p[0] - p[-s]) * f.inv_here;
    if (t.eddy_viscosity.origin) {
      const std::ptrdiff_t step = stride(t.u[0], c);
      const Real low = m[c].inv_span[c == d ? at[c] - 1 : at[c]], high = m[c].inv_span[at[c]];
      strain += f.weight * derivative(normal - s, step, low) +
                (Real(1) - f.weight) * derivative(normal, step, high);
    }
    out.stress[static_cast<std::size_t>(c)] = viscosity * strain;
  }
  return out;
}

Vec3 boundary_pressure(const Grid& grid, ConstFieldView p) {
  const Metrics m[3] = {grid.metrics(0), grid.metrics(1), grid.metrics(2)};
  Vec3 force{0, 0, 0};
  const auto add = [&](auto direction, int side) {
    constexpr int D = decltype(direction)::value;
    if (!grid.active(D)) return;
    const int n = side ? grid.n(D) : 0;
    Range3 r = grid.range();
    (D == 0 ? r.i0 : D == 1 ? r.j0 : r.k0) = n;
    (D == 0 ? r.i1 : D == 1 ? r.j1 : r.k1) = n + 1;
    const std::ptrdiff_t s = stride(p, D);
    const Real w = m[D].weight[n];
    const double sum = reduce_sum(r, [=](int i, int j, int k) {
      const Real* pc = p.row(j, k) + i;
      return double(face_area<D>(m, i, j, k)) * double(w * pc[-s] + (Real(1) - w) * pc[0]);
    });
    force[D] += side ? -sum : sum;
  };
  for (int side = 0; side < 2; ++side) {
    add(std::integral_constant<int, 0>{}, side);
    add(std::integral_constant<int, 1>{}, side);
    add(std::integral_constant<int, 2>{}, side);
  }
  return force;
}

BoundaryFlow predict_momentum(const Grid& grid, const MomentumTerms& terms,
                              std::vector<BoundaryFlow>& scratch) {
  return terms.eddy_viscosity.origin ? predict<true>(grid, terms, scratch)
                                     : predict<false>(grid, terms, scratch);
}

}  // namespace ejecta
