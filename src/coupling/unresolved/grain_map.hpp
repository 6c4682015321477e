#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "coupling/unresolved/kernel.hpp"
#include "dem/body.hpp"
#include "flow/cut_cells.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Grains that one thread takes at a time.
inline constexpr int kGrainBlock = 256;

/// kernel(block, begin, end) for blocks of a list of grains.
template <class Kernel>
void for_each_grain_block(std::size_t count, const Kernel& kernel) {
  const int n = static_cast<int>(count), blocks = (n + kGrainBlock - 1) / kGrainBlock;
  for_each_index(blocks, [&](int b) {
    kernel(static_cast<std::size_t>(b), static_cast<std::size_t>(b * kGrainBlock),
           static_cast<std::size_t>(std::min((b + 1) * kGrainBlock, n)));
  });
}

inline std::size_t block_count_of(std::size_t grains) { return (grains + kGrainBlock - 1) / kGrainBlock; }

/// Where grains lie in the cells of a grid, by the weights of their kernels: what they have spreads over
/// cells, and what they see is gathered from them, by the same weights. Grains are taken row by row of cells,
/// those of a row in their order: neighbours meet in the cache, and any number of threads gives the same
/// bits.
class GrainMap {
 public:
  /// kernel_width: in grain diameters.
  GrainMap(const Grid& grid, const std::array<std::array<Beyond, 2>, 3>& beyond, double kernel_width);

  /// Lists the grains that are `here` and finds their weights. `diameters`: of all, m. `cut`: cells in bodies
  /// take no grains.
  void place(std::span<const Body> grains, const std::vector<char>& here, std::span<const double> diameters,
             const CutCells& cut);

  /// A grain and its kernel; its weights along each axis stand in weights_.
  struct Place {
    std::array<int, 3> first{}, count{};  // cells; along x whole runs
    bool near_bodies = false;             // room_ counts
    bool in_pieces = false;               // its rows go on at the other end of the box
    Real scale = 0;                       // of the product of the weights: 1 but near bodies
    double inside = 0.0;                  // part of the kernel in the box; 0: the grain is not there
    double density = 0.0;                 // 1/m3, of what it leaves in cells, as it sees it
    double spread = 0.0;                  // m, standard deviation of where its force acts
  };
  std::size_t size() const { return places_.size(); }
  const Place& operator[](std::size_t at) const { return places_[at]; }
  std::size_t grain(std::size_t at) const { return static_cast<std::size_t>(listed_[at]); }
  /// The number of a grain that is asked for some grains later, at most that of `last`: bodies lie far apart
  /// in memory.
  std::size_t grain_ahead(std::size_t at, std::size_t last) const {
    constexpr std::size_t kAhead = 12;
    return grain(std::min(at + kAhead, last));
  }

  /// Sums of weight * field over the cells of a grain.
  template <std::size_t kN>
  std::array<double, kN> gather(std::size_t at, const std::array<ConstFieldView, kN>& fields) const;
  /// f(cell) = sum of values(at) * weight over the grains and the volume of the cell's fluid, for kN fields
  /// at once.
  template <std::size_t kN, class Values>
  void scatter(const std::array<FieldView, kN>& to, const Values& values) const;
  /// Sum of a field times the volume of the cells' fluid.
  double integral(ConstFieldView f) const;

 private:
  /// Cells of a row that are read and written together, at any address.
  static constexpr int kRun = 4;
  using RealRun = Real __attribute__((vector_size(kRun * sizeof(Real)), aligned(alignof(Real)), may_alias));
  using DoubleRun =
      double __attribute__((vector_size(kRun * sizeof(double)), aligned(alignof(double)), may_alias));
  EJECTA_KERNEL static RealRun run_at(const Real* cells) { return *reinterpret_cast<const RealRun*>(cells); }
  EJECTA_KERNEL static double sum_of(const RealRun& r) {
    return (double(r[0]) + double(r[1])) + (double(r[2]) + double(r[3]));
  }

