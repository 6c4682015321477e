#pragma once
#include <functional>
#include <vector>

#include "base/vec.hpp"
#include "grid/grid.hpp"

/// Air that devices outside the box let into it: all that flow knows of jets and valves. Functions of place
/// and time, SI units.
namespace ejecta {

/// What enters at a point: velocity (m/s), k (m2/s2) and epsilon (m2/s3).
struct InflowState {
  Vec3 velocity{0, 0, 0};
  double k = 0.0, epsilon = 0.0;
};

/// Behind an orifice that the grid of a gas resolves.
struct Supply {
  double total_pressure = 0.0;     ///< Pa absolute
  double total_temperature = 0.0;  ///< K
  double fluctuation = 0.0;        ///< m/s, root mean square of one component in what leaves the orifice
};

struct Inflow {
  /// Through a face of the box: at a cell of it with these half widths, m. Empty: nothing comes that way.
  std::function<InflowState(const Vec3& position, const Vec3& half, double time)> at{};
  std::function<double(double time)> fastest{};  ///< of `at`, m/s, for the choice of the time step
  int face = -1;                                 ///< of `at`, 0..5 = x_min, x_max, y_min, ...
  /// Of the orifices (discs of type "jet" in a gas). Empty: there are none.
  std::function<Supply(double time)> supply{};
  std::vector<double> events{};  ///< s: kinks
  double shut_from = 1e300;      ///< s: no more enters
};

/// Half widths of the cell at x, or of the nearest, m; none around the axis of an axisymmetric grid.
Vec3 half_widths(const Grid& grid, const Vec3& x);
/// Width across a face (0..5) of the cells inside it, m.
double width_inside(const Grid& grid, int face);

}  // namespace ejecta
