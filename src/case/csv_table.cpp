#include "case/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>

#include "base/text.hpp"

namespace ejecta {
namespace {

/// One cell, without the blanks and quotes around it.
struct Cell {
  std::string_view text;
  std::size_t offset = 0;  ///< in the file
};

std::vector<Cell> cells_of(std::string_view line, std::size_t offset, char separator) {
  constexpr std::string_view around = " \t\r\"";
  std::vector<Cell> cells;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t end = std::min(line.find(separator, start), line.size());
    std::size_t first = start, last = end;
    while (first < last && around.find(line[first]) != std::string_view::npos) ++first;
    while (last > first && around.find(line[last - 1]) != std::string_view::npos) --last;
    cells.push_back({line.substr(first, last - first), offset + first});
    start = end + 1;
  }
  return cells;
}

/// "ms" of "t [ms]", "t (ms)" or "t / ms", and what stands before it.
struct Head {
  std::string name;
  std::optional<std::string> unit;
};

Head head_of(std::string_view cell) {
  for (const char* around : {"[]", "()"})
    if (const auto open = cell.find(around[0]); open != std::string_view::npos && cell.back() == around[1]) {
      std::string name(cell.substr(0, open));
      name.erase(name.find_last_not_of(" \t") + 1);
      return {name, std::string(cell.substr(open + 1, cell.size() - open - 2))};
    }
  if (const auto slash = cell.find('/'); slash != std::string_view::npos && slash > 0) {
    std::string name(cell.substr(0, slash)), unit(cell.substr(slash + 1));
    name.erase(name.find_last_not_of(" \t") + 1);
    unit.erase(0, std::min(unit.find_first_not_of(" \t"), unit.size()));
    return {name, unit};
  }
  return {std::string(cell), std::nullopt};
}

/// Factor to SI; a share may be given in per cent.
std::optional<double> factor_of(const std::optional<std::string>& unit, Dimension d) {
  if (d == Dimension::none) {
    if (!unit || unit->empty() || *unit == "1" || *unit == "-") return 1.0;
    return *unit == "%" ? std::optional(0.01) : std::nullopt;
  }
  if (!unit) return std::nullopt;
  if (const auto factor = to_si(1.0, *unit, d)) return factor;
  // A curve of gauge pressure is a difference to the ambient one.
  return d == Dimension::pressure ? to_si(1.0, *unit, Dimension::pressure_gauge) : std::nullopt;
}

class CsvReader {
 public:
  CsvReader(const std::string& file, std::string text, const CsvForm& form, std::vector<Problem>& problems)
      : source_(std::make_shared<Source>(Source{file, std::move(text)})), form_(form), problems_(problems) {
    table_.example_row = form.example_row;
  }

  CsvTable read() {
    const std::string_view all = source_->text;
    if (all.starts_with("\xFF\xFE") || all.starts_with("\xFE\xFF")) {
      fail({all.substr(0, 2), 0}, "the file is UTF-16", "a text in UTF-8", form_.example_head);
      return {};
    }
    const std::size_t mark = all.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // some editors begin a file with it
    for (std::size_t start = mark; start < all.size() && good_;) {
      const std::size_t end = std::min(all.find_first_of("\n\r", start), all.size());
      const std::string_view line = all.substr(start, end - start);
      if (line.find_first_not_of(" \t") != std::string_view::npos && line[0] != '#') take(line, start);
      start = end + 1;
    }
    if (good_ && table_.rows.size() < 2)
      fail({all.substr(0, 1), 0}, fmt::format("{} needs at least two rows below its head", form_.kind),
           "rows of numbers", form_.example_head);
    return table_;
  }

 private:
  struct Column {
    std::size_t which;  ///< in form_.columns
    double factor;      ///< to SI
  };

  void fail(const Cell& cell, const std::string& what, const std::string& expected,
            const std::string& example) {
    good_ = false;
    problems_.push_back({.what = what,
                         .expected = expected,
                         .example = example,
                         .place = {source_, cell.offset, std::max<std::size_t>(cell.text.size(), 1)}});
  }
  void fail_head(const Cell& cell, const std::string& what, const std::string& expected) {
    fail(cell, what, expected, form_.example_head);
  }

