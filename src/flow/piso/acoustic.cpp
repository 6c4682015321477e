#include "flow/piso/acoustic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "flow/cut_geometry.hpp"
#include "flow/piso/cut_flow.hpp"
#include "flow/stencil.hpp"
#include "grid/faces.hpp"

namespace ejecta::gas {
namespace {

/// The residual left over, of the first one without any change of pressure. It is not lost: mass, momentum
/// and energy are kept whatever it is, and the next step finds it in the pressure. In steps that are long
/// against sound it must be small: long waves of what is left grow from step to step (still gas of 1 mm/s
/// came to 0.3 m/s at 1e-3).
constexpr double kTolerance = 1e-5;
/// What is below the last digit of the flow through a cell is no residual: a steady flow would iterate on it.
constexpr double kNoise = 4.0 * std::numeric_limits<Real>::epsilon();
constexpr int kMostIterations = 200;

template <class T>
using Axes = std::array<T, 3>;

Real face_area_along(int d, const Metrics (&m)[3], const int (&at)[3]) {
  return d == 0   ? face_area<0>(m, at[0], at[1], at[2])
         : d == 1 ? face_area<1>(m, at[0], at[1], at[2])
                  : face_area<2>(m, at[0], at[1], at[2]);
}

/// Velocity of a face before the change of pressure, and the flow through it that a unit of change drives.
template <int D>
struct FaceKernel {
  BlockView<const Real> middle;
  FieldView velocity, conductance;
  Metrics metrics[3];
  Real dt;
  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = middle.offset(i, j, k), s = stride(velocity, D);
    const Metrics& m = metrics[D];
    const int at = D == 0 ? i : D == 1 ? j : k;
    const Real *u = middle.origin[kU + D] + o, *rho = middle.origin[kRho] + o, *p = middle.origin[kP] + o;
    const Real above = 1 - m.weight[at];
    const Real push = dt * m.inv_distance[at] / (rho[-s] + above * (rho[0] - rho[-s]));
    velocity.origin[o] = u[-s] + above * (u[0] - u[-s]) - Real(0.5) * push * (p[0] - p[-s]);
    conductance.origin[o] = push * face_area<D>(metrics, i, j, k);
  }
};

/// Flow out of a cell, m3/s, and the diagonal of the equation of its change of pressure.
struct CellKernel {
  Axes<FieldView> velocity, conductance;
  BlockView<const Real> middle;
  FieldView rhs, diagonal;
  GasConstants gas;
  Metrics metrics[3];
  Axes<bool> active;
  Real dt;
  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = middle.offset(i, j, k);
    const Real volume = metrics[0].volume[i] * metrics[1].volume[j] * metrics[2].volume[k];
    const Real stiffness = gas.stiffness(middle.at(kP, o));
    Real out = 0, sum = volume / (dt * stiffness);
    if (active[0]) {
      const Real* q = velocity[0].origin + o;
      out += face_area<0>(metrics, i + 1, j, k) * q[1] - face_area<0>(metrics, i, j, k) * q[0];
      sum += conductance[0].origin[o] + conductance[0].origin[o + 1];
    }
    if (active[1]) {
      const Real* q = velocity[1].origin + o;
      out += face_area<1>(metrics, i, j, k) * (q[middle.sy] - q[0]);
      sum += conductance[1].origin[o] + conductance[1].origin[o + middle.sy];
    }
    if (active[2]) {
      const Real* q = velocity[2].origin + o;
      out += face_area<2>(metrics, i, j, k) * (q[middle.sz] - q[0]);
      sum += conductance[2].origin[o] + conductance[2].origin[o + middle.sz];
    }
    rhs.origin[o] = -out;
    diagonal.origin[o] = sum;
  }
};

