#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/output_file.hpp"

namespace ejecta::output {

/// Name and unit of a column; unit "1" for a plain number.
struct Column {
  std::string name, unit;
};

/// A CSV time series: `#` lines of provenance, a header `time [s],force_x [N],...`, then one row a moment.
/// Several rows may share a time (lines). Numbers are written so that reading them gives the same bits.
/// Every row reaches the system at once, so a killed run leaves whole lines.
class HistoryFile {
 public:
  /// Starts a new file. The columns are those after time.
  HistoryFile(const std::filesystem::path& path, std::span<const std::string> provenance,
              std::vector<Column> columns);
  /// Goes on with an existing file after removing every row later than `time`, s. Throws Error when its
  /// columns are not these.
  HistoryFile(const std::filesystem::path& path, std::vector<Column> columns, double time);

  /// A value that is not finite throws DivergedError with the column and the time.
  void add(double time, std::span<const double> values);
  const std::vector<Column>& columns() const { return columns_; }

 private:
  std::string name_;
  std::vector<Column> columns_;
  LineFile file_;
  std::string row_;
};

/// A history as read back; torn last lines are ignored.
struct HistoryTable {
  std::vector<Column> columns;              ///< the first is time
  std::vector<std::vector<double>> values;  ///< one vector a column
};
HistoryTable read_history(const std::filesystem::path& path);

}  // namespace ejecta::output