  void take(std::string_view line, std::size_t start) {
    if (columns_.empty()) {
      separator_ = line.find(';') != std::string_view::npos    ? ';'
                   : line.find('\t') != std::string_view::npos ? '\t'
                                                               : ',';
      const std::vector<Cell> cells = cells_of(line, start, separator_);
      const bool numbers =
          std::all_of(cells.begin(), cells.end(), [&](const Cell& c) { return number(c.text).has_value(); });
      if (!numbers) return head(cells);
      if (!form_.may_lack_head)
        return fail_head(cells.front(), "the first line has numbers, not a head",
                         "a head of names, each with its unit in brackets");
      for (std::size_t n = 0; n < form_.columns.size(); ++n) columns_.push_back({n, 1.0});
      return row(cells);
    }
    row(cells_of(line, start, separator_));
  }

  void head(const std::vector<Cell>& cells) {
    if (!form_.by_name && cells.size() != form_.columns.size())
      return fail_head(
          cells.front(),
          fmt::format("{} has {} columns, this has {}", form_.kind, form_.columns.size(), cells.size()),
          "a head of names, each with its unit in brackets");
    for (const Cell& cell : cells) {
      if (cell.text.empty())
        return fail_head(cell, "a column without a name", "a head of names, each with its unit in brackets");
      const Head h = head_of(cell.text);
      std::size_t which = columns_.size();
      if (form_.by_name) {
        std::vector<std::string> names;
        for (const CsvColumn& c : form_.columns) names.push_back(c.name);
        const auto known = std::find(names.begin(), names.end(), h.name);
        if (h.unit && known == names.end())
          return fail_head(cell, fmt::format("there is no column \"{}\"", h.name),
                           "some of " + joined(names));
        which = static_cast<std::size_t>(known - names.begin());
      }
      const Dimension d = which < form_.columns.size() ? form_.columns[which].dimension : Dimension::length;
      if (!h.unit && d != Dimension::none)
        return fail_head(cell, fmt::format("the column \"{}\" has no unit", cell.text),
                         "a head of names, each with its unit in brackets");
      const std::optional<double> factor = factor_of(h.unit, d);
      if (!factor)
        return fail_head(cell, fmt::format("\"{}\" is no unit of {}", *h.unit, describe(d)),
                         d == Dimension::none ? "1 or %" : unit_words(d));
      for (const Column& other : columns_)
        if (other.which == which) return fail_head(cell, "this column is there already", "each column once");
      columns_.push_back({which, *factor});
    }
    if (columns_.size() < 2 ||
        std::none_of(columns_.begin(), columns_.end(), [](const Column& c) { return c.which == 0; })) {
      std::vector<std::string> others;
      for (std::size_t n = 1; n < form_.columns.size(); ++n) others.push_back(form_.columns[n].name);
      fail_head(
          cells.front(),
          fmt::format("{} needs the column {} and at least one other", form_.kind, form_.columns[0].name),
          "some of " + joined(others));
    }
  }

  std::optional<double> number(std::string_view text) const {
    std::string point(text);
    if (separator_ != ',' && text.find('.') == std::string_view::npos)
      std::replace(point.begin(), point.end(), ',', '.');
    return parse_number(point);
  }

  void row(const std::vector<Cell>& cells) {
    if (cells.size() != columns_.size())
      return fail(
          cells.back(), fmt::format("{} values for {} columns", cells.size(), columns_.size()),
          "one number for each column, with a decimal point and commas between them, or with semicolons "
          "between them",
          form_.example_row);
    std::vector<double> values(form_.columns.size(), 0.0);
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const auto value = number(cells[n].text);
      if (!value)
        return fail(cells[n], fmt::format("\"{}\" is no number", cells[n].text), "a number",
                    form_.example_row);
      values[columns_[n].which] = *value * columns_[n].factor;
      if (form_.ascends && columns_[n].which == 0 && !table_.rows.empty() &&
          !(values[0] > table_.rows.back()[0]))
        return fail(cells[n], fmt::format("the column {} does not increase", form_.columns[0].name),
                    "a number above that of the row before", form_.example_row);
    }
    table_.rows.push_back(std::move(values));
    const std::size_t end = cells.back().offset + cells.back().text.size();
    table_.places.push_back({source_, cells.front().offset, end - cells.front().offset});
  }

  std::shared_ptr<const Source> source_;
  const CsvForm& form_;
  std::vector<Problem>& problems_;
  char separator_ = ',';
  std::vector<Column> columns_;
  CsvTable table_;
  bool good_ = true;
};

}  // namespace

CsvTable read_csv(const std::string& file, const CsvForm& form, std::vector<Problem>& problems) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) {
    problems.push_back({.what = fmt::format("cannot read \"{}\"", file), .expected = form.kind});
    return {};
  }
  return CsvReader(file, text.str(), form, problems).read();
}

}  // namespace ejecta