/// The equation's matrix times x.
struct Matrix {
  Axes<ConstFieldView> conductance;
  ConstFieldView diagonal;
  Axes<bool> active;
  EJECTA_KERNEL Real times(const Real* x, int i, int j, int k) const {
    const std::ptrdiff_t o = i + j * diagonal.sy + k * diagonal.sz, sy = diagonal.sy, sz = diagonal.sz;
    Real y = diagonal.origin[o] * x[o];
    if (active[0]) y -= conductance[0].origin[o] * x[o - 1] + conductance[0].origin[o + 1] * x[o + 1];
    if (active[1]) y -= conductance[1].origin[o] * x[o - sy] + conductance[1].origin[o + sy] * x[o + sy];
    if (active[2]) y -= conductance[2].origin[o] * x[o - sz] + conductance[2].origin[o + sz] * x[o + sz];
    return y;
  }
};

}  // namespace

Acoustic::Acoustic(const Grid& grid, const GasConstants& gas)
    : grid_(grid), gas_(gas), metrics_{grid.metrics(0), grid.metrics(1), grid.metrics(2)} {
  for (auto* fields : {&velocity_, &conductance_})
    for (Field& f : *fields) f = grid.make_field();
  for (Field* f : {&diagonal_, &change_, &residual_, &search_, &product_}) *f = grid.make_field();
  for (int face = 0; face < 6; ++face)
    admittance_[static_cast<std::size_t>(face)].assign(
        static_cast<std::size_t>(grid.cells() / grid.n(face / 2)), Real(0));
}

void Acoustic::measure_faces(const Block& middle, Real dt) {
  const auto w = view_block<const Real>(middle);
  const auto sweep = [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    if (grid_.active(d))
      for_each_cell(
          faces_along(grid_, d),
          FaceKernel<d>{
              w, velocity_[d].view(), conductance_[d].view(), {metrics_[0], metrics_[1], metrics_[2]}, dt});
  };
  sweep(std::integral_constant<int, 0>{});
  sweep(std::integral_constant<int, 1>{});
  sweep(std::integral_constant<int, 2>{});
}

/// Faces half closed are passed in the middle of their open part.
void Acoustic::move_to_open(const CutCells& cut, const Block& middle) {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    const std::array<int, 3> face{f.i, f.j, f.k};
    const std::size_t d = static_cast<std::size_t>(f.d);
    if (face[d] > 0 && face[d] < grid_.n(f.d))
      velocity_[d](f.i, f.j, f.k) += CutFlow::to_middle_of_open(grid_, cut, f.d, face, middle[kU + d].view());
  });
}

/// velocity_ becomes the volume flow over the whole area of a face, the solid's through the closed part, and
/// conductance_ that of the open part.
void Acoustic::close_faces(const CutCells& cut) {
  open_.resize(cut.faces.size());
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    Real& q = velocity_[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
    Real& conductance = conductance_[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
    open_[static_cast<std::size_t>(n)] = {q, conductance};
    q += f.closed * (f.velocity - q);
    conductance *= 1 - f.closed;
  });
}

void Acoustic::reopen_faces(const CutCells& cut) {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    const OpenFace& open = open_[static_cast<std::size_t>(n)];
    const bool closed = f.closed >= Real(1);
    velocity_[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = closed ? f.velocity : open.velocity;
    conductance_[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = closed ? Real(0) : open.conductance;
  });
}

/// Only the fluid of a cell is compressed; in solids nothing is, and what their faces carry is round-off.
void Acoustic::leave_to_fluid(const CutCells& cut, const Block& middle, Real dt) {
  const ConstFieldView p = middle[kP].view();
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier < 0) {
      residual_(c.i, c.j, c.k) = 0;
      return;
    }
    const Real stiffness = gas_.stiffness(p(c.i, c.j, c.k));
    Real sum = c.fluid * static_cast<Real>(grid_.volume(c.i, c.j, c.k)) / (dt * stiffness);
    for (int d = 0; d < 3; ++d) {
      if (!grid_.active(d)) continue;
      const Real* lower = &conductance_[static_cast<std::size_t>(d)](c.i, c.j, c.k);
      sum += lower[0] + lower[stride(p, d)];
    }
    diagonal_(c.i, c.j, c.k) = sum;
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    if (cut.index(g.i, g.j, g.k) < 0) residual_(g.i, g.j, g.k) = 0;
  });
}

