#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/error.hpp"
#include "sorter/valve.hpp"

namespace ejecta {
namespace {

/// A trace of more points than this is taken as sampled, and a hole in it as lost samples.
constexpr std::size_t kSampled = 20;
constexpr double kHole = 10.0;  // times the median spacing

std::optional<double> number(const std::string& cell) {
  std::istringstream in(cell);
  double value;
  if (!(in >> value) || !(in >> std::ws).eof()) return std::nullopt;
  return value;
}

void refuse_holes(const std::string& file, const std::vector<double>& time) {
  if (time.size() <= kSampled) return;
  std::vector<double> spacing(time.size() - 1);
  for (std::size_t n = 0; n + 1 < time.size(); ++n) spacing[n] = time[n + 1] - time[n];
  std::vector<double> sorted = spacing;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];
  const auto widest = std::max_element(spacing.begin(), spacing.end());
  if (*widest > kHole * median) {
    const auto n = static_cast<std::size_t>(widest - spacing.begin());
    throw InputError(
        fmt::format("{}: the trace has a gap from {} s to {} s, where its samples are {:.3g} s apart", file,
                    time[n], time[n + 1], median));
  }
}

}  // namespace

void read_valve_trace(const std::string& file, std::vector<double>& time, std::vector<double>& opening) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("valve.trace: cannot read '{}'", file));
  std::string line;
  for (int number_of_line = 1; std::getline(in, line); ++number_of_line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    const auto comma = line.find(',');
    const auto t = number(line.substr(0, comma));
    const auto value = comma == std::string::npos ? std::nullopt : number(line.substr(comma + 1));
    if (!t && time.empty()) continue;  // header
    const auto fail = [&](std::string_view what) {
      throw InputError(fmt::format("{}:{}: {}\n  {}\nexpected 'time in s, opening 0..1', e.g. '0.004, 0.85'",
                                   file, number_of_line, what, line));
    };
    if (!t || !value) fail("a value is missing");
    if (!(*value >= 0.0 && *value <= 1.0)) fail("the opening is outside 0..1");
    if (!time.empty() && !(*t > time.back())) fail("the times do not increase");
    time.push_back(*t);
    opening.push_back(*value);
  }
  if (time.size() < 2) throw InputError(fmt::format("{}: a trace needs at least two points", file));
  if (*std::max_element(opening.begin(), opening.end()) == 0.0)
    throw InputError(fmt::format("{}: the valve never opens", file));
  refuse_holes(file, time);
}

}  // namespace ejecta
