#pragma once
#include <span>
#include <string>

#include "dem/body.hpp"
#include "dem/materials.hpp"

namespace ejecta {

/// pi R sqrt(rho/G) / (0.1631 nu + 0.8766): the time a Rayleigh wave needs around half a sphere, s (Ning &
/// Ghadiri 2006, Chem. Eng. Sci. 61:5991).
double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio);

/// Duration of an elastic Hertz impact, s: 2.9432 d/v with d = (15 m v^2 / (16 E sqrt(R)))^(2/5) (Timoshenko
/// & Goodier 1970, 142). `mass`, `radius`, `youngs`: effective values of the pair.
double hertz_time(double mass, double radius, double youngs, double velocity);

/// What limits the step of a body: the smallest of its Rayleigh time, the duration of its impacts at
/// `velocity` and, with flat faces, a quarter of the period on an elastic foundation
/// (whose force sets in with a kink). s.
double contact_time(const Body& body, const Materials& materials, double velocity);

}  // namespace ejecta
