#include "flow/piso/fraction_step.hpp"

#include <cmath>
#include <limits>

#include "base/row_sum.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/piso/projection.hpp"
#include "flow/stencil.hpp"
#include "grid/faces.hpp"

namespace ejecta {
namespace {

constexpr Real kLeastFraction = Real(0.05);

EJECTA_KERNEL Real fluid_part(Real solids) {
  const Real e = Real(1) - solids;
  return e > kLeastFraction ? e : kLeastFraction;
}

}  // namespace

FractionStep::FractionStep(const Grid& grid, const Boundaries& boundaries, FastDiagonalPoisson& poisson)
    : grid_(grid), boundaries_(boundaries), poisson_(grid, boundaries, poisson) {
  for (auto* group : {&coefficient_, &gain_})
    for (Field& f : *group) f = grid.make_field();
  for (Field* f : {&inverse_root_, &rhs_, &correction_}) *f = grid.make_field();
  squares_.resize(static_cast<std::size_t>(grid.nz()));
  floats_ = true;
  for (int face = 0; face < 6; ++face)
    floats_ = floats_ && !(grid.active(face / 2) && boundaries.kind(face) == BoundaryKind::open);
  for (int d = 0; d < 3; ++d) {
    const int n = grid.n(d);
    const std::size_t size = static_cast<std::size_t>(n + 1 + 2 * kRealLanes);
    Shares& s = shares_[static_cast<std::size_t>(d)];
    s.below.assign(size, Real(0));
    s.low.assign(size, Real(0.5));
    s.high.assign(size, Real(0.5));
    if (!grid.active(d)) continue;
    const auto closed = [&](int side) {
      const Boundary& b = boundaries[2 * d + side];
      return b.discs || (b.kind != BoundaryKind::open && b.kind != BoundaryKind::periodic);
    };
    const std::size_t last = static_cast<std::size_t>(n) - 1;
    if (closed(0)) s.low[0] = 0, s.high[0] = 1;
    if (closed(1)) s.low[last] = 1, s.high[last] = 0;
    const std::vector<double>& width = grid.axis(d).width;
    const bool periodic = boundaries[2 * d].kind == BoundaryKind::periodic;
    for (std::size_t i = 0; i <= last + 1; ++i) {
      const bool has_low = i > 0 || periodic, has_high = i <= last || periodic;
      const std::size_t a = i > 0 ? i - 1 : last, b = i <= last ? i : 0;
      const double low = has_low ? double(s.high[a]) * width[a] : 0.0,
                   high = has_high ? double(s.low[b]) * width[b] : 0.0;
      s.below[i] = low + high > 0 ? static_cast<Real>(low / (low + high)) : Real(i > 0);
    }
  }
}

/// q = e (m + h S) / A - c grad p with c = h e^2 / A on the lower D-faces of a row.
template <int D>
void FractionStep::predict_faces(const FluidFraction& f, Real h, ConstFieldView m, ConstFieldView p,
                                 FieldView q, int j, int k) {
  constexpr std::size_t kD = D;
  const Metrics metrics = grid_.metrics(D);
  const std::ptrdiff_t s = stride(p, D);
  const Real *solids = f.solids.view().row(j, k), *drag = f.drag.view().row(j, k),
             *dragging = f.dragging[kD].view().row(j, k), *m_row = m.row(j, k), *p_row = p.row(j, k);
  Real *q_row = q.row(j, k), *c_row = coefficient_[kD].view().row(j, k), *gain = gain_[kD].view().row(j, k);
  const Real* below = shares_[kD].below.data();
  for_each_lane(
      0, grid_.nx() + (D == 0), [=](int i) __attribute__((always_inline)) {
        const int at = D == 0 ? i : D == 1 ? j : k;
        const Real w = below[at], v = Real(1) - w;
        const Real e = fluid_part(w * solids[i - s] + v * solids[i]);
        const Real a = e + h * (w * drag[i - s] + v * drag[i]);
        const Real source = h * (w * dragging[i - s] + v * dragging[i]);
        const Real linear = metrics.weight[at];
        const Real mean = linear * m_row[i - s] + (Real(1) - linear) * m_row[i];
        const Real part = e / a, c = h * e * part;
        c_row[i] = c;
        q_row[i] = part * (mean + source) - c * (p_row[i] - p_row[i - s]) * metrics.inv_distance[at];
        gain[i] = -mean;
      });
}

/// Cells of a row take the mean of what their D-faces gained.
template <int D>
void FractionStep::correct_cells(FluidFraction& f, Real kept, FieldView u, ConstFieldView p, ConstFieldView q,
                                 int j, int k) const {
  constexpr std::size_t kD = D;
  const Metrics metrics = grid_.metrics(D);
  const std::ptrdiff_t s = stride(p, D);
  const Real *solids = f.solids.view().row(j, k), *q_row = q.row(j, k), *p_row = p.row(j, k),
             *gain = gain_[kD].view().row(j, k);
  Real *u_row = u.row(j, k), *seen = f.seen[kD].view().row(j, k), *push = f.push[kD].view().row(j, k);
  const Real *below = shares_[kD].below.data(), *low = shares_[kD].low.data(),
             *high = shares_[kD].high.data();
  for_each_lane(
      0, grid_.nx(), [=](int i) __attribute__((always_inline)) {
        const int at = D == 0 ? i : D == 1 ? j : k;
        const Real wl = below[at], wh = below[at + 1];
        const Real el = fluid_part(wl * solids[i - s] + (Real(1) - wl) * solids[i]),
                   eh = fluid_part(wh * solids[i] + (Real(1) - wh) * solids[i + s]);
        const Real a = low[at], b = high[at];
        u_row[i] =
            (u_row[i] + a * (q_row[i] + gain[i]) + b * (q_row[i + s] + gain[i + s])) / fluid_part(solids[i]);
        seen[i] = kept * seen[i] + Real(0.5) * (a * q_row[i] / el + b * q_row[i + s] / eh);
        push[i] -= Real(0.5) * (a * (p_row[i] - p_row[i - s]) * metrics.inv_distance[at] +
                                b * (p_row[i + s] - p_row[i]) * metrics.inv_distance[at + 1]);
      });
}

/// Faces whose velocity is prescribed, and their coefficient, which is nothing.
void FractionStep::close_faces(const std::array<FieldView, 3>& q) {
  boundaries_.prescribe_face_velocity(q);
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    const BoundaryKind kind = boundaries_.kind(face);
    if (!grid_.active(d) || kind == BoundaryKind::open || kind == BoundaryKind::periodic) continue;
    for_each_face_cell(
        grid_, face, [c = coefficient_[static_cast<std::size_t>(d)].view()](std::size_t, const int(&at)[3]) {
          c(at[0], at[1], at[2]) = 0;
        });
  }
  boundaries_.for_each_prescribed([&](int d, const std::array<int, 3>& f, const BoundaryState&) {
    coefficient_[static_cast<std::size_t>(d)](f[0], f[1], f[2]) = 0;
  });
}

