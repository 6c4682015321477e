#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/commands.hpp"
#include "base/exit_code.hpp"
#include "output/output_file.hpp"
#include "output/paraview_view.hpp"
#include "output/results_table.hpp"

/// The commands that hand runs to other programs: table, paraview.
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
      output::write_results(o->runs, o->out);
      fmt::print("{}\n", o->out.string());
      return int{exit_done};
    };
  });
}

void add_paraview(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("paraview", "Writes a view of a run for ParaView: air, bodies, colours, camera");
  auto run = std::make_shared<std::filesystem::path>();
  command->add_option("DIR", *run, "Run directory")->required()->type_name("");
  command->footer("Example:\n  ejecta paraview tutorial.run\n  paraview --script=tutorial.run/view.py");
  command->callback([run, &action] {
    action = [run] {
      const std::filesystem::path file = *run / "view.py";
      output::write_file(file, output::paraview_view(*run));
      fmt::print("{}\nopen it with  paraview --script={}\n", file.string(), file.string());
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
