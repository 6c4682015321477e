#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/study_commands.hpp"
#include "app/teller.hpp"

/// The commands that run a case many times: study, map; and many cases: campaign.
namespace ejecta {
namespace {

struct StudyCommand {
  StudyOptions study{.program = this_program()};
  bool quiet = false;
};

void add_study_options(CLI::App& command, StudyCommand& c, bool required) {
  StudyOptions& o = c.study;
  CLI::Option* path = command.add_option("CASE", o.path, "Case file (.toml)")->type_name("");
  if (required) path->required();
  add_overrides(command, o.overrides);
  command
      .add_option("--out", o.out,
                  "Directory (default: the name of the case with ." + command.get_name() + ")")
      ->type_name("DIR");
  command
      .add_option("--at-once", o.at_once, "Runs side by side (default: as many as cores and memory allow)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096).description(""));
  command.add_flag("--force", o.force, "Start anew in that directory");
  command.add_flag("--retry", o.retry, "Also run again what diverged or was refused");
  command.add_flag("--print-commands", o.print_commands,
                   "Run nothing; print the commands that are left, for any scheduler");
  command.add_flag("--slurm", o.slurm, "Run the tasks as job arrays of this machine's SLURM cluster");
  command.add_option("--sbatch", o.sbatch, "Option of sbatch, e.g. --sbatch=--time=2:00:00; may be repeated")
      ->type_name("OPTION")
      ->expected(1)
      ->take_all();
  command.add_flag("-q,--quiet", c.quiet, "Print nothing but errors");
}

/// A command of `ejecta study` that takes the directory of a study.
CLI::App* add_for_directory(CLI::App& study, Action& action, const char* name, const char* help,
                            int (*act)(const std::string&)) {
  CLI::App* command = study.add_subcommand(name, help);
  auto directory = std::make_shared<std::string>();
  command->add_option("DIR", *directory, "Directory of the study or map")->required()->type_name("");
  command->callback([directory, act, &action] { action = [directory, act] { return act(*directory); }; });
  return command;
}

}  // namespace

void add_study(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("study", "Runs a case many times, as its [study] says");
  command->get_formatter()->label("SUBCOMMAND", "COMMAND");
  auto o = std::make_shared<StudyCommand>();
  add_study_options(*command, *o, false);
  command->require_subcommand(0, 1);
  add_for_directory(*command, action, "status", "How far a study is, what runs and what failed", study_tell);
  add_for_directory(*command, action, "stop", "Asks whoever works on it to stop", study_stop);
  add_for_directory(*command, action, "collect", "Writes runs.csv and result.json of what is done",
                    study_collect);
  struct Task {
    std::string directory;
    std::vector<std::size_t> indices;
    int threads = 1;
  };
  auto task = std::make_shared<Task>();
  CLI::App* one = command->add_subcommand("run-task", "Runs tasks that are not done: what schedulers call");
  one->add_option("DIR", task->directory, "Directory of the study or map")->required()->type_name("");
  one->add_option("INDEX", task->indices, "Numbers of tasks, from 0")->required()->type_name("");
  one->add_option("--threads", task->threads, "Threads (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
  one->callback([task, &action] {
    action = [task] { return study_tasks(task->directory, task->indices, task->threads); };
  });
  for (CLI::App* one_of : command->get_subcommands([](const CLI::App*) { return true; }))
    one_of->group("Commands");
  command->footer(
      "A study that was stopped, or killed, goes on when the same command is given again.\n\n"
      "Examples:\n  ejecta study pressures.toml\n  ejecta study status pressures.study\n"
      "  ejecta study pressures.toml --print-commands");
  command->callback([command, o, &action] {
    if (!command->get_subcommands().empty()) return;
    if (o->study.path.empty()) throw CLI::RequiredError("CASE");
    action = [o] { return study_case(o->study, o->quiet); };
  });
}

void add_map(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("map", "Finds the places around the jet from which a particle is ejected ([map])");
  auto o = std::make_shared<StudyCommand>();
  add_study_options(*command, *o, true);
  command->footer(
      "The report is written after every few runs. A map that was stopped, or killed, goes on when the same\n"
      "command is given again; `ejecta study status DIR` says how far it is.\n\n"
      "Example:\n  ejecta map cases/paper/maps/10mm-cubic.toml");
  command->callback([o, &action] { action = [o] { return map_case(o->study, o->quiet); }; });
}

void add_campaign(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "campaign", "Runs a programme of runs, jets, maps and studies, with one report ([campaign])");
  auto o = std::make_shared<CampaignOptions>();
  auto path = std::make_shared<std::string>();
  command->add_option("CASE", *path, "Case file (.toml)")->required()->type_name("");
  command->add_option("--out", o->out, "Directory (default: the name of the case with .campaign)")
      ->type_name("DIR");
  command->add_flag("--force", o->force, "Start anew in that directory");
  command->add_flag("--print-commands", o->print_commands, "Run nothing; print the commands that are left");
  command->add_flag("-q,--quiet", o->quiet, "Print nothing but errors");
  command->footer(
      "Parts that are done stay: a campaign that was stopped goes on when the same command is given "
      "again.\n\n"
      "Example:\n  ejecta campaign cases/paper/programme.toml");
  command->callback([path, o, &action] { action = [path, o] { return campaign_case(*path, *o); }; });
}

}  // namespace ejecta
