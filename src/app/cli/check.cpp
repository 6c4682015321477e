#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "base/exit_code.hpp"
#include "base/parallel.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "validation/validation.hpp"
#include "workflow/studies.hpp"

namespace ejecta {
void add_check(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> cases, overrides;
    bool json = false;
    int threads = 0;
  };
  CLI::App* command = app.add_subcommand(
      "check", "What a run will be: cells, steps, time, memory, disk, assumptions; runs nothing");
  auto o = std::make_shared<Options>();
  command->add_option("CASE", o->cases, "Case files (.toml)")->required()->type_name("");
  add_overrides(*command, o->overrides);
  add_threads(*command, o->threads);
  command->add_flag("--json", o->json, "For programs: a list of one object a case (docs/files.md)");
  command->footer("Examples:\n  ejecta check cases/paper/*.toml\n  ejecta check my-case.toml --json");
  command->callback([o, &action] {
    action = [o] {
      if (o->threads > 0) set_thread_count(o->threads);
      const double bandwidth = measured_bandwidth();
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      int code = exit_done;
      for (const std::string& path : o->cases) {
        try {
          std::vector<Problem> warnings;
          std::optional<Scene> scene;
          const Case c = load_checked(case_file(path), o->overrides, &warnings, &scene);
          if (c.study.enabled) check_study(case_tree(c.path, o->overrides), c);
          if (c.campaign.enabled) {
            const std::string said = campaign_checked(c);
            if (o->json) list.push_back({{"case", path}, {"problems", nlohmann::ordered_json::array()}});
            else fmt::print("{}\n", said);
          } else if (o->json) list.push_back(check_json(c, *scene, warnings, bandwidth));
          else fmt::print("{}\n", check_report(c, *scene, warnings, bandwidth));
        } catch (const InputError& e) {
          code = exit_bad_input;
          if (o->json) list.push_back({{"case", path}, {"problems", problems_json(problems_of(e))}});
          else print_input_error(e);
        }
      }
      if (o->json) fmt::print("{}\n", list.dump(2));
      return code;
    };
  });
}

}  // namespace ejecta