template <class Visit>
void Acoustic::for_each_boundary_cell(const Boundaries& boundaries, const Visit& visit) const {
  const ConstFieldView v = diagonal_.view();
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    if (!grid_.active(d) || boundaries.is_periodic(d)) continue;
    const std::ptrdiff_t s = stride(v, d);
    for_each_face_cell(grid_, face, [&](std::size_t cell, const int(&at)[3]) {
      const std::ptrdiff_t o = at[0] + at[1] * v.sy + at[2] * v.sz;
      visit(BoundaryCell{boundaries.at(face, cell).type, static_cast<std::size_t>(face), cell, d,
                         face % 2 ? Real(1) : Real(-1), face_area_along(d, metrics_, at),
                         metrics_[d].inv_width[face % 2 ? at[d] - 1 : at[d]], o, face % 2 ? o - s : o,
                         face % 2 ? o : o - s, s});
    });
  }
}

/// By how much the pressure on a face exceeds that of the cell inside when the wave that leaves, p + rho c u,
/// is continued to the face along a parabola and the one that enters is not. A straight line would excite the
/// saw tooth that a central scheme knows beside its wave, and that comes back as one.
Real Acoustic::leaving(const BlockView<const Real>& w, const BoundaryCell& b, Real impedance) {
  const std::ptrdiff_t inward = -std::ptrdiff_t(b.outward) * b.stride;
  const auto rise = [&](int c) {
    return 2 * w.at(c, b.inside) - 3 * w.at(c, b.inside + inward) + w.at(c, b.inside + 2 * inward);
  };
  return Real(0.25) * (rise(kP) + b.outward * impedance * rise(kU + b.axis));
}

void Acoustic::open_boundaries(const Boundaries& boundaries, const Block& middle, Real since) {
  const auto w = view_block<const Real>(middle);
  for_each_boundary_cell(boundaries, [&](const BoundaryCell& b) {
    const Real u = w.at(kU + b.axis, b.inside), beyond = w.at(kU + b.axis, b.ghost);
    Real& q = velocity_[b.axis].view().origin[b.at];
    Real& conductance = conductance_[b.axis].view().origin[b.at];
    const Real rho = w.at(kRho, b.inside);
    const Real sound = 1 / (rho * std::sqrt(gas_.sound_speed_squared(rho, w.at(kP, b.inside))));  // 1/(rho c)
    Real& admittance = admittance_[b.face][b.cell];
    admittance = 0;
    switch (b.type) {
      case BoundaryType::pressure_outlet:
      case BoundaryType::free_stream:
        admittance = conductance;  // q is that of an inner face whose far side keeps its pressure
        break;
      case BoundaryType::wave_transmissive: {
        // Of a wave that leaves, rho c (q - u) = F dp, F = (1 - b/2)/sqrt(1 - b/2 + b^2/2) = 1/2 + 5/8 (1 -
        // b)
        // + ..., b one step back. The anchor counts by half: the far side of this cell answers it as well.
        const Real before = since * change_.view().origin[b.inside];
        q = u + b.outward * sound *
                    (Real(0.25) * (w.at(kP, b.inside) - w.at(kP, b.ghost)) + leaving(w, b, 1 / sound) -
                     Real(0.625) * before);
        admittance = Real(1.125) * sound * b.area;
        break;
      }
      case BoundaryType::total_pressure:
        q = u == -beyond ? Real(0) : beyond;
        admittance = u == -beyond ? Real(0) : sound * b.area;
        break;
      case BoundaryType::velocity:
      case BoundaryType::jet:
        q = beyond;
        break;
      default:
        q = 0;
    }
    conductance = 0;
  });
}

void Acoustic::measure_cells(const Block& middle, Real dt) {
  for_each_cell(grid_.range(),
                CellKernel{{velocity_[0].view(), velocity_[1].view(), velocity_[2].view()},
                           {conductance_[0].view(), conductance_[1].view(), conductance_[2].view()},
                           view_block<const Real>(middle),
                           residual_.view(),
                           diagonal_.view(),
                           gas_,
                           {metrics_[0], metrics_[1], metrics_[2]},
                           {grid_.active(0), grid_.active(1), grid_.active(2)},
                           dt});
}

