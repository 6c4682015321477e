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
  dissipation_rate,
  mass_flow,
  specific_heat
};

/// Name of the SI unit, e.g. "m/s".
std::string_view si_unit(Dimension d);
/// All units understood for a dimension, SI first, e.g. {"m", "mm", "um", "cm", "in"}.
std::vector<std::string> known_units(Dimension d);
/// The same for a reader, e.g. "m, mm, um", "Pa, kPa, bar, each gauge or absolute".
std::string unit_words(Dimension d);
/// The value in SI units, or nothing for a unit that does not fit. Temperatures in C need the offset of
/// to_si.
std::optional<double> to_si(double value, std::string_view unit, Dimension d);

/// What a quantity other than 0 may be, by size, SI: far beyond what machines and laboratories hold, far
/// within what arithmetic in single precision bears.
struct Magnitudes {
  double least, most;
};
Magnitudes magnitudes(Dimension d);

/// In words, e.g. "a time", "a pressure".
std::string_view describe(Dimension d);
/// A quantity as one writes it, e.g. "8 ms"; used in error messages.
std::string_view example(Dimension d);
/// Reads "700 kPa gauge" into SI, also "7 barg", "µm", "N/mm²" and the like. `ambient` (Pa, absolute) turns
/// gauge into absolute and back. Throws InputError that says what is wrong with `text`, without saying where
/// it stands.
double parse_quantity(std::string_view text, Dimension d, double ambient = 101325.0);
/// The shortest text that parse_quantity reads back to the same bits, e.g. 0.008 s -> "8 ms".
std::string format_quantity(double si, Dimension d);
/// "5.5 ms" of "5,5 ms": the text with a point for the comma in its number; "" where there is no such comma.
std::string with_decimal_point(std::string_view text);
/// A finite number that fills the whole text, e.g. "1.5e-3"; nothing for anything else (also NaN and
/// infinity).
std::optional<double> parse_number(std::string_view text);

}  // namespace ejecta
