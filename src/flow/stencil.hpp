#pragma once
#include "base/parallel.hpp"
#include "grid/grid.hpp"

/// What every finite-volume kernel of the flow is built from.
namespace ejecta {

/// van Leer (1974) harmonic mean of two one-sided gradients; zero at an extremum.
EJECTA_KERNEL Real limiter_van_leer(Real a, Real b) {
  const Real product = a * b;
  return product > Real(0) ? Real(2) * product / (a + b) : Real(0);
}

/// Far below anything that matters, in any unit: keeps still air still.
inline constexpr Real kLeastPositive = Real(1e-8);

/// What an explicit step makes of a quantity that is positive: the sum, and where more than half of what was
/// there would go, a value that falls like 1/change and never reaches zero. A bound at zero would be a trap:
/// without dissipation nothing brings turbulence down, and without turbulence nothing brings dissipation
/// back.
EJECTA_KERNEL Real positive_sum(Real before, Real change) {
  const Real half = Real(-0.5) * before;
  const Real sum = change < half ? half * half / -change : before + change;
  return sum < kLeastPositive ? kLeastPositive : sum;  // NaN stays
}

/// The grid along one direction D around the lower face of a cell, as scalars.
struct FaceMetrics {
  Real inv_below, inv_here, inv_above;  ///< 1/distance at the faces below, here and above, 1/m
  Real half_low, half_high;             ///< half widths of the cells below and above the face, m
  Real weight;                          ///< of the cell below in the value on the face
};

EJECTA_KERNEL FaceMetrics face_metrics(const Metrics& m, int at) {
  return {m.inv_distance[at - 1],      m.inv_distance[at],      m.inv_distance[at + 1],
          Real(0.5) * m.width[at - 1], Real(0.5) * m.width[at], m.weight[at]};
}

/// Limited second-order upwind value on a face, from two cells below (a, b) and two above (c, d).
EJECTA_KERNEL Real upwind_value(Real velocity, Real a, Real b, Real c, Real d, const FaceMetrics& f) {
  const bool up = velocity > Real(0);
  const Real upwind = up ? b : c;
  const Real behind = (upwind - (up ? a : d)) * (up ? f.inv_below : f.inv_above);
  const Real ahead = ((up ? c : b) - upwind) * f.inv_here;
  return upwind + (up ? f.half_low : f.half_high) * limiter_van_leer(behind, ahead);
}

template <class T>
EJECTA_KERNEL std::ptrdiff_t stride(const View<T>& v, int d) {
  return d == 0 ? 1 : d == 1 ? v.sy : v.sz;
}

/// Area of the lower D-face of cell (i, j, k), m2 (axisymmetric: per radian).
template <int D>
EJECTA_KERNEL Real face_area(const Metrics (&m)[3], int i, int j, int k) {
  if constexpr (D == 0) return m[0].area[i] * m[1].volume[j] * m[2].volume[k];
  if constexpr (D == 1) return m[0].volume[i] * m[2].volume[k];
  return m[0].volume[i] * m[1].volume[j];
}

/// Central derivative along D at a cell.
EJECTA_KERNEL Real derivative(const Real* at, std::ptrdiff_t step, Real inv_span) {
  return (at[step] - at[-step]) * inv_span;
}

/// Gauss gradient along one direction: face values linear between centres.
EJECTA_KERNEL Real cell_gradient(const Real* p, std::ptrdiff_t s, const Metrics& m, int at) {
  const Real low = m.weight[at] * p[-s] + (Real(1) - m.weight[at]) * p[0];
  const Real high = m.weight[at + 1] * p[0] + (Real(1) - m.weight[at + 1]) * p[s];
  return (high - low) * m.inv_width[at];
}

}  // namespace ejecta
