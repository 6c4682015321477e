#pragma once
#include <array>

#include "app/jet_inlet.hpp"
#include "case/case.hpp"
#include "case/expression.hpp"
#include "flow/boundary.hpp"
#include "grid/grid.hpp"

/// States of the incompressible flow as a case describes them: around the box and in its regions.
namespace ejecta {

/// The fluid before anything happens: with a trace of turbulence whose eddy viscosity equals the molecular
/// one.
struct StillAir {
  explicit StillAir(const Case& c);
  double density, nu;  ///< kg/m3, m2/s
  bool omega;          ///< the second turbulence variable is omega (1/s), not epsilon (m2/s3)
  double k, second;    ///< m2/s2, see omega
};

/// Compiled state of a boundary, region or exact solution.
struct StateFormula {
  std::array<Expression, 3> velocity;
  bool has_velocity = false, varies = false;
  double k = 0, second = 0;

  StateFormula(const StateSpec& s, const StillAir& air);
  Vec3 at(const Vec3& x, double t) const {
    return {velocity[0](x.x(), x.y(), x.z(), t), velocity[1](x.x(), x.y(), x.z(), t),
            velocity[2](x.x(), x.y(), x.z(), t)};
  }
};

/// What a face of the box does. Keeps references to the case, the grid and the jet (null: none enters).
Boundary make_boundary(const Case& c, const Grid& grid, const StillAir& air, const JetInlet* jet, int face);

}  // namespace ejecta
