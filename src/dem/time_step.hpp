#pragma once
#include <span>
#include <string>

#include "dem/body.hpp"
#include "dem/materials.hpp"

namespace ejecta {

/// pi R sqrt(rho/G) / (0.1631 nu + 0.8766): the time a Rayleigh wave needs around half a sphere, s (Ning &
/// Ghadiri 2006, Chem. Eng. Sci. 61:5991).
double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio);

/// What limits the step of a body: the smallest of its Rayleigh time, the duration of its impacts at
/// `velocity` and, with flat faces, a quarter of the period on an elastic foundation
/// (whose force sets in with a kink). s.
double contact_time(const Body& body, const Materials& materials, double velocity);

}  // namespace ejecta
