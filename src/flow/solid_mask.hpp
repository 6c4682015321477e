#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "base/real.hpp"
#include "flow/cut_cells.hpp"

namespace ejecta {

/// A cell whose centre lies inside a solid. The flow drives its velocity to
///
///   target = solid + ratio (u(image) - solid)
///
/// where u(image) is interpolated trilinearly at a point in the fluid on the outward normal and ratio in [-1,
/// 0] is signed distance of the centre over distance of the image: the linear profile that vanishes (relative
/// to the solid) on the true surface. Deep inside, ratio = 0.
struct SolidCell {
  int i = 0, j = 0, k = 0;
  int body = 0;
  Real weight = 1;              ///< strength of the forcing, 0..1; ramps up as the surface passes the centre
  std::array<Real, 3> solid{};  ///< rigid-body velocity at the centre, m/s
  Real ratio = 0;
  int image_i = 0, image_j = 0, image_k = 0;  ///< lowest of the eight cells around the image point
  std::array<Real, 3> fraction{};             ///< of the image point between them
};

/// The seam between bodies and flow. Coupling (or an analytic test) fills `cells`, ordered by body; the flow
/// adds up in `impulse` what it had to do to the fluid.
struct SolidMask {
  CutCells cut;                  ///< what incompressible flow reads
  std::vector<SolidCell> cells;  ///< what compressible flow reads
  /// What the last flow step gave to the fluid of the cell, N s.
  std::vector<std::array<double, 3>> impulse;
  std::vector<double> work;                 ///< the same of kinetic energy, J; compressible flow alone
  std::vector<std::array<Real, 3>> target;  ///< scratch of the flow

  void resize_scratch() {
    impulse.resize(cells.size());
    work.resize(cells.size());
    target.resize(cells.size());
  }
  /// Nothing given yet.
  void begin_step() {
    resize_scratch();
    std::fill(impulse.begin(), impulse.end(), std::array<double, 3>{0, 0, 0});
    std::fill(work.begin(), work.end(), 0.0);
  }
};

}  // namespace ejecta
