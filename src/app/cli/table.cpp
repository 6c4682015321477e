#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/commands.hpp"
#include "app/exit_code.hpp"
#include "output/output_file.hpp"
#include "output/results_table.hpp"

namespace ejecta {

void add_table(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::filesystem::path> runs;
    std::filesystem::path out = "results.csv";
  };
  CLI::App* command =
      app.add_subcommand("table", "The results of runs as one table for Excel, pandas and others");
  auto o = std::make_shared<Options>();
  command->add_option("DIR", o->runs, "Run directories")->required()->type_name("");
  command->add_option("--out", o->out, "File to write, .csv or .xlsx (default: results.csv)")
      ->type_name("FILE");
  command->footer(
      "One row a body of each run, with what --set changed. A workbook (.xlsx) has the histories of a single "
      "run too, and its "
      "numbers\nare numbers whatever the decimal sign of the spreadsheet.\n\n"
      "Examples:\n  ejecta table *.run\n  ejecta table 10mm-cubic.run --out 10mm-cubic.xlsx");
  command->callback([o, &action] {
    action = [o] {
      if (o->out.extension() == ".xlsx") output::write_workbook(o->runs, o->out);
      else if (o->out.extension() == ".csv")
        output::write_file(o->out, output::csv_text(output::results_table(o->runs)));
      else
        throw InputError(
            fmt::format("\"{}\" is no table\n  expected: a name that ends with .csv or .xlsx\n"
                        "  example:  --out results.xlsx",
                        o->out.string()));
      fmt::print("{}\n", o->out.string());
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
