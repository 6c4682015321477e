#include "output/history.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/error.hpp"

namespace ejecta::output {
namespace {

std::string header_row(const std::vector<Column>& columns) {
  std::string row = "time [s]";
  for (const Column& c : columns) row += fmt::format(",{} [{}]", c.name, c.unit);
  return row + '\n';
}

/// The next line of `text` with its newline, or nothing when only a torn line is left.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return {};
  const std::string_view line = text.substr(0, end + 1);
  text.remove_prefix(end + 1);
  return line;
}

double to_number(std::string_view cell, const std::filesystem::path& path) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    throw Error(fmt::format("{}: \"{}\" is not a number", path.string(), cell));
  return value;
}

/// Bytes of `path` up to and including the last row not later than `time`.
std::size_t length_until(const std::filesystem::path& path, const std::string& header, double time) {
  const std::string content = read_file(path);
  std::string_view text = content;
  std::string_view line = take_line(text);
  while (line.starts_with('#')) line = take_line(text);
  if (line != header)
    throw Error(fmt::format("{} was written with other columns; it cannot be continued", path.string()));
  std::size_t kept = content.size() - text.size();
  while (!(line = take_line(text)).empty()) {
    if (to_number(line.substr(0, line.find_first_of(",\n")), path) > time) break;
    kept = content.size() - text.size();
  }
  return kept;
}

}  // namespace

HistoryFile::HistoryFile(const std::filesystem::path& path, std::span<const std::string> provenance,
                         std::vector<Column> columns)
    : History(path.string(), std::move(columns)), path_(path), file_(path) {
  std::string head;
  for (const std::string& line : provenance) head += fmt::format("# {}\n", line);
  file_.append(head + header_row(this->columns()));
}

HistoryFile::HistoryFile(const std::filesystem::path& path, std::vector<Column> columns, double time)
    : History(path.string(), std::move(columns)),
      path_(path),
      file_(path, length_until(path, header_row(this->columns()), time)) {}

void History::add(double time, std::span<const double> values) {
  if (values.size() != columns_.size())
    throw Error(fmt::format("{}: {} values for {} columns", name_, values.size(), columns_.size()));
  for (std::size_t n = 0; n < values.size(); ++n)
    if (!std::isfinite(values[n]))
      throw DivergedError(fmt::format("{}: {} is {} at t = {} s", name_, columns_[n].name, values[n], time));
  keep(time, values);
}

HistoryInMemory::HistoryInMemory(std::string name, std::vector<Column> columns)
    : History(std::move(name), std::move(columns)) {
  table_.columns.push_back({"time", "s"});
  for (const Column& c : this->columns()) table_.columns.push_back(c);
  table_.values.resize(table_.columns.size());
}

void HistoryInMemory::keep(double time, std::span<const double> values) {
  table_.values[0].push_back(time);
  for (std::size_t n = 0; n < values.size(); ++n) table_.values[n + 1].push_back(values[n]);
}

void HistoryFile::keep(double time, std::span<const double> values) {
  row_.clear();
  fmt::format_to(std::back_inserter(row_), "{}", time);
  for (const double value : values) fmt::format_to(std::back_inserter(row_), ",{}", value);
  row_ += '\n';
  file_.append(row_);
}

HistoryTable HistoryFile::table() const { return read_history(path_); }

HistoryTable read_history(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  std::string_view text = content;
  std::string_view line = take_line(text);
  while (line.starts_with('#')) line = take_line(text);
  HistoryTable table;
  const auto for_each_cell_of = [](std::string_view row, const auto& take) {
    row.remove_suffix(row.ends_with('\n') ? 1 : 0);
    for (std::size_t begin = 0; begin <= row.size();) {
      const std::size_t end = std::min(row.find(',', begin), row.size());
      take(row.substr(begin, end - begin));
      begin = end + 1;
    }
  };
  for_each_cell_of(line, [&](std::string_view cell) {
    const std::size_t bracket = cell.rfind(" [");
    if (bracket == std::string_view::npos || !cell.ends_with(']'))
      throw Error(fmt::format("{}: the column \"{}\" has no unit", path.string(), cell));
    table.columns.push_back({std::string(cell.substr(0, bracket)),
                             std::string(cell.substr(bracket + 2, cell.size() - bracket - 3))});
  });
  table.values.resize(table.columns.size());
  while (!(line = take_line(text)).empty()) {
    std::size_t n = 0;
    for_each_cell_of(line, [&](std::string_view cell) {
      if (n < table.values.size()) table.values[n].push_back(to_number(cell, path));
      ++n;
    });
    if (n != table.columns.size())
      throw Error(
          fmt::format("{}: a row has {} values for {} columns", path.string(), n, table.columns.size()));
  }
  return table;
}

}  // namespace ejecta::output
