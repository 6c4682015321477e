#include "flow/increment_smoother.hpp"

#include <algorithm>

#include "base/simd.hpp"
#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// Rows of a plane that the sweep along z takes together: side by side in memory, as the prefetcher likes
/// them, and few enough to stay in cache from the way up to the way down.
constexpr int kRowsTogether = 8;

/// Asks for a row that comes soon: from plane to plane the prefetcher does not follow.
void fetch(const Real* row, int nx) {
  for (int i = 0; i < nx; i += kRealLanes) __builtin_prefetch(row + i);
}

}  // namespace

IncrementSmoother::IncrementSmoother(const Grid& grid)
    : nx_(grid.nx()),
      ny_(grid.ny()),
      nz_(grid.nz()),
      active_{grid.active(0), grid.active(1), grid.active(2)},
      // Plane by plane, or as many of them at once as fill registers with rows
      planes_together_(ny_ > 1 ? 1 : kRegisterLanes),
      row_blocks_((planes_together_ * ny_ + kRegisterLanes - 1) / kRegisterLanes),
      cell_blocks_((nx_ + kRealLanes - 1) / kRealLanes) {
  for (int d = 0; d < 3; ++d) {
    operator_[static_cast<std::size_t>(d)] =
        operator_1d(grid, d, PoissonBoundary::neumann, PoissonBoundary::neumann);
    Factors& f = factors_[static_cast<std::size_t>(d)];
    for (auto* v : {&f.inverse, &f.below, &f.above}) v->resize(static_cast<std::size_t>(grid.n(d)));
  }
}

int IncrementSmoother::block_of(int axis, int i, int j, int k) const {
  if (axis == 0)
    return k / planes_together_ * row_blocks_ + (k % planes_together_ * ny_ + j) / kRegisterLanes;
  return (axis == 1 ? k : j) * cell_blocks_ + i / kRealLanes;
}

void IncrementSmoother::list_blocks(const CutCells& cut) {
  for (int d = 0; d < 3; ++d) {
    CutBlocks& blocks = cut_[static_cast<std::size_t>(d)];
    const int count = block_of(d, nx_ - 1, ny_ - 1, nz_ - 1) + 1;
    blocks.number.assign(static_cast<std::size_t>(count), -1);
    blocks.block.clear();
    if (!active_[static_cast<std::size_t>(d)]) continue;
    const auto mark = [&](int i, int j, int k) {
      blocks.number[static_cast<std::size_t>(block_of(d, i, j, k))] = 0;
    };
    for (const CutCell& c : cut.cells) mark(c.i, c.j, c.k);
    for (const GhostCell& g : cut.ghosts) mark(g.i, g.j, g.k);
    for (int b = 0; b < count; ++b)
      if (int& number = blocks.number[static_cast<std::size_t>(b)]; number == 0) {
        number = static_cast<int>(blocks.block.size());
        blocks.block.push_back(b);
      }
  }
}

/// Of (m - nu dt D) s = m r along each line, m the fluid of the cells, by the Thomas algorithm; s = 0 in
/// solids.
template <int kAxis>
void IncrementSmoother::factorise(int number, ConstFieldView carried, ConstFieldView closed) {
  constexpr int kLanes = kAxis == 0 ? kRegisterLanes : kRealLanes;
  const Operator1D& op = operator_[kAxis];
  CutBlocks& blocks = cut_[kAxis];
  const int block = blocks.block[static_cast<std::size_t>(number)];
  std::ptrdiff_t start[kLanes];  // of each line; of the rows that a block lacks the last one again
  for (int lane = 0; lane < kLanes; ++lane) {
    const int piece = block / row_blocks_, first = piece * planes_together_;
    const int rows = std::min(planes_together_, nz_ - first) * ny_;
    const int row = std::min(block % row_blocks_ * kLanes + lane, rows - 1);
    start[lane] = kAxis == 0 ? row % ny_ * carried.sy + (first + row / ny_) * carried.sz
                             : block % cell_blocks_ * kLanes + lane +
                                   block / cell_blocks_ * (kAxis == 1 ? carried.sz : carried.sy);
  }
  const int n = static_cast<int>(op.volume.size());
  const std::ptrdiff_t step = kAxis == 0 ? 1 : kAxis == 1 ? carried.sy : carried.sz;
  const std::size_t from = static_cast<std::size_t>(number) * static_cast<std::size_t>(n * kLanes);
  Real *scale = blocks.scale.data() + from, *carry = blocks.carry.data() + from,
       *above = blocks.above.data() + from;
  Real low[kLanes] = {}, factor[kLanes] = {};
  for (int m = 0; m < n; ++m, scale += kLanes, carry += kLanes, above += kLanes) {
    const Real volume = static_cast<Real>(op.volume[static_cast<std::size_t>(m)]);
    const Real coupling = static_cast<Real>(nu_dt_ * op.coupling[static_cast<std::size_t>(m) + 1]);
    const int after = std::min(m + 1, n - 1);  // the last couples with nothing
    const Real *here = carried.origin + m * step, *next = carried.origin + after * step,
               *face = closed.origin + after * step;
    for_each_in_lanes(
        0, kLanes, [&](int lane) __attribute__((always_inline)) {
          const std::ptrdiff_t at = kAxis == 0 ? start[lane] : start[0] + lane;
          const Real mass = here[at] * volume, open = coupling * (Real(1) - face[at]);
          const Real up = mass > Real(0) && next[at] > Real(0) ? open : Real(0);
          const Real pivot = mass + low[lane] + up - low[lane] * factor[lane];
          const Real inverse = mass > Real(0) ? Real(1) / pivot : Real(0);
          scale[lane] = mass * inverse;
          carry[lane] = low[lane] * inverse;
          above[lane] = factor[lane] = up * inverse;
          low[lane] = up;
        });
  }
}

