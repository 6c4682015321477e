#pragma once
#include <span>
#include <vector>

#include "coupling/resolved/added_mass.hpp"
#include "coupling/resolved/cut_map.hpp"
#include "dem/body.hpp"
#include "dem/loads.hpp"
#include "flow/cut_cells.hpp"
#include "grid/grid.hpp"

namespace ejecta {

struct CouplingSetup {
  double fluid_density = 0.0;  ///< kg/m3
  Vec3 gravity{0, 0,
               0};  ///< acts on the fluid as well, hidden in its hydrostatic pressure: returns as buoyancy
  Vec3 body_force{0, 0,
                  0};  ///< m/s2 that drives the fluid like a gradient of pressure: acts on bodies by volume
  /// Pa s, of a flow that leaves grad u^T out of its stress (laminar, incompressible): what walls take is
  /// then mu du/dn without mu n x spin, which adds up to no force but to a torque of -2 mu V spin. 0: it is
  /// counted.
  double viscosity = 0.0;
  std::array<bool, 3> periodic{};
  std::vector<double> roughness;  ///< of every body, sand-grain height, m
};

/// The air's force on a body over the last flow step by its parts, N.
struct ForceParts {
  Vec3 pressure{0, 0, 0}, friction{0, 0, 0};
};

/// Resolved two-way coupling of bodies and flow.
class ResolvedCoupling {
 public:
  ResolvedCoupling(const Grid& grid, CouplingSetup setup);

  /// Fills cut.
  void map(std::span<const Body> bodies, CutCells& cut);
  /// Force and torque on every body over the last flow step of length dt: pressure and friction on its walls
  /// and buoyancy, averaged over the steps before with the weight of the added mass against that of the body,
  /// lambda = M / (m + M) along and about each axis of the body: F += (1 - lambda) (F_now - F). The fluid
  /// answers an acceleration within the step that follows, so that for a body lighter than its added mass the
  /// plain force grows without bound from step to step. Where M is the added mass this one follows at once,
  /// and it settles where the added mass is less than m + 2 M; for ore in air lambda is 2e-4. A body begins
  /// as if something had held it.
  void collect(std::span<const Body> bodies, const CutCells& cut, double dt, std::span<Load> loads);

  const std::vector<ForceParts>& parts() const { return parts_; }
  /// False once no body touches the box.
  bool any_inside(std::span<const Body> bodies) const;
  /// Velocities and forces of the last collection, for checkpoints.
  std::vector<double> state() const;
  void restore(std::span<const double> state);

 private:
  bool inside(const Body& body) const;
  const AddedMass& accelerated_with(std::size_t body, const MassProperties& shape);

  struct Before {
    Load push;  // what the body was given
    bool known = false;
  };
  const Grid& grid_;
  CouplingSetup setup_;
  CutMap cut_map_;
  std::vector<ForceParts> parts_;
  std::vector<Before> motion_;
  std::vector<AddedMass> added_;  // once a body was wet
  std::vector<double> wetted_;    // scratch, area of the walls of each body, m2
};

}  // namespace ejecta
