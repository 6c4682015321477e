#pragma once
#include <span>
#include <vector>

#include "dem/body.hpp"
#include "dem/loads.hpp"
#include "flow/solid_mask.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Resolved two-way coupling of bodies and flow. Bodies become cells the flow must move with;
/// what the flow had to do to the fluid there, with the opposite sign, is what the fluid does to the bodies.
class ResolvedCoupling {
 public:
  /// `gravity` acts on the fluid as well, hidden in its hydrostatic pressure: it returns as buoyancy.
  ResolvedCoupling(const Grid& grid, double fluid_density, const Vec3& gravity);

  /// Lists the cells whose centres lie inside bodies, body by body.
  void map(std::span<const Body> bodies, SolidMask& mask);
  /// Force and torque on every body over the last flow step of length dt:
  ///   F = -sum(impulse) / dt + rho V a - rho V g,
  /// where the second term returns the inertia of the fictitious fluid inside the body (Uhlmann 2005, eq.
  /// 18), with the body's acceleration over the step before.
  void collect(std::span<const Body> bodies, const SolidMask& mask, double dt, std::span<Load> loads);

  /// Cells across the smallest feature of a body where it is now, in the coarsest direction.
  double cells_across(const Body& body) const;
  /// False once no body touches the box.
  bool any_inside(std::span<const Body> bodies) const;
  /// Velocities of the last collection, for checkpoints.
  std::vector<double> state() const;
  void restore(std::span<const double> state);

 private:
  struct Extent {
    int lower[3], upper[3];
    bool empty;
  };
  Extent extent(const Body& body) const;
  void map_row(const Body& body, int index, const Extent& e, int j, int k, std::vector<SolidCell>& out) const;
  SolidCell solid_cell(const Body& body, int index, int i, int j, int k, double distance) const;

  struct Before {
    Vec3 velocity{0, 0, 0}, angular_momentum{0, 0, 0};
    bool known = false;
  };
  const Grid& grid_;
  double density_;
  Vec3 gravity_;
  std::vector<Before> motion_;
  std::vector<std::vector<SolidCell>> planes_;  // scratch, one list a plane of cells
  std::vector<double> wetted_;                  // scratch, volume of the cells of each body, m3
};

}  // namespace ejecta