template <int kAxis>
void IncrementSmoother::factorise_all(const CutCells& cut, ConstFieldView carried) {
  CutBlocks& blocks = cut_[kAxis];
  constexpr int kLanes = kAxis == 0 ? kRegisterLanes : kRealLanes;
  const std::size_t size = blocks.block.size() * operator_[kAxis].volume.size() * std::size_t{kLanes};
  for (auto* v : {&blocks.scale, &blocks.carry, &blocks.above})
    if (v->size() < size) v->resize(size);
  for_each_index(static_cast<int>(blocks.block.size()),
                 [&](int n) { factorise<kAxis>(n, carried, cut.closed[kAxis].view()); });
}

void IncrementSmoother::prepare(double nu_dt, const CutCells& cut, ConstFieldView carried) {
  nu_dt_ = nu_dt;
  list_blocks(cut);
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
  factorise_all<0>(cut, carried);
  factorise_all<1>(cut, carried);
  factorise_all<2>(cut, carried);
}

/// Along x the recurrence runs over the registers of kRegisterLanes rows at once, transposed there and back.
void IncrementSmoother::smooth_x(FieldView delta, int piece) const {
  const int width = (nx_ + kRegisterLanes - 1) / kRegisterLanes * kRegisterLanes;
  Register* column =
      reinterpret_cast<Register*>(thread_scratch(static_cast<std::size_t>(width * kRegisterLanes)));
  const Factors& f = factors_[0];
  const CutBlocks& cut = cut_[0];
  const int first = piece * planes_together_ * ny_,
            last = std::min(first + planes_together_ * ny_, nz_ * ny_);
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
    const int number =
        cut.number[static_cast<std::size_t>(piece * row_blocks_ + (n0 - first) / kRegisterLanes)];
    if (number < 0) {
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
    } else {
      const auto factors = [at = static_cast<std::ptrdiff_t>(number) * nx_](const std::vector<Real>& v) {
        return reinterpret_cast<const LooseRegister*>(v.data()) + at;
      };
      const LooseRegister *scale = factors(cut.scale), *carry = factors(cut.carry),
                          *above = factors(cut.above);
      const Register zero{};
      Register s{};
      for (int i = 0; i < nx_; ++i) {
        s = scale[i] * (scale[i] > zero ? column[i] : zero) + carry[i] * s;  // in solids anything
        column[i] = s;
      }
      for (int i = nx_ - 2; i >= 0; --i) {
        s = column[i] + above[i] * s;
        column[i] = s;
      }
    }
    for (int i0 = 0; i0 < width; i0 += kRegisterLanes) {
      std::copy_n(column + i0, kRegisterLanes, tile);
      transpose(tile);
      for (int n = 0; n < rows; ++n) *reinterpret_cast<Register*>(row(n0 + n) + i0) = tile[n];
    }
  }
}

/// One row of a sweep along y or z, block by block: plain(i), and cut(i, at) with `at` where the factors of
/// its block are. `numbers`: of the row's blocks.
template <class Plain, class Cut>
void IncrementSmoother::smooth_row(int axis, const int* numbers, int m, const Plain& plain,
                                   const Cut& cut) const {
  const std::ptrdiff_t n = axis == 1 ? ny_ : nz_;
  for (int b = 0; b < cell_blocks_; ++b) {
    const int i0 = b * kRealLanes;
    const std::ptrdiff_t at = (numbers[b] * n + m) * kRealLanes;
    if (numbers[b] < 0) for_each_in_lanes(0, kRealLanes, [&](int lane) { plain(i0 + lane); });
    else for_each_in_lanes(0, kRealLanes, [&](int lane) { cut(i0 + lane, at + lane); });
  }
}