/// 1 / sqrt(h e^2 / A) in the cells of a row
void FractionStep::find_roots(const FluidFraction& f, Real h, int j, int k) {
  for_each_lane(0, grid_.nx(),
                [=, solids = f.solids.view().row(j, k), drag = f.drag.view().row(j, k),
                 out = inverse_root_.view().row(j, k), inv_h = Real(1) / h](int i) {
                  const Real e = fluid_part(solids[i]);
                  out[i] = std::sqrt(e * inv_h + drag[i]) / e;
                });
}

namespace {

/// div q + de/dt over a cell, m3/s
struct Imbalance {
  Outflow through;
  ConstFieldView now, before;
  Real inv_dt;
  EJECTA_KERNEL Real operator()(int i, int j, int k) const {
    const Real volume = through.m[0].volume[i] * through.m[1].volume[j] * through.m[2].volume[k];
    return through(i, j, k) - (now(i, j, k) - before(i, j, k)) * inv_dt * volume;
  }
  /// Squares of what flows through the faces: they tell what the balance of a cell can mean.
  EJECTA_KERNEL Real flow_squared(int i, int j, int k) const {
    const Real x = face_area<0>(through.m, i, j, k) * through.q[0](i, j, k),
               y = face_area<1>(through.m, i, j, k) * through.q[1](i, j, k),
               z = face_area<2>(through.m, i, j, k) * through.q[2](i, j, k);
    return x * x + y * y + z * z;
  }
};

Imbalance imbalance_of(const Grid& grid, const FluidFraction& f, double dt,
                       const std::array<FieldView, 3>& q) {
  return {outflow(grid, {q[0], q[1], q[2]}), f.solids.view(), f.solids_before.view(),
          static_cast<Real>(1 / dt)};
}

}  // namespace

