#pragma once
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/output_file.hpp"

namespace ejecta::output {

/// Name and unit of a column; unit "1" for a plain number.
struct Column {
  std::string name, unit;
};

/// Name, unit and values of each column; the first is time.
struct HistoryTable {
  std::vector<Column> columns;
  std::vector<std::vector<double>> values;  ///< one vector a column
};

/// As history/NAME.csv would be named.
using NamedHistories = std::map<std::string, HistoryTable>;

/// A time series that a run records row by row. Several rows may share a time (lines).
class History {
 public:
  virtual ~History() = default;
  /// A value that is not finite throws DivergedError with the column and the time.
  void add(double time, std::span<const double> values);
  /// Those after time.
  const std::vector<Column>& columns() const { return columns_; }
  /// What was recorded so far.
  virtual HistoryTable table() const = 0;

 protected:
  History(std::string name, std::vector<Column> columns)
      : name_(std::move(name)), columns_(std::move(columns)) {}

 private:
  virtual void keep(double time, std::span<const double> values) = 0;
  std::string name_;  ///< for messages
  std::vector<Column> columns_;
};

/// Kept in memory.
class HistoryInMemory : public History {
 public:
  /// The columns are those after time.
  HistoryInMemory(std::string name, std::vector<Column> columns);
  HistoryTable table() const override { return table_; }

 private:
  void keep(double time, std::span<const double> values) override;
  HistoryTable table_;
};

/// Kept as a CSV file: `#` lines of provenance, a header `time [s],force_x [N],...`, then one row a moment.
/// Numbers are written so that reading them gives the same bits.
/// Every row reaches the system at once, so a killed run leaves whole lines.
class HistoryFile : public History {
 public:
  /// Starts a new file. The columns are those after time.
  HistoryFile(const std::filesystem::path& path, std::span<const std::string> provenance,
              std::vector<Column> columns);
  /// Goes on with an existing file after removing every row later than `time`, s. Throws Error when its
  /// columns are not these.
  HistoryFile(const std::filesystem::path& path, std::vector<Column> columns, double time);

  HistoryTable table() const override;

 private:
  void keep(double time, std::span<const double> values) override;
  std::filesystem::path path_;
  LineFile file_;
  std::string row_;
};

/// A history as read back; torn last lines are ignored.
HistoryTable read_history(const std::filesystem::path& path);

}  // namespace ejecta::output
