#include "app/jet_measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "base/error.hpp"

namespace ejecta {
namespace {

/// Factor to SI of a column head "name [unit]"; nothing when there is no such unit.
std::optional<double> factor_of(const std::string& head, Dimension dimension) {
  const auto open = head.find('['), close = head.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return std::nullopt;
  return to_si(1.0, head.substr(open + 1, close - open - 1), dimension);
}

std::array<std::string, 2> halves(const std::string& line) {
  const auto comma = line.find(',');
  if (comma == std::string::npos) return {line, ""};
  const auto trimmed = [](std::string s) {
    const auto from = s.find_first_not_of(" \t\r"), to = s.find_last_not_of(" \t\r");
    return from == std::string::npos ? std::string() : s.substr(from, to - from + 1);
  };
  return {trimmed(line.substr(0, comma)), trimmed(line.substr(comma + 1))};
}

}  // namespace

MeasuredCurve read_measured(const std::filesystem::path& file, Dimension position) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("cannot read the measurement {}", file.string()));
  MeasuredCurve curve;
  std::optional<double> x_factor, y_factor;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    const auto fail = [&](std::string_view what, std::string_view expected) {
      throw InputError(
          fmt::format("{}:{}: {}\n  {}\nexpected {}", file.string(), number, what, line, expected));
    };
    const auto [first, second] = halves(line);
    if (!x_factor) {
      x_factor = factor_of(first, position);
      y_factor = factor_of(second, Dimension::pressure);
      if (!x_factor || !y_factor)
        fail("the head of a column lacks its unit", position == Dimension::time
                                                        ? "e.g. 'time [ms],total_gauge [kPa]'"
                                                        : "e.g. 'z [mm],total_gauge [kPa]'");
      continue;
    }
    const auto x = parse_number(first), y = parse_number(second);
    if (!x || !y) fail("a value is missing", "two numbers, e.g. '75, 9.5'");
    if (!curve.x.empty() && !(*x * *x_factor > curve.x.back()))
      fail("the positions do not increase", "rows in ascending order");
    curve.x.push_back(*x * *x_factor);
    curve.y.push_back(*y * *y_factor);
  }
  if (curve.x.empty()) throw InputError(fmt::format("{}: no measured values", file.string()));
  return curve;
}

MeasuredError compare_measured(const MeasuredCurve& measured, std::span<const double> x,
                               std::span<const double> y) {
  MeasuredError e;
  for (std::size_t n = 0; n < measured.x.size(); ++n) {
    e.scale = std::max(e.scale, std::abs(measured.y[n]));
    const auto above = std::lower_bound(x.begin(), x.end(), measured.x[n]);
    if (above == x.end() || (above == x.begin() && measured.x[n] < x.front())) continue;
    const auto i = std::max<std::size_t>(1, static_cast<std::size_t>(above - x.begin()));
    const double share = (measured.x[n] - x[i - 1]) / (x[i] - x[i - 1]);
    const double d = (1.0 - share) * y[i - 1] + share * y[i] - measured.y[n];
    ++e.points;
    e.mean += d;
    e.rms += d * d;
    e.largest = std::max(e.largest, std::abs(d));
  }
  if (e.points > 0) {
    e.mean /= e.points;
    e.rms = std::sqrt(e.rms / e.points);
  }
  return e;
}

nlohmann::ordered_json MeasuredError::summary() const {
  return {{"points", points},
          {"mean_difference_Pa", mean},
          {"rms_difference_Pa", rms},
          {"largest_difference_Pa", largest},
          {"rms_relative_percent", scale > 0.0 ? 100.0 * rms / scale : 0.0}};
}

}  // namespace ejecta
