#include "case/outline_file.hpp"

#include "case/csv_table.hpp"

namespace ejecta {

std::vector<std::array<double, 2>> read_outline_file(const std::string& file,
                                                     std::vector<Problem>& problems) {
  static const CsvForm form{.kind = "an outline",
                            .columns = {{"x", Dimension::length}, {"y", Dimension::length}},
                            .ascends = false,
                            .by_name = false,
                            .example_head = "x [mm], y [mm]",
                            .example_row = "-12, 3.5"};
  const std::size_t before = problems.size();
  std::vector<std::array<double, 2>> corners;
  for (const std::vector<double>& row : read_csv(file, form, problems).rows)
    corners.push_back({row[0], row[1]});
  if (problems.size() == before && corners.size() < 3)
    problems.push_back({.key = "map.measured",
                        .what = file + " has fewer than three corners",
                        .expected = "the corners of the outline, in order"});
  return corners;
}

}  // namespace ejecta
