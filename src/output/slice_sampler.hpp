#pragma once
#include <array>
#include <vector>

#include "grid/grid.hpp"
#include "output/report_data.hpp"

namespace ejecta::output {

/// Resamples the air speed of a Grid onto a raster. Velocity is interpolated linearly between cell centres;
/// pixels outside the grid read zero. No allocation after the first call.
class SliceSampler {
 public:
  /// In an axisymmetric grid x is the radius, so a raster through the axis sets mirror_x.
  SliceSampler(const Grid& grid, const SliceRaster& raster);
  /// Fills all but `raster`. Throws DivergedError when a speed is not finite.
  void sample(ConstFieldView u, ConstFieldView v, ConstFieldView w, SliceFrame& out);

 private:
  struct Stencil {  // value = (1 - weight) f[cell] + weight f[next]; cell < 0: outside
    int cell = -1, next = -1;
    Real weight = 0;
  };
  static Stencil stencil(const Axis& axis, double position, bool mirror);
  SliceRaster raster_;
  Stencil normal_;
  std::array<std::vector<Stencil>, 2> across_;
  std::array<int, 2> direction_{0, 2};  // axes of the raster's two directions
  int line_cells_ = 0;
  std::vector<Real> lines_;  // of each raster row: u, v, w at the cells along the first direction
  std::vector<Real> speed_;
};

}  // namespace ejecta::output