void FractionStep::imbalance(const FluidFraction& f, double dt, const std::array<FieldView, 3>& q,
                             FieldView out) const {
  const Imbalance imbalance = imbalance_of(grid_, f, dt, q);
  for_each_cell(
      grid_.range(), [=](int i, int j, int k)
                         __attribute__((always_inline)) { out(i, j, k) = imbalance(i, j, k); });
}

/// Into rhs_.
FractionStep::Sizes FractionStep::find_imbalance(const FluidFraction& f, double dt,
                                                 const std::array<FieldView, 3>& q) {
  const Imbalance imbalance = imbalance_of(grid_, f, dt, q);
  const FieldView out = rhs_.view();
  std::vector<std::array<double, 2>>& planes = squares_;  // flow, imbalance
  for_each_index(grid_.nz(), [&](int k) {
    std::array<double, 2> plane{};
    for (int j = 0; j < grid_.ny(); ++j) {
      for_each_lane(
          0, grid_.nx(), [=](int i) __attribute__((always_inline)) { out(i, j, k) = imbalance(i, j, k); });
      plane[0] += row_sum(
          0,
          grid_.nx(), [=](int i) __attribute__((always_inline)) { return imbalance.flow_squared(i, j, k); });
      plane[1] += row_sum(
          0, grid_.nx(), [=](int i) __attribute__((always_inline)) {
            return double(out(i, j, k)) * double(out(i, j, k));
          });
    }
    planes[static_cast<std::size_t>(k)] = plane;
  });
  Sizes sums;
  for (const auto& [flow, unbalanced] : planes) sums.flow += flow, sums.imbalance += unbalanced;
  return {std::sqrt(sums.flow), std::sqrt(sums.imbalance)};
}

/// The pressure is taken to change as in this stage of the last step. Where nothing says what it is its level
/// would run away, guess upon guess.
void FractionStep::guess(FieldView change, FieldView p) const {
  const double cells = double(grid_.nx()) * grid_.ny() * grid_.nz();
  const Real level = floats_ ? static_cast<Real>(reduce_sum(grid_.range(), change) / cells) : Real(0);
  for_each_cell(grid_.range(), [=](int i, int j, int k) {
    change(i, j, k) -= level;
    p(i, j, k) += change(i, j, k);
  });
}

/// q -= c grad correction on the lower D-faces of a row
template <int D>
void FractionStep::correct_faces(FieldView q, int j, int k) const {
  constexpr std::size_t kD = D;
  const ConstFieldView correction = correction_.view();
  const std::ptrdiff_t s = stride(correction, D);
  const Real *c = coefficient_[kD].view().row(j, k), *of_row = correction.row(j, k);
  for_each_lane(0, grid_.nx() + (D == 0), [=, to = q.row(j, k), m = grid_.metrics(D)](int i) {
    const int at = D == 0 ? i : D == 1 ? j : k;
    to[i] -= c[i] * (of_row[i] - of_row[i - s]) * m.inv_distance[at];
  });
}

