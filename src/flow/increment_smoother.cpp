#include "flow/increment_smoother.hpp"

#include <algorithm>

#include "base/simd.hpp"
#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// Rows of a plane that the sweep along z takes together: side by side in memory, as the prefetcher likes
/// them, and few enough to stay in cache from the way up to the way down.
constexpr int kRowsTogether = 8;

}  // namespace

IncrementSmoother::IncrementSmoother(const Grid& grid)
    : nx_(grid.nx()),
      ny_(grid.ny()),
      nz_(grid.nz()),
      active_{grid.active(0), grid.active(1), grid.active(2)} {
  for (int d = 0; d < 3; ++d) {
    operator_[static_cast<std::size_t>(d)] =
        operator_1d(grid, d, PoissonBoundary::neumann, PoissonBoundary::neumann);
    Factors& f = factors_[static_cast<std::size_t>(d)];
    for (auto* v : {&f.inverse, &f.below, &f.above}) v->resize(static_cast<std::size_t>(grid.n(d)));
  }
}

void IncrementSmoother::list_lines(const CutCells& cut) {
  const std::array<int, 3> n{nx_, ny_, nz_};
  for (std::size_t d = 0; d < 3; ++d) {
    const int na = n[d == 0 ? 1 : 0], nb = n[d == 2 ? 1 : 2];
    lines_[d].clear();
    first_line_[d].assign(static_cast<std::size_t>(nb) + 1, 0);
    if (!active_[d] || cut.empty()) continue;
    marked_.assign(static_cast<std::size_t>(na) * static_cast<std::size_t>(nb), 0);
    const auto mark = [&](int i, int j, int k) {
      const int a = d == 0 ? j : i, b = d == 2 ? j : k;
      marked_[static_cast<std::size_t>(b) * static_cast<std::size_t>(na) + static_cast<std::size_t>(a)] = 1;
    };
    for (const CutCell& c : cut.cells) mark(c.i, c.j, c.k);
    for (const GhostCell& g : cut.ghosts) mark(g.i, g.j, g.k);
    for (int b = 0; b < nb; ++b) {
      for (int a = 0; a < na; ++a)
        if (marked_[static_cast<std::size_t>(b) * static_cast<std::size_t>(na) + static_cast<std::size_t>(a)])
          lines_[d].push_back({a, b});
      first_line_[d][static_cast<std::size_t>(b) + 1] = static_cast<int>(lines_[d].size());
    }
  }
}

/// (m - nu dt D) delta = m r along one line, m the fluid of the cells, by the Thomas algorithm; 0 in solids.
void IncrementSmoother::solve_line(int axis, Line line, Real* values) const {
  const std::size_t d = static_cast<std::size_t>(axis);
  const Operator1D& op = operator_[d];
  const int n = static_cast<int>(op.volume.size());
  const int i0 = d == 0 ? 0 : line.a, j0 = d == 0 ? line.a : d == 1 ? 0 : line.b, k0 = d == 2 ? 0 : line.b;
  const std::ptrdiff_t step = d == 0 ? 1 : d == 1 ? carried_.sy : carried_.sz;
  const Real *carried = &carried_(i0, j0, k0), *closed = &closed_[d](i0, j0, k0);
  Real* above = thread_scratch(static_cast<std::size_t>(n), 3);
  const Real c = static_cast<Real>(nu_dt_);
  const auto coupling = [&](int at) {  // through the lower face of cell `at`
    if (at <= 0 || at >= n) return Real(0);
    if (carried[at * step] <= Real(0) || carried[(at - 1) * step] <= Real(0)) return Real(0);
    return c * static_cast<Real>(op.coupling[static_cast<std::size_t>(at)]) * (Real(1) - closed[at * step]);
  };
  Real before = 0, factor = 0, low = 0;
  for (int m = 0; m < n; ++m) {
    const Real mass = carried[m * step] * static_cast<Real>(op.volume[static_cast<std::size_t>(m)]);
    const Real up = coupling(m + 1);
    if (mass <= Real(0)) {
      values[m] = before = factor = above[m] = 0;
    } else {
      const Real inverse = Real(1) / (mass + low + up - low * factor);
      values[m] = before = (mass * values[m] + low * before) * inverse;
      above[m] = factor = up * inverse;
    }
    low = up;
  }
  for (int m = n - 2; m >= 0; --m) values[m] += above[m] * values[m + 1];
}

