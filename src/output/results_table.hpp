#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace ejecta::output {

/// A table of words and numbers, e.g. for a spreadsheet.
struct ResultsTable {
  std::vector<std::string> columns;               ///< with their unit, "clearance_at_splitter [m]"
  std::vector<std::vector<nlohmann::json>> rows;  ///< a text, a number or null each
};

/// One row a body of each run: what result.json says of it, lists element by element, and what `--set`
/// changed in the run. Throws InputError for a directory without a result.
ResultsTable results_table(std::span<const std::filesystem::path> runs);

/// As CSV: commas, decimal points, texts in quotes where they need them.
std::string csv_text(const ResultsTable& table);

/// A workbook for Excel or LibreOffice: the sheet "results" and, of one run, a sheet for each of its
/// histories. Numbers are numbers in any language of the spreadsheet. Throws InputError where the program was
/// built without libxlsxwriter.
void write_workbook(std::span<const std::filesystem::path> runs, const std::filesystem::path& file);

/// The one or the other, as the name of the file ends. Throws InputError where it ends with neither.
void write_results(std::span<const std::filesystem::path> runs, const std::filesystem::path& file);

}  // namespace ejecta::output
