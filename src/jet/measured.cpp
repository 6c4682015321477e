#include "jet/measured.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "case/csv_table.hpp"

namespace ejecta {

MeasuredCurve read_measured(const std::filesystem::path& file, Dimension position,
                            std::vector<Problem>& problems) {
  const bool over_time = position == Dimension::time;
  const CsvForm form{.kind = "a measured curve",
                     .columns = {{over_time ? "time" : "z", position}, {"total_gauge", Dimension::pressure}},
                     .by_name = false,
                     .example_head = over_time ? "time [ms], total_gauge [kPa]" : "z [mm], total_gauge [kPa]",
                     .example_row = "75, 9.5"};
  MeasuredCurve curve;
  for (const std::vector<double>& row : read_csv(file.string(), form, problems).rows) {
    curve.x.push_back(row[0]);
    curve.y.push_back(row[1]);
  }
  return curve;
}

MeasuredCurve read_measured(const std::filesystem::path& file, Dimension position) {
  std::vector<Problem> problems;
  const MeasuredCurve curve = read_measured(file, position, problems);
  if (!problems.empty()) throw CaseError(problems);
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
