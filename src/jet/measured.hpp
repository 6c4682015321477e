#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/units.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// A measured curve in SI units: total gauge pressure (Pa) over position (m) or time (s).
struct MeasuredCurve {
  std::vector<double> x, y;
};

/// Reads a CSV whose head gives its two columns their units, as "z [mm],total_gauge [kPa]" (see read_csv).
/// What is wrong goes to `problems`.
MeasuredCurve read_measured(const std::filesystem::path& file, Dimension position,
                            std::vector<Problem>& problems);
/// The same; throws InputError with file, line and what was expected.
MeasuredCurve read_measured(const std::filesystem::path& file, Dimension position);

/// What a computed curve reads at the places of a measured one.
struct MeasuredError {
  int points = 0;        ///< measured inside the computed stretch
  double mean = 0.0;     ///< Pa, computed - measured
  double rms = 0.0;      ///< Pa
  double largest = 0.0;  ///< Pa
  double scale = 0.0;    ///< Pa, the largest measured value
  nlohmann::ordered_json summary() const;
};
/// `x` ascending.
MeasuredError compare_measured(const MeasuredCurve& measured, std::span<const double> x,
                               std::span<const double> y);

}  // namespace ejecta