template <class Smooth>
void IncrementSmoother::with_cut_lines(FieldView delta, int axis, int first, int last, const Base* base,
                                       const Smooth& smooth) const {
  const std::size_t d = static_cast<std::size_t>(axis);
  const int begin = first_line_[d][static_cast<std::size_t>(first)],
            end = first_line_[d][static_cast<std::size_t>(last)];
  if (begin == end) return smooth();
  const int n = static_cast<int>(operator_[d].volume.size());
  const std::ptrdiff_t step = d == 0 ? 1 : d == 1 ? delta.sy : delta.sz;
  const auto offset = [&](const Line& l) {
    return d == 0 ? l.a * delta.sy + l.b * delta.sz : d == 1 ? l.a + l.b * delta.sz : l.a + l.b * delta.sy;
  };
  Real* kept = thread_scratch(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(n), 2);
  for (int l = begin; l < end; ++l) {
    const Real* from = delta.origin + offset(lines_[d][static_cast<std::size_t>(l)]);
    for (int m = 0; m < n; ++m) kept[(l - begin) * n + m] = from[m * step];
  }
  smooth();
  for (int l = begin; l < end; ++l) {
    const Line line = lines_[d][static_cast<std::size_t>(l)];
    Real* values = kept + (l - begin) * n;
    solve_line(axis, line, values);
    const std::ptrdiff_t at = offset(line);
    for (int m = 0; m < n; ++m) {
      Real sum = values[m];
      if (base) {
        Real before = base->b * base->two.origin[at + m * step];
        if (base->a != Real(0)) before += base->a * base->one.origin[at + m * step];
        sum = base->positive ? positive_sum(before, sum) : before + sum;
      }
      delta.origin[at + m * step] = sum;
    }
  }
}

void IncrementSmoother::prepare(double nu_dt, const CutCells& cut, ConstFieldView carried) {
  nu_dt_ = nu_dt;
  carried_ = carried;
  for (std::size_t d = 0; d < 3; ++d) closed_[d] = cut.closed[d].view();
  list_lines(cut);
  for (std::size_t d = 0; d < 3; ++d) {
    const Operator1D& op = operator_[d];
    Factors& f = factors_[d];
    double above = 0.0;  // upper coefficient of the row before over its pivot
    for (std::size_t i = 0; i < op.volume.size(); ++i) {
      const double low = nu_dt * op.coupling[i] / op.volume[i],
                   up = nu_dt * op.coupling[i + 1] / op.volume[i];
      const double inverse = 1.0 / (1.0 + low + up + low * above);
      above = -up * inverse;
      f.inverse[i] = static_cast<Real>(inverse);
      f.below[i] = static_cast<Real>(-low * inverse);
      f.above[i] = static_cast<Real>(above);
    }
  }
}

/// Along x the recurrence runs over the registers of kRegisterLanes rows at once, transposed there and back.
/// Rows [first, last) are counted plane by plane.
void IncrementSmoother::smooth_x(FieldView delta, int first, int last) const {
  const int width = (nx_ + kRegisterLanes - 1) / kRegisterLanes * kRegisterLanes;
  Register* column =
      reinterpret_cast<Register*>(thread_scratch(static_cast<std::size_t>(width * kRegisterLanes)));
  const Factors& f = factors_[0];
  const auto row = [&](int n) { return delta.row(n % ny_, n / ny_); };
  for (int n0 = first; n0 < last; n0 += kRegisterLanes) {
    const int rows = std::min(kRegisterLanes, last - n0);
    Register tile[kRegisterLanes];
    for (int i0 = 0; i0 < width; i0 += kRegisterLanes) {
      for (int n = 0; n < kRegisterLanes; ++n)
        tile[n] = *reinterpret_cast<const Register*>(row(n0 + std::min(n, rows - 1)) + i0);
      transpose(tile);
      std::copy_n(tile, kRegisterLanes, column + i0);
    }
    Register s = column[0] * f.inverse[0];
    column[0] = s;
    for (int i = 1; i < nx_; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      s = column[i] * f.inverse[at] - f.below[at] * s;
      column[i] = s;
    }
    for (int i = nx_ - 2; i >= 0; --i) {
      s = column[i] - f.above[static_cast<std::size_t>(i)] * s;
      column[i] = s;
    }
    for (int i0 = 0; i0 < width; i0 += kRegisterLanes) {
      std::copy_n(column + i0, kRegisterLanes, tile);
      transpose(tile);
      for (int n = 0; n < rows; ++n) *reinterpret_cast<Register*>(row(n0 + n) + i0) = tile[n];
    }
  }
}

