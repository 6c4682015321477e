#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "output/history.hpp"
#include "output/results_table.hpp"

#ifdef EJECTA_XLSX
#include <xlsxwriter.h>
#endif

namespace ejecta::output {

#ifdef EJECTA_XLSX
namespace {

constexpr std::size_t kMostRows = 1'048'575;  ///< that a sheet holds, below its head

/// A workbook while it is written; the library keeps it in memory until close().
class Workbook {
 public:
  explicit Workbook(const std::filesystem::path& file)
      : file_(file), book_(::workbook_new(file.c_str())), bold_(::workbook_add_format(book_)) {
    ::format_set_bold(bold_);
  }
  ~Workbook() {
    if (book_) ::workbook_close(book_);
  }
  Workbook(const Workbook&) = delete;
  Workbook& operator=(const Workbook&) = delete;

  /// With a head that stays in sight.
  lxw_worksheet* add_sheet(const std::string& name, const std::vector<std::string>& head) {
    lxw_worksheet* sheet = ::workbook_add_worksheet(book_, unique(name).c_str());
    for (std::size_t n = 0; n < head.size(); ++n)
      ::worksheet_write_string(sheet, 0, static_cast<lxw_col_t>(n), head[n].c_str(), bold_);
    ::worksheet_freeze_panes(sheet, 1, 0);
    ::worksheet_set_column(sheet, 0, static_cast<lxw_col_t>(head.size() - 1), 18, nullptr);
    return sheet;
  }
  void close() {
    const lxw_error failed = ::workbook_close(std::exchange(book_, nullptr));
    if (failed != LXW_NO_ERROR)
      throw Error(fmt::format("cannot write {}: {}", file_.string(), ::lxw_strerror(failed)));
  }

 private:
  /// Names of sheets have at most 31 letters and none of []:*?/\.
  std::string unique(std::string name) {
    for (char& c : name)
      if (std::string_view("[]:*?/\\").find(c) != std::string_view::npos) c = '_';
    const std::string start = name.substr(0, 31);
    std::string tried = start;
    for (int n = 2; ::workbook_get_worksheet_by_name(book_, tried.c_str()); ++n)
      tried = fmt::format("{} {}", start.substr(0, 27), n);
    return tried;
  }

  std::filesystem::path file_;
  lxw_workbook* book_;
  lxw_format* bold_;
};

void add_results(Workbook& book, const ResultsTable& table) {
  lxw_worksheet* sheet = book.add_sheet("results", table.columns);
  for (std::size_t r = 0; r < table.rows.size() && r < kMostRows; ++r)
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto row = static_cast<lxw_row_t>(r + 1);
      const auto column = static_cast<lxw_col_t>(c);
      const nlohmann::json& value = table.rows[r][c];
      if (value.is_number()) ::worksheet_write_number(sheet, row, column, value.get<double>(), nullptr);
      else if (value.is_string())
        ::worksheet_write_string(sheet, row, column, value.get<std::string>().c_str(), nullptr);
    }
}

void add_history(Workbook& book, const std::filesystem::path& file) {
  const HistoryTable table = read_history(file);
  std::vector<std::string> head;
  for (const Column& c : table.columns) head.push_back(fmt::format("{} [{}]", c.name, c.unit));
  lxw_worksheet* sheet = book.add_sheet(file.stem().string(), head);
  for (std::size_t c = 0; c < table.values.size(); ++c)
    for (std::size_t r = 0; r < table.values[c].size() && r < kMostRows; ++r)
      ::worksheet_write_number(sheet, static_cast<lxw_row_t>(r + 1), static_cast<lxw_col_t>(c),
                               table.values[c][r], nullptr);
}

}  // namespace

void write_workbook(std::span<const std::filesystem::path> runs, const std::filesystem::path& file) {
  const ResultsTable table = results_table(runs);
  Workbook book(file);
  add_results(book, table);
  std::error_code none;
  if (runs.size() == 1) {
    std::vector<std::filesystem::path> histories;
    for (const auto& entry : std::filesystem::directory_iterator(runs[0] / "history", none))
      if (entry.path().extension() == ".csv") histories.push_back(entry.path());
    std::sort(histories.begin(), histories.end());
    for (const auto& history : histories) add_history(book, history);
  }
  book.close();
}
#else
void write_workbook(std::span<const std::filesystem::path>, const std::filesystem::path&) {
  throw InputError(
      "this program was built without workbooks of Excel\n  expected: libxlsxwriter-dev installed when it is "
      "built, or "
      "a table as .csv\n  example:  --out results.csv");
}
#endif

}  // namespace ejecta::output
