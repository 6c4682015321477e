#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/cli/commands.hpp"
#include "base/exit_code.hpp"
#include "output/report.hpp"

namespace ejecta {

void add_report(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::filesystem::path> runs;
    std::filesystem::path out;
  };
  CLI::App* command =
      app.add_subcommand("report", "Makes report.html again; several runs are laid over each other");
  auto o = std::make_shared<Options>();
  command->add_option("DIR", o->runs, "Run directories")->required()->type_name("");
  command->add_option("--out", o->out, "File to write (default: report.html in the first directory)")
      ->type_name("FILE");
  command->footer(
      "Examples:\n  ejecta report 10mm-cubic.run\n  ejecta report 10mm-cubic.run 20mm-cubic.run --out "
      "both.html");
  command->callback([o, &action] {
    action = [o] {
      const std::filesystem::path out = o->out.empty() ? o->runs.front() / "report.html" : o->out;
      output::write_report(o->runs, out);
      fmt::print("{}\n", out.string());
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