/// Small cells are one with their carrier in the equation: sums over cells are folded, and they share its
/// change.
void Acoustic::share(const CutCells& cut, FieldView f) const {
  for_each_small(cut, [f](const CutCell& c, const CutCell& carrier) {
    f(c.i, c.j, c.k) = f(carrier.i, carrier.j, carrier.k);
  });
}

void Acoustic::conjugate_gradients(const Boundaries& boundaries, const CutCells& cut, double enough) {
  const Matrix matrix{{conductance_[0].view(), conductance_[1].view(), conductance_[2].view()},
                      diagonal_.view(),
                      {grid_.active(0), grid_.active(1), grid_.active(2)}};
  const Range3 cells = grid_.range();
  const FieldView x = change_.view(), r = residual_.view(), s = search_.view(), y = product_.view();
  const ConstFieldView d = diagonal_.view();
  share(cut, x);
  boundaries.extend(change_);
  for_each_cell(
      cells, [=](int i, int j, int k)
                 __attribute__((always_inline)) { r(i, j, k) -= matrix.times(x.origin, i, j, k); });
  CutFlow::fold(cut, r);
  double norm = reduce_sum(
      cells, [=](int i, int j, int k) __attribute__((always_inline)) {
        const Real left = r(i, j, k);
        s(i, j, k) = left / d(i, j, k);
        return left * left / d(i, j, k);
      });
  for (iterations_ = 0; norm > enough && iterations_ < kMostIterations; ++iterations_) {
    share(cut, s);
    boundaries.extend(search_);
    const double along = reduce_sum(
        cells, [=](int i, int j, int k) __attribute__((always_inline)) {
          const Real value = matrix.times(s.origin, i, j, k);
          y(i, j, k) = value;
          return value * s(i, j, k);
        });
    CutFlow::fold(cut, y);
    const Real step = Real(norm / along);
    const double next = reduce_sum(
        cells, [=](int i, int j, int k) __attribute__((always_inline)) {
          x(i, j, k) += step * s(i, j, k);
          const Real left = r(i, j, k) - step * y(i, j, k);
          r(i, j, k) = left;
          return left * left / d(i, j, k);
        });
    const Real turn = Real(next / norm);
    norm = next;
    for_each_cell(
        cells, [=](int i, int j, int k) __attribute__((always_inline)) {
          s(i, j, k) = r(i, j, k) / d(i, j, k) + turn * s(i, j, k);
        });
  }
  boundaries.extend(change_);
}

/// Sum of the square of what flows through the lower faces of a cell over the diagonal, as of the residual.
double Acoustic::square_of_flow() const {
  const Axes<bool> active{grid_.active(0), grid_.active(1), grid_.active(2)};
  const Metrics m[3]{metrics_[0], metrics_[1], metrics_[2]};
  const Axes<ConstFieldView> q{velocity_[0].view(), velocity_[1].view(), velocity_[2].view()};
  return reduce_sum(
      grid_.range(), [ =, d = diagonal_.view() ](int i, int j, int k) __attribute__((always_inline)) {
        Real flow = 0;
        if (active[0]) flow += face_area<0>(m, i, j, k) * std::abs(q[0](i, j, k));
        if (active[1]) flow += face_area<1>(m, i, j, k) * std::abs(q[1](i, j, k));
        if (active[2]) flow += face_area<2>(m, i, j, k) * std::abs(q[2](i, j, k));
        return flow * flow / d(i, j, k);
      });
}