void IncrementSmoother::smooth_y(FieldView delta, int k) const {
  const Factors& f = factors_[1];
  for (int j = 0; j < ny_; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    const Real inverse = f.inverse[at], below = f.below[at];  // below is 0 in the first row
    for_each_lane(0, nx_, [=, row = delta.row(j, k), before = delta.row(std::max(j - 1, 0), k)](int i) {
      row[i] = row[i] * inverse - below * before[i];
    });
  }
  for (int j = ny_ - 2; j >= 0; --j)
    for_each_lane(0, nx_,
                  [above = f.above[static_cast<std::size_t>(j)], row = delta.row(j, k),
                   after = delta.row(j + 1, k)](int i) { row[i] -= above * after[i]; });
}

void IncrementSmoother::smooth_z_and_add(FieldView delta, int j0, int j1, const Base& base) const {
  const Factors& f = factors_[2];
  for (int k = 0; active_[2] && k < nz_; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const Real inverse = f.inverse[at], below = f.below[at];
    for (int j = j0; j < j1; ++j)
      for_each_lane(0, nx_, [=, row = delta.row(j, k), before = delta.row(j, std::max(k - 1, 0))](int i) {
        row[i] = row[i] * inverse - below * before[i];
      });
  }
  // Backward; a row is added to its base as soon as the row below no longer needs it.
  for (int k = nz_ - 1; k >= 0; --k)
    for (int j = j0; j < j1; ++j) {
      Real* row = delta.row(j, k);
      const Real* two = base.two.row(j, k);
      const Real* one = base.a == Real(0) ? two : base.one.row(j, k);  // not needed: not fetched either
      const Real a = base.a, b = base.b;
      if (k > 0 && active_[2])
        for_each_lane(0, nx_,
                      [row, above = f.above[static_cast<std::size_t>(k - 1)],
                       below = delta.row(j, k - 1)](int i) { below[i] -= above * row[i]; });
      if (base.positive)
        for_each_lane(0, nx_, [=](int i) { row[i] = positive_sum(a * one[i] + b * two[i], row[i]); });
      else for_each_lane(0, nx_, [=](int i) { row[i] += a * one[i] + b * two[i]; });
    }
}

void IncrementSmoother::apply(FieldView delta, const Base& base) const {
  // Plane by plane, or as many of them at once as fill registers with rows
  const int together = ny_ > 1 ? 1 : kRegisterLanes;
  for_each_index((nz_ + together - 1) / together, [&](int n) {
    const int k0 = n * together, k1 = std::min(k0 + together, nz_);
    if (active_[1]) with_cut_lines(delta, 1, k0, k1, nullptr, [&] { smooth_y(delta, k0); });
    if (active_[0]) with_cut_lines(delta, 0, k0, k1, nullptr, [&] { smooth_x(delta, k0 * ny_, k1 * ny_); });
  });
  for_each_index((ny_ + kRowsTogether - 1) / kRowsTogether, [&](int n) {
    const int j0 = n * kRowsTogether, j1 = std::min(j0 + kRowsTogether, ny_);
    with_cut_lines(delta, 2, j0, j1, &base, [&] { smooth_z_and_add(delta, j0, j1, base); });
  });
}

}  // namespace ejecta
