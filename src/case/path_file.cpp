#include "case/path_file.hpp"

#include "case/csv_table.hpp"

namespace ejecta {

PathTable read_path_file(const std::string& file, std::vector<Problem>& problems) {
  using enum Dimension;
  static const CsvForm form{
      .kind = "a path",
      .columns = {{"t", time}, {"x", length}, {"y", length}, {"z", length}, {"rotation", angle}},
      .example_head = "t [ms], x [mm], y [mm], z [mm], rotation [deg]",
      .example_row = "12.5, 0, 0, 3.2, 0"};
  PathTable path;
  for (const std::vector<double>& row : read_csv(file, form, problems).rows) {
    path.time.push_back(row[0]);
    path.way.emplace_back(row[1], row[2], row[3]);
    path.angle.push_back(row[4]);
  }
  return path;
}

}  // namespace ejecta
