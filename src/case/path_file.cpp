#include "case/path_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>

#include "base/text.hpp"
#include "base/units.hpp"

namespace ejecta {
namespace {

constexpr const char* example_head = "t [ms], x [mm], y [mm], z [mm], rotation [deg]";
const std::vector<std::string> known_columns{"t", "x", "y", "z", "rotation"};

/// One comma-separated cell, without the blanks around it.
struct Cell {
  std::string_view text;
  std::size_t offset = 0;  ///< in the file
};

std::vector<Cell> cells_of(std::string_view line, std::size_t offset) {
  std::vector<Cell> cells;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    std::size_t first = start, last = comma;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t' || line[last - 1] == '\r'))
      --last;
    cells.push_back({line.substr(first, last - first), offset + first});
    start = comma + 1;
  }
  return cells;
}

class PathReader {
 public:
  PathReader(const std::string& file, std::string text, std::vector<Problem>& problems)
      : source_(std::make_shared<Source>(Source{file, std::move(text)})), problems_(problems) {}

  PathTable read() {
    const std::string_view all = source_->text;
    const std::size_t mark = all.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // some editors begin a file with it
    for (std::size_t start = mark; start < all.size() && good_;) {
      const std::size_t end = std::min(all.find('\n', start), all.size());
      const std::string_view line = all.substr(start, end - start);
      if (line.find_first_not_of(" \t\r") != std::string_view::npos && line[0] != '#') {
        const std::vector<Cell> cells = cells_of(line, start);
        if (columns_.empty()) head(cells);
        else row(cells);
      }
      start = end + 1;
    }
    if (good_ && table_.time.size() < 2)
      fail({all.substr(0, 1), 0}, "a path needs at least two rows below its head", "times and places");
    return table_;
  }

 private:
  struct Column {
    std::size_t which;  ///< in known_columns
    double factor;      ///< to SI
  };

  void fail(const Cell& cell, const std::string& what, const std::string& expected,
            const std::string& example = example_head) {
    good_ = false;
    problems_.push_back({.what = what,
                         .expected = expected,
                         .example = example,
                         .place = {source_, cell.offset, std::max<std::size_t>(cell.text.size(), 1)}});
  }

  void head(const std::vector<Cell>& cells) {
    bool has_time = false;
    for (const Cell& cell : cells) {
      const std::size_t open = cell.text.find('['), close = cell.text.find(']');
      if (open == std::string_view::npos || close != cell.text.size() - 1)
        return fail(cell, fmt::format("the column \"{}\" has no unit", cell.text),
                    "a head of names, each with its unit in brackets");
      std::string name(cell.text.substr(0, open));
      while (!name.empty() && name.back() == ' ') name.pop_back();
      const auto known = std::find(known_columns.begin(), known_columns.end(), name);
      if (known == known_columns.end())
        return fail(cell, fmt::format("there is no column \"{}\"", name), "some of " + joined(known_columns));
      const auto which = static_cast<std::size_t>(known - known_columns.begin());
      const Dimension d = which == 0 ? Dimension::time : which == 4 ? Dimension::angle : Dimension::length;
      const std::string unit(cell.text.substr(open + 1, close - open - 1));
      const std::optional<double> factor = to_si(1.0, unit, d);
      if (!factor)
        return fail(cell, fmt::format("\"{}\" is no unit of {}", unit, describe(d)), unit_words(d));
      for (const Column& other : columns_)
        if (other.which == which) return fail(cell, "this column is there already", "each column once");
      columns_.push_back({which, *factor});
      has_time = has_time || which == 0;
    }
    if (!has_time || columns_.size() < 2)
      fail(cells.front(), "a path needs the column t and at least one other", "some of x, y, z, rotation");
  }

  void row(const std::vector<Cell>& cells) {
    const std::string like = "12.5, 0, 0, 3.2, 0";
    if (cells.size() != columns_.size())
      return fail(cells.back(), fmt::format("{} values for {} columns", cells.size(), columns_.size()),
                  "one number for each column, with a decimal point and commas between them", like);
    double time = 0.0, angle = 0.0;
    Vec3 way{0, 0, 0};
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const auto number = parse_number(cells[n].text);
      if (!number) return fail(cells[n], fmt::format("\"{}\" is no number", cells[n].text), "a number", like);
      const double value = *number * columns_[n].factor;
      if (columns_[n].which == 0) {
        time = value;
        if (!table_.time.empty() && !(time > table_.time.back()))
          return fail(cells[n], "the times do not increase", "a time after that of the row before", like);
      } else if (columns_[n].which == 4) {
        angle = value;
      } else {
        way[static_cast<int>(columns_[n].which) - 1] = value;
      }
    }
    table_.time.push_back(time);
    table_.way.push_back(way);
    table_.angle.push_back(angle);
  }

  std::shared_ptr<const Source> source_;
  std::vector<Problem>& problems_;
  std::vector<Column> columns_;
  PathTable table_;
  bool good_ = true;
};

}  // namespace

PathTable read_path_file(const std::string& file, std::vector<Problem>& problems) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) {
    problems.push_back({.what = fmt::format("cannot read \"{}\"", file)});
    return {};
  }
  return PathReader(file, text.str(), problems).read();
}

}  // namespace ejecta