  void note_room(const CutCells& cut);
  void sort_grains(std::span<const Body> grains, const std::vector<char>& here);
  void place_grains(std::span<const Body> grains, std::span<const double> diameters);
  int place_one(const Vec3& position, const std::array<int, 3>& home, double width, std::size_t at);
  void take_whole_runs(Place& p, Real* along) const;
  void place_near_bodies(std::size_t at);
  const Real* weights(std::size_t at, std::size_t axis) const {
    return weights_.data() + (3 * at + axis) * stride_;
  }
  template <class Visit>
  void for_each_row(std::size_t at, int plane, const Visit& visit) const;
  template <std::size_t kN>
  std::array<double, kN> gather_in_pieces(std::size_t at, const std::array<ConstFieldView, kN>& fields) const;
  /// visit(at, plane) for the grains that reach into a plane of cells, and the plane's number in their
  /// kernels.
  template <class Visit>
  void for_each_in_plane(int k, const Visit& visit) const;
  int wrapped(int i, int d) const { return i < 0 ? i + grid_.n(d) : i >= grid_.n(d) ? i - grid_.n(d) : i; }

  const Grid& grid_;
  std::array<std::array<Beyond, 2>, 3> beyond_;
  double kernel_width_;
  Field room_;           // part of each cell whose momentum is the fluid's, where there are bodies
  bool bodies_ = false;  // there are
  Range3 around_;        // cells that they cut and fill
  std::array<std::vector<double>, 3> inverse_widths_;  // of the cells, 1/m
  std::vector<std::array<int, 3>>
      cells_;                      // of all grains: in which they are, or were when they last were there
  std::vector<int> listed_;        // those that are there, row by row
  std::vector<int> first_of_row_;  // in listed_ and what follows, which stand in its order
  std::vector<Place> places_;
  std::vector<Real> weights_;  // stride_ along each axis
  std::size_t stride_ = kRun;
  int reach_ = 0;  // in planes, of the grains from the one they are in
};

/// visit(j, k, weight) for the rows of cells in plane number `plane` of a grain's own.
template <class Visit>
void GrainMap::for_each_row(std::size_t at, int plane, const Visit& visit) const {
  const Place& p = places_[at];
  const Real *along_y = weights(at, 1), of_plane = p.scale * weights(at, 2)[plane];
  const int k = wrapped(p.first[2] + plane, 2);
  for (int b = 0; b < p.count[1]; ++b) visit(wrapped(p.first[1] + b, 1), k, of_plane * along_y[b]);
}

/// Sums of weight * field over the cells of a grain.
template <std::size_t kN>
std::array<double, kN> GrainMap::gather(std::size_t at, const std::array<ConstFieldView, kN>& fields) const {
  const Place& p = places_[at];
  if (p.in_pieces) return gather_in_pieces<kN>(at, fields);
  const Real *along = weights(at, 0), *room = p.near_bodies ? room_.view().origin : nullptr;
  RealRun sums[kN] = {};
  for (int plane = 0; plane < p.count[2]; ++plane)
    for_each_row(at, plane, [&](int j, int k, Real w) {
      std::ptrdiff_t cell = p.first[0] + j * fields[0].sy + k * fields[0].sz;
      for (int a = 0; a < p.count[0]; a += kRun, cell += kRun) {
        RealRun weight = w * run_at(along + a);
        if (room) weight *= run_at(room + cell);
        for (std::size_t c = 0; c < kN; ++c) sums[c] += weight * run_at(fields[c].origin + cell);
      }
    });
  std::array<double, kN> out;
  for (std::size_t c = 0; c < kN; ++c) out[c] = sum_of(sums[c]);
  return out;
}

/// Cell by cell, for rows that go on at the other end of the box, or are shorter than a run.
template <std::size_t kN>
std::array<double, kN> GrainMap::gather_in_pieces(std::size_t at,
                                                  const std::array<ConstFieldView, kN>& fields) const {
  const Place& p = places_[at];
  std::array<double, kN> sums{};
  for (int plane = 0; plane < p.count[2]; ++plane)
    for_each_row(at, plane, [&](int j, int k, Real w) {
      for (int a = 0; a < p.count[0]; ++a) {
        const int i = wrapped(p.first[0] + a, 0);
        const Real weight = w * weights(at, 0)[a] * (p.near_bodies ? room_(i, j, k) : Real(1));
        for (std::size_t c = 0; c < kN; ++c) sums[c] += double(weight * fields[c](i, j, k));
      }
    });
  return sums;
}

