#pragma once
#include <cmath>

/// What one quantity of turbulence says of another, in SI units and double: for inflows and initial states.
/// The closures have the same constants as Real.
namespace ejecta {

inline constexpr double kCmu = 0.09;

/// m2/s3, where the eddy viscosity is known (m2/s)
inline double epsilon_with(double k, double eddy_viscosity) { return kCmu * k * k / eddy_viscosity; }

/// m2/s3, of what leaves a pipe: mixing length 0.07 d (Versteeg & Malalasekera 2007, section 3.7.2),
/// C_mu^(3/4) k^(3/2) / l
inline double epsilon_of_pipe(double k, double diameter) {
  return std::pow(kCmu, 0.75) * std::pow(k, 1.5) / (0.07 * diameter);
}

}  // namespace ejecta
