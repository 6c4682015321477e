#pragma once
#include "base/vec.hpp"
#include "shape/mass_properties.hpp"

namespace ejecta {

/// Fluid that is accelerated with a body, along and about the axes of its shape.
struct AddedMass {
  Vec3 mass{0, 0, 0};     ///< kg
  Vec3 inertia{0, 0, 0};  ///< kg m2
};

/// Of the ellipsoid with the volume and the ratios of moments of the body, in boundless ideal fluid (Lamb
/// 1932, Arts. 114, 115): exact for ellipsoids; a cube has 1.3, a thin square plate 0.7 times that.
/// `density`: of the fluid, kg/m3.
AddedMass added_mass(const MassProperties& body, double density);

}  // namespace ejecta
