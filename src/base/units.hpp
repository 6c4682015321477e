#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ejecta {

/// What a quantity measures. Each has one SI unit, in which the program holds it.
enum class Dimension {
  none,
  length,
  area,
  volume,
  time,
  velocity,
  acceleration,
  angle,
  angular_velocity,
  mass,
  density,
  force,
  pressure_gauge,
  pressure_absolute,
  pressure,
  temperature,
  viscosity,
  frequency,
  stiffness,
  specific_energy,
  dissipation_rate
};

/// Name of the SI unit, e.g. "m/s".
std::string_view si_unit(Dimension d);
/// All units understood for a dimension, SI first, e.g. {"m", "mm", "um", "cm", "in"}.
std::vector<std::string> known_units(Dimension d);
/// Factor to SI, or nothing for a unit that does not fit. Temperatures in C need the offset of to_si.
std::optional<double> to_si(double value, std::string_view unit, Dimension d);

}  // namespace ejecta
