#pragma once
#include <array>

#include "grid/grid.hpp"

/// What grains smaller than a cell leave of the fluid and how they drag it: the seam between grains and flow.
/// Coupling fills everything above the line "results"; plain data, SI units.
namespace ejecta {

/// What grains see of a flow where they begin a step.
struct FluidSeen {
  std::array<ConstFieldView, 3> velocity;  ///< m/s
  ConstFieldView density{};                ///< of a gas, kg/m3; origin null: that of the fluid at rest
  ConstFieldView k{}, dissipation{};       ///< turbulence, m2/s2, m2/s3; origin null: laminar
  bool specific = false;                   ///< the dissipation is omega, 1/s
};

struct FluidFraction {
  explicit FluidFraction(const Grid& grid) {
    for (Field* f : {&solids_before, &solids, &drag, &work}) *f = grid.make_field();
    for (auto* group : {&dragging, &seen, &push})
      for (Field& f : *group) f = grid.make_field();
    for (Field& f : pressure_change) f = grid.make_field();
  }

  /// Part of each cell that is grains (of the fluid that bodies leave of it), at the beginning and at the end
  /// of the step: 1 - e, which keeps its digits where grains are few.
  Field solids_before, solids;
  /// Drag coefficient of the grains in a cell over its volume and the density of the fluid at rest, 1/s, and
  /// that times the velocity of the grains, m/s2: the fluid gains dragging - drag u.
  Field drag;
  std::array<Field, 3> dragging;
  /// What drag worked on the grains in the step before, J/m3; of gas alone, whose energy it is.
  Field work;

  bool acts = true;  ///< on the fluid; false: only the results are wanted

  // Results of the last flow step: what a grain gathers.
  std::array<Field, 3> seen;  ///< velocity on which the drag acted, m/s
  std::array<Field, 3> push;  ///< (-grad p + div tau) / rho that acted on the fluid's part of each cell, m/s2

  /// What the two stages of the last step added to the pressure, m2/s2: the guess of the next, without which
  /// the same bits would not come again.
  std::array<Field, 2> pressure_change;
};

}  // namespace ejecta