/// Forward along y or z: row m of the sweep from the one before.
void IncrementSmoother::smooth_up(int axis, const int* numbers, int m, Real* row, const Real* before) const {
  const Factors& f = factors_[static_cast<std::size_t>(axis)];
  const CutBlocks& c = cut_[static_cast<std::size_t>(axis)];
  const Real inverse = f.inverse[static_cast<std::size_t>(m)], below = f.below[static_cast<std::size_t>(m)];
  const Real *scale = c.scale.data(), *carry = c.carry.data();  // carry and below are 0 in the first row
  smooth_row(
      axis, numbers, m, [=](int i) { row[i] = row[i] * inverse - below * before[i]; },
      [=](int i, std::ptrdiff_t at) {
        const Real r = scale[at] > Real(0) ? row[i] : Real(0);  // in solids anything
        row[i] = scale[at] * r + carry[at] * before[i];
      });
}

/// Backward: row m from the one after.
void IncrementSmoother::smooth_down(int axis, const int* numbers, int m, Real* row, const Real* after) const {
  const Real above = factors_[static_cast<std::size_t>(axis)].above[static_cast<std::size_t>(m)];
  smooth_row(
      axis, numbers, m, [=](int i) { row[i] -= above * after[i]; },
      [=, above = cut_[static_cast<std::size_t>(axis)].above.data()](int i, std::ptrdiff_t at) {
        row[i] += above[at] * after[i];
      });
}

void IncrementSmoother::smooth_y(FieldView delta, int k) const {
  const int* numbers = cut_[1].number.data() + k * cell_blocks_;
  for (int j = 0; j < ny_; ++j) smooth_up(1, numbers, j, delta.row(j, k), delta.row(std::max(j - 1, 0), k));
  for (int j = ny_ - 2; j >= 0; --j) smooth_down(1, numbers, j, delta.row(j, k), delta.row(j + 1, k));
}

void IncrementSmoother::smooth_z_and_add(FieldView delta, int j0, int j1, const Base& base) const {
  const auto numbers = [&](int j) { return cut_[2].number.data() + j * cell_blocks_; };
  for (int k = 0; active_[2] && k < nz_; ++k)
    for (int j = j0; j < j1; ++j) {
      fetch(delta.row(j, std::min(k + 1, nz_ - 1)), nx_);
      smooth_up(2, numbers(j), k, delta.row(j, k), delta.row(j, std::max(k - 1, 0)));
    }
  // Backward; a row is added to its base as soon as the row below no longer needs it.
  for (int k = nz_ - 1; k >= 0; --k)
    for (int j = j0; j < j1; ++j) {
      Real* row = delta.row(j, k);
      const Real* two = base.two.row(j, k);
      const Real* one = base.a == Real(0) ? two : base.one.row(j, k);  // not needed: not fetched either
      const Real a = base.a, b = base.b;
      fetch(base.two.row(j, std::max(k - 1, 0)), nx_);
      if (a != Real(0)) fetch(base.one.row(j, std::max(k - 1, 0)), nx_);
      if (k > 0 && active_[2]) smooth_down(2, numbers(j), k - 1, delta.row(j, k - 1), row);
      if (base.positive)
        for_each_lane(0, nx_, [=](int i) { row[i] = positive_sum(a * one[i] + b * two[i], row[i]); });
      else for_each_lane(0, nx_, [=](int i) { row[i] += a * one[i] + b * two[i]; });
    }
}

void IncrementSmoother::apply(FieldView delta, const Base& base) const {
  for_each_index((nz_ + planes_together_ - 1) / planes_together_, [&](int piece) {
    const int k0 = piece * planes_together_, k1 = std::min(k0 + planes_together_, nz_);
    for (int k = k0; active_[1] && k < k1; ++k) smooth_y(delta, k);
    if (active_[0]) smooth_x(delta, piece);
  });
  for_each_index((ny_ + kRowsTogether - 1) / kRowsTogether, [&](int n) {
    const int j0 = n * kRowsTogether, j1 = std::min(j0 + kRowsTogether, ny_);
    smooth_z_and_add(delta, j0, j1, base);
  });
}

}  // namespace ejecta
