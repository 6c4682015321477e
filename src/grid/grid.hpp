#pragma once
#include <array>
#include <memory>
#include <vector>

#include "base/real.hpp"
#include "base/vec.hpp"
#include "grid/axis.hpp"
#include "grid/field.hpp"

namespace ejecta {

/// One direction's metrics as kernels see them, in Real, indexable from -kGhosts to n + kGhosts. Ghost cells
/// mirror the width of the cells inside, so that distances at boundaries are those of a mirrored grid.
///
/// Every operator is built from these: the volume of a cell is the product of three `volume`s, the area of
/// an x-face is area_x[i] * volume_y[j] * volume_z[k]. Cartesian: area 1, volume = width. Axisymmetric:
/// area_x = r, volume_x = (r+^2 - r-^2)/2 (a wedge of one radian), and y is one cell of "volume" 1.
struct Metrics {
  const Real* width;   ///< m
  const Real* centre;  ///< m
  const Real* face;    ///< m; entry i is the lower face of cell i
  const Real* volume;
  const Real* area;  ///< of the lower face of cell i
  const Real* inv_volume;
  const Real* inv_width;     ///< 1/m
  const Real* inv_distance;  ///< 1 / (centre i - centre i-1), of the lower face of cell i, 1/m
  const Real* inv_span;      ///< 1 / (centre i+1 - centre i-1), 1/m
  const Real* weight;        ///< linear weight of cell i-1 in the value on the lower face of cell i
};

class Grid {
 public:
  Grid(Axis x, Axis y, Axis z, bool axisymmetric = false);

  const Axis& axis(int d) const { return axis_[static_cast<std::size_t>(d)]; }
  const Metrics& metrics(int d) const { return metrics_[static_cast<std::size_t>(d)]; }
  const std::array<Metrics, 3>& metrics() const { return metrics_; }
  int nx() const { return axis_[0].n; }
  int ny() const { return axis_[1].n; }
  int nz() const { return axis_[2].n; }
  int n(int d) const { return axis_[static_cast<std::size_t>(d)].n; }
  std::int64_t cells() const { return std::int64_t(nx()) * ny() * nz(); }
  Range3 range() const { return {0, nx(), 0, ny(), 0, nz()}; }
  bool axisymmetric() const { return axisymmetric_; }
  /// A direction with a single cell carries no flux: the flow is two- (or one-) dimensional.
  bool active(int d) const { return n(d) > 1; }
  Field make_field() const { return Field(nx(), ny(), nz()); }
  double volume(int i, int j, int k) const;  ///< m3; axisymmetric: m3 per radian
  Vec3 centre(int i, int j, int k) const;
  Vec3 lower() const;
  Vec3 upper() const;
  double smallest_volume() const;
  double largest_volume() const;

 private:
  struct Lines {  // with ghosts, entry g is index g - kGhosts
    std::vector<Real> width, centre, face, volume, area, inv_volume, inv_width, inv_distance, inv_span,
        weight;
  };
  static Lines make_lines(const Axis& axis, bool radial, bool collapsed);
  std::array<Axis, 3> axis_;
  std::array<std::shared_ptr<const Lines>, 3> lines_;  // copies of a grid share them
  std::array<Metrics, 3> metrics_;                     // into these
  bool axisymmetric_ = false;
};

}  // namespace ejecta
