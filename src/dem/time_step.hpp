#pragma once
#include <algorithm>
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

/// In which things that near each other at `speed` (m/s) come a quarter of the thickness (m) of the thinner:
/// in longer steps they might pass through each other unseen. s
inline double passing_time(double thickness, double speed) { return 0.25 * thickness / speed; }

/// How far a contact may come in a sub-step before that is divided: turn of its oscillation (rad; a step of
/// stable_dt() has 0.16 in the impact it is made for, central differences are stable up to 2) and decay by
/// its dashpot (velocities extrapolated to the whole step are stable up to 1).
inline constexpr double kMostTurn = 0.3, kMostDecay = 0.7;

/// Sub-steps a second that a contact asks for, squared: `stiffness` over mass (1/s2), `damping`: dashpot over
/// mass (1/s).
inline double asked_rate_squared(double stiffness, double damping) {
  return std::max(stiffness / (kMostTurn * kMostTurn), damping * damping / (kMostDecay * kMostDecay));
}

}  // namespace ejecta