template <class Visit>
void GrainMap::for_each_in_plane(int k, const Visit& visit) const {
  const int nz = grid_.nz(), ny = grid_.ny();
  const bool all = 2 * reach_ + 1 >= nz, around = beyond_[2][0] == Beyond::periodic;
  for (int near = all ? 0 : k - reach_; near < (all ? nz : k + reach_ + 1); ++near) {
    if (!around && (near < 0 || near >= nz)) continue;
    const std::size_t row = static_cast<std::size_t>(wrapped(near, 2) * ny);
    const std::size_t end = static_cast<std::size_t>(first_of_row_[row + static_cast<std::size_t>(ny)]);
    for (std::size_t at = static_cast<std::size_t>(first_of_row_[row]); at < end; ++at) {
      const int plane = k - places_[at].first[2];
      for (int c = plane < 0     ? plane + nz
                   : plane >= nz ? plane - nz
                                 : plane;
           c < places_[at].count[2]; c += nz)
        visit(at, c);
    }
  }
}

/// Plane by plane in double, each plane's grains in the order of the list.
template <std::size_t kN, class Values>
void GrainMap::scatter(const std::array<FieldView, kN>& to, const Values& values) const {
  const std::size_t nx = static_cast<std::size_t>(grid_.nx()),
                    cells = nx * static_cast<std::size_t>(grid_.ny());
  for_each_index_dynamic(grid_.nz(), [&](int k) {
    thread_local std::vector<double> sums;
    sums.assign(kN * cells, 0.0);
    const ConstFieldView room = room_.view();
    for_each_in_plane(k, [&](std::size_t at, int plane) {
      const Place& p = places_[at];
      const Real* along = weights(at, 0);
      const std::array<double, kN> value = values(at);
      for_each_row(at, plane, [&](int j, int, Real w) {
        double* row = sums.data() + static_cast<std::size_t>(j) * nx;
        if (p.in_pieces) {
          for (int a = 0; a < p.count[0]; ++a) {
            const int i = wrapped(p.first[0] + a, 0);
            const double weight = w * along[a] * (p.near_bodies ? room(i, j, k) : Real(1));
            for (std::size_t c = 0; c < kN; ++c)
              row[c * cells + static_cast<std::size_t>(i)] += weight * value[c];
          }
          return;
        }
        for (int a = 0; a < p.count[0]; a += kRun) {
          RealRun weight = w * run_at(along + a);
          if (p.near_bodies) weight *= run_at(room.row(j, k) + p.first[0] + a);
          const DoubleRun wide = __builtin_convertvector(weight, DoubleRun);
          for (std::size_t c = 0; c < kN; ++c)
            *reinterpret_cast<DoubleRun*>(row + c * cells + p.first[0] + a) += wide * value[c];
        }
      });
    });
    for (int j = 0; j < grid_.ny(); ++j) {
      const double area =
          inverse_widths_[1][static_cast<std::size_t>(j)] * inverse_widths_[2][static_cast<std::size_t>(k)];
      const double *width = inverse_widths_[0].data(), *row = sums.data() + static_cast<std::size_t>(j) * nx;
      for (std::size_t c = 0; c < kN; ++c)
        for_each_in_lanes(0, grid_.nx(), [=, out = to[c].row(j, k), from = row + c * cells](int i) {
          out[i] = static_cast<Real>(area * width[i] * from[i]);
        });
      for (std::size_t c = 0; bodies_ && c < kN; ++c)
        for_each_in_lanes(0, grid_.nx(), [out = to[c].row(j, k), part = room.row(j, k)](int i) {
          out[i] = part[i] > 0 ? out[i] / part[i] : Real(0);
        });
    }
  });
}

}  // namespace ejecta