void FractionStep::project(FluidFraction& f, bool first, double h, double dt,
                           const std::array<FieldView, 3>& u, FieldView p,
                           const std::array<FieldView, 3>& q) {
  const Real step = static_cast<Real>(h), kept = first ? Real(0) : Real(1);
  const FieldView change = f.pressure_change[first ? 0 : 1].view();
  guess(change, p);
  for (const FieldView& c : u) boundaries_.fill_zero_gradient(c);
  boundaries_.fill_pressure(p, q, true);
  const auto for_each_row = [&](const auto& x, const auto& y, const auto& z, const auto& cells) {
    for_each_index(grid_.nz() + 1, [&](int k) {
      for (int j = 0; j <= grid_.ny(); ++j) {
        const bool inside_y = j < grid_.ny(), inside_z = k < grid_.nz();
        if (grid_.active(0) && inside_y && inside_z) x(j, k);
        if (grid_.active(1) && inside_z) y(j, k);
        if (grid_.active(2) && inside_y) z(j, k);
        if (inside_y && inside_z) cells(j, k);
      }
    });
  };
  for_each_row([&](int j, int k) { predict_faces<0>(f, step, u[0], p, q[0], j, k); },
               [&](int j, int k) { predict_faces<1>(f, step, u[1], p, q[1], j, k); },
               [&](int j, int k) { predict_faces<2>(f, step, u[2], p, q[2], j, k); },
               [&](int j, int k) { find_roots(f, step, j, k); });
  close_faces(q);
  constexpr double kTolerance = std::max(16 * double(std::numeric_limits<Real>::epsilon()), 1e-10);
  const Sizes sizes = find_imbalance(f, dt, q);
  const FieldView correction = correction_.view();
  iterations_ = poisson_.solve({coefficient_[0].view(), coefficient_[1].view(), coefficient_[2].view()},
                               inverse_root_.view(), rhs_.view(), sizes.imbalance, kTolerance * sizes.flow, q,
                               correction);
  boundaries_.fill_pressure(correction, q, false);
  for_each_row([&](int j, int k) { correct_faces<0>(q[0], j, k); },
               [&](int j, int k) { correct_faces<1>(q[1], j, k); },
               [&](int j, int k) { correct_faces<2>(q[2], j, k); },
               [&](int j, int k) {
                 for_each_lane(
                     0, grid_.nx(),
                     [to = p.row(j, k), all = change.row(j, k), more = correction.row(j, k)](int i) {
                       to[i] += more[i];
                       all[i] += more[i];
                     });
               });
  boundaries_.prescribe_face_velocity(q);
  boundaries_.fill_pressure(p, q, true);
  for_each_index(grid_.nz(), [&](int k) {
    for (int j = 0; j < grid_.ny(); ++j) {
      if (grid_.active(0)) correct_cells<0>(f, kept, u[0], p, q[0], j, k);
      if (grid_.active(1)) correct_cells<1>(f, kept, u[1], p, q[1], j, k);
      if (grid_.active(2)) correct_cells<2>(f, kept, u[2], p, q[2], j, k);
    }
  });
  // Along an axis of one cell there are no faces.
  for (std::size_t d = 0; d < 3; ++d) {
    if (grid_.active(int(d))) continue;
    for_each_cell(
        grid_.range(), [=, to = u[d], seen = f.seen[d].view(), solids = f.solids.view(), drag = f.drag.view(),
                        dragging = f.dragging[d].view()](int i, int j, int k) {
          const Real v =
              (to(i, j, k) + step * dragging(i, j, k)) / (fluid_part(solids(i, j, k)) + step * drag(i, j, k));
          to(i, j, k) = v;
          seen(i, j, k) = kept * seen(i, j, k) + Real(0.5) * v;
        });
  }
}

}  // namespace ejecta
