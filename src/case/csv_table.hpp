#pragma once
#include <string>
#include <vector>

#include "base/units.hpp"
#include "case/problem.hpp"

/// Tables in files beside the case: what a machine recorded or a person drew. The one reader of such files.
namespace ejecta {

/// A column that a table may have.
struct CsvColumn {
  std::string name;
  Dimension dimension = Dimension::none;
};

/// What a table must look like.
struct CsvForm {
  std::string kind;                ///< e.g. "a path"
  std::vector<CsvColumn> columns;  ///< the first is required
  bool ascends = true;             ///< the first goes up from row to row
  bool by_name = true;             ///< else all of them in this order, whatever they are called
  bool may_lack_head = false;      ///< numbers from the first line on are in SI units
  std::string example_head, example_row;
};

/// Rows of numbers in SI units, in the order of CsvForm::columns; 0 in a column that the file does not have.
struct CsvTable {
  std::vector<std::vector<double>> rows;
  std::vector<Place> places;  ///< of the rows
  std::string example_row;    ///< of its form

  /// A problem with the given row.
  Problem problem(std::size_t row, const std::string& what, const std::string& expected) const {
    return {.what = what, .expected = expected, .example = example_row, .place = places.at(row)};
  }
};

/// Reads a file of columns that commas, semicolons or tabs part, below a head that gives each its name and
/// unit: "t [ms], z [mm]", "time (ms);opening (%)". Where semicolons or tabs part them, numbers may have a
/// decimal comma. Blank lines, lines that begin with # and a byte-order mark are passed over. What is wrong
/// goes to `problems`, with its line in that file.
CsvTable read_csv(const std::string& file, const CsvForm& form, std::vector<Problem>& problems);

}  // namespace ejecta
