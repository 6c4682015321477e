#include <fmt/format.h>

#include <algorithm>

#include "case/csv_table.hpp"
#include "jet/valve.hpp"

namespace ejecta {
namespace {

/// A trace of more points than this is taken as sampled, and a hole in it as lost samples.
constexpr std::size_t kSampled = 20;
constexpr double kHole = 10.0;  // times the median spacing

const CsvForm& form() {
  static const CsvForm f{.kind = "a valve trace",
                         .columns = {{"time", Dimension::time}, {"opening", Dimension::none}},
                         .by_name = false,
                         .may_lack_head = true,
                         .example_head = "time [ms], opening [1]",
                         .example_row = "4, 0.85"};
  return f;
}

void refuse_holes(const CsvTable& table, std::vector<Problem>& problems) {
  if (table.rows.size() <= kSampled) return;
  std::vector<double> spacing(table.rows.size() - 1);
  for (std::size_t n = 0; n + 1 < table.rows.size(); ++n)
    spacing[n] = table.rows[n + 1][0] - table.rows[n][0];
  std::vector<double> sorted = spacing;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];
  const auto widest = std::max_element(spacing.begin(), spacing.end());
  if (!(*widest > kHole * median)) return;
  const auto n = static_cast<std::size_t>(widest - spacing.begin());
  problems.push_back(table.problem(
      n + 1,
      fmt::format("the trace has a gap from {:.6g} ms to {:.6g} ms, where its samples are {:.3g} ms apart",
                  1e3 * table.rows[n][0], 1e3 * table.rows[n + 1][0], 1e3 * median),
      "samples without a gap"));
}

}  // namespace

ValveTrace read_valve_trace(const std::string& file, std::vector<Problem>& problems) {
  const std::size_t before = problems.size();
  const CsvTable table = read_csv(file, form(), problems);
  ValveTrace trace;
  if (problems.size() > before) return trace;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    const double opening = table.rows[n][1];
    if (!(opening >= 0.0 && opening <= 1.0)) {
      problems.push_back(table.problem(n, fmt::format("the opening {:g} is outside 0 to 1", opening),
                                       "0 (shut) to 1 (fully open), or 0 to 100 %"));
      return trace;
    }
    trace.time.push_back(table.rows[n][0]);
    trace.opening.push_back(opening);
  }
  if (*std::max_element(trace.opening.begin(), trace.opening.end()) == 0.0)
    problems.push_back(table.problem(table.rows.size() - 1, "the valve never opens", "an opening above 0"));
  refuse_holes(table, problems);
  return trace;
}

}  // namespace ejecta
