#pragma once
#include <array>
#include <optional>

#include "case/case.hpp"
#include "case/expression.hpp"
#include "flow/boundary.hpp"
#include "flow/model/inflow.hpp"
#include "grid/grid.hpp"

/// States of the incompressible flow as a case describes them: around the box and in its regions.
namespace ejecta {

/// The fluid before anything happens: with a trace of turbulence whose eddy viscosity equals the molecular
/// one.
struct StillAir {
  explicit StillAir(const Case& c);
  double density, nu;     ///< kg/m3, m2/s
  bool omega;             ///< dissipation is told by omega (1/s), not epsilon (m2/s3)
  double k, dissipation;  ///< m2/s2, see omega
};

/// Compiled state of a boundary, region or exact solution.
struct StateFormula {
  std::array<Expression, 3> velocity;
  bool has_velocity = false, varies = false;

  StateFormula(const StateSpec& s, const StillAir& air);
  Vec3 at(const Vec3& x, double t) const {
    return {velocity[0](x.x(), x.y(), x.z(), t), velocity[1](x.x(), x.y(), x.z(), t),
            velocity[2](x.x(), x.y(), x.z(), t)};
  }
  struct Turbulence {
    double k, dissipation;  ///< see StillAir
  };
  /// What a formula makes less than nothing, or no number of, counts as still air.
  Turbulence turbulence_at(const Vec3& x, double t) const;

 private:
  StillAir still_;
  std::optional<Expression> k_, epsilon_;  ///< of still air where the case gives none
};

/// What a face of the box does. Keeps references to the case, the grid and the
/// inflow, which has one where the face is a jet.
Boundary make_boundary(const Case& c, const Grid& grid, const StillAir& air, const Inflow& inflow, int face);

}  // namespace ejecta