void Acoustic::correct_faces() {
  const ConstFieldView x = change_.view();
  const auto sweep = [&](auto direction) {
    constexpr int d = decltype(direction)::value;
    if (!grid_.active(d)) return;
    const FieldView q = velocity_[d].view();
    const ConstFieldView c = conductance_[d].view();
    const std::ptrdiff_t s = stride(q, d);
    const Metrics metrics[3]{metrics_[0], metrics_[1], metrics_[2]};
    for_each_cell(
        faces_along(grid_, d), [=](int i, int j, int k) __attribute__((always_inline)) {
          const std::ptrdiff_t o = i + j * q.sy + k * q.sz;
          const Real size = face_area<d>(metrics, i, j, k);
          const Real flow = c.origin[o] * (x.origin[o] - x.origin[o - s]);
          q.origin[o] -= size > 0 ? flow / size : Real(0);
        });
  };
  sweep(std::integral_constant<int, 0>{});
  sweep(std::integral_constant<int, 1>{});
  sweep(std::integral_constant<int, 2>{});
}

void Acoustic::solve(const Boundaries& boundaries, const Block& middle, double dt, const CutCells& cut,
                     const GasGrains* grains) {
  measure_faces(middle, Real(dt));
  move_to_open(cut, middle);
  if (grains) grains->drag_faces(middle, velocity_, conductance_);
  open_boundaries(boundaries, middle, Real(last_dt_ > 0.0 ? dt / last_dt_ : 0.0));
  last_dt_ = dt;
  close_faces(cut);
  if (grains) grains->narrow_faces(velocity_, conductance_);
  const auto open = [&](const BoundaryCell& b) {
    if (grains) return grains->open(b.axis, b.at);
    return cut.empty() ? Real(1) : 1 - cut.closed[static_cast<std::size_t>(b.axis)].view().origin[b.at];
  };
  measure_cells(middle, Real(dt));
  leave_to_fluid(cut, middle, Real(dt));
  if (grains) grains->leave_to_gas(middle, residual_, diagonal_);
  CutFlow::fold(cut, residual_.view());
  const double first =
      reduce_sum(grid_.range(), [r = residual_.view(), d = diagonal_.view()](int i, int j, int k) {
        return r(i, j, k) * r(i, j, k) / d(i, j, k);
      });
  const double enough = std::max(kTolerance * kTolerance * first, kNoise * kNoise * square_of_flow());
  for_each_boundary_cell(boundaries, [&](const BoundaryCell& b) {
    diagonal_.view().origin[b.inside] += open(b) * admittance_[b.face][b.cell];
  });
  conjugate_gradients(boundaries, cut, enough);
  reopen_faces(cut);
  if (grains) grains->widen_faces(velocity_, conductance_);
  correct_faces();
  for_each_boundary_cell(boundaries, [&](const BoundaryCell& b) {
    const Real admittance = open(b) > 0 ? admittance_[b.face][b.cell] : Real(0);
    if (admittance == 0) return;
    velocity_[b.axis].view().origin[b.at] +=
        b.outward * admittance / b.area * change_.view().origin[b.inside];
    if (b.type == BoundaryType::pressure_outlet || b.type == BoundaryType::free_stream)
      change_.view().origin[b.ghost] = 0;
  });
}

void Acoustic::let_waves_out(const Boundaries& boundaries, Block& middle) const {
  const auto w = view_block<const Real>(middle);
  Real* pressure = middle[kP].view().origin;
  for_each_boundary_cell(boundaries, [&](const BoundaryCell& b) {
    if (b.type != BoundaryType::wave_transmissive) return;
    const Real rho = w.at(kRho, b.inside);
    const Real c = std::sqrt(gas_.sound_speed_squared(rho, w.at(kP, b.inside)));
    const Real anchor = Real(0.25) * (w.at(kP, b.inside) - w.at(kP, b.ghost));
    // The velocity inside saw the ghost's pressure for half a step; what the face has beyond it slows the
    // velocity, and with it what leaves: explicit, that would grow from Courant number 8 of the sound on.
    const Real answer = Real(0.25) * Real(last_dt_) * c * b.inv_width;
    pressure[b.ghost] += 2 * (anchor + leaving(w, b, rho * c)) / (1 + answer);
  });
}

}  // namespace ejecta::gas
