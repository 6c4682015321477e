#pragma once
#include "app/simulation.hpp"
#include "case/case.hpp"

namespace ejecta {

/// `ejecta jet CASE --sweep`: settled compressible jets of jet.sweep_pressures and incompressible ones of
/// jet.sweep_velocities, and for every pressure the velocity at which the incompressible jet carries the same
/// momentum, and reads the same total pressure, at the stand-off. Returns an ExitCode.
int sweep_jet(const Case& c, const RunOptions& options);

/// The x > 0 at which a quantity that grows as x^2 reaches `wanted`: linear in x^2 between the two nearest of
/// the computed pairs (ascending), beyond their ends in proportion to the last.
double where_square_reaches(const std::vector<double>& x, const std::vector<double>& y, double wanted);

}  // namespace ejecta
