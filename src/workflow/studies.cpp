#include "workflow/studies.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/process.hpp"
#include "case/node_path.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/run_directory.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "study/local.hpp"
#include "study/map_result.hpp"
#include "study/slurm.hpp"
#include "workflow/study_run.hpp"

namespace ejecta {
namespace {

FurtherChecks all_checks() {
  return [](const Case& c) { return check_set_up(c); };
}

/// Works on tasks where the options say, until none is left; false: was stopped.
bool work(const StudyOptions& o, const TaskStore& store, std::span<const std::size_t> tasks, int at_once,
          const Attendance& who) {
  const auto look = [&] {
    if (who.look) who.look(store);
  };
  if (o.slurm)
    return run_on_slurm(store, tasks,
                        {.program = o.program, .options = o.sbatch, .stop = who.stop, .look = look});
  return run_locally(
      store, tasks, {.program = o.program, .at_once = at_once, .threads = 1, .stop = who.stop, .look = look});
}

/// True where nothing is left to run.
bool tell_commands(const TaskStore& store, std::span<const std::size_t> tasks, const Attendance& who) {
  const std::vector<TaskState> states = store.states();
  bool finished = true;
  for (const std::size_t task : tasks) {
    const bool open = states[task] == TaskState::waiting || states[task] == TaskState::crashed;
    if (open && who.command)
      who.command(fmt::format("ejecta study run-task {} {}", store.path().string(), task));
    finished = finished && !open && states[task] != TaskState::running;
  }
  return finished;
}

int at_once_of(const StudyOptions& o, const Case& c) {
  return o.at_once > 0 ? o.at_once : runs_side_by_side(c);
}

CampaignHands hands_for(const std::filesystem::path& program, const Attendance& who) {
  return {.load = [](const std::string& path,
                     const std::vector<std::string>& set) { return load_checked(path, set); },
          .command =
              [program, &who](std::vector<std::string> words) {
                words.front() = program.string();
                return run_process(words, who.stop);
              },
          .note = [&who](const std::string& line) { who.tell(line); },
          .result =
              [&who](const std::string& line) {
                if (who.command) who.command(line);
              }};
}

}  // namespace

std::filesystem::path study_directory(const StudyOptions& o, const char* kind) {
  return output::directory_for(o.out, o.path, kind);
}

void collect_study(const TaskStore& store) {
  if (store.header().value("kind", "study") != "study")
    throw InputError(
        fmt::format("{} is a map; `ejecta map CASE` collects it as it goes", store.path().string()));
  const auto result = study_result(store);
  output::write_file(store.path() / "runs.csv", study_table(result));
  store.write_json("result.json", result);
  output::write_study_report("study", result, store.path() / "report.html");
}

StudyEnd compute_study(const StudyOptions& o, const Attendance& who) {
  const Case base = load_checked(o.path, o.overrides);
  const StudySetup setup = set_up_study(case_tree(o.path, o.overrides), base, all_checks());
  const std::filesystem::path directory = study_directory(o, "study");
  TaskStore store = TaskStore::create(directory, setup.header, o.force);
  const std::vector<std::size_t> tasks = store.add(setup.tasks);
  if (o.retry)
    for (const std::size_t task : tasks) store.forget_failure(task);
  if (o.print_commands)
    return tell_commands(store, tasks, who) ? StudyEnd::finished : StudyEnd::commands_left;
  const StudyDriver driver(store);
  store.ask_to_stop(false);
  const int at_once = at_once_of(o, setup.tasks.front().resolved);
  who.tell(fmt::format("{}: {} runs, {} -> {}", o.path, tasks.size(),
                       o.slurm ? "as job arrays" : fmt::format("{} side by side", at_once),
                       directory.string()));
  const bool finished = work(o, store, tasks, at_once, who);
  collect_study(store);
  for (const std::string& sentence : unknown_quantities(store)) who.tell("warning: " + sentence);
  if (!finished) return StudyEnd::stopped;
  return study_status(store).failed > 0 ? StudyEnd::failures : StudyEnd::finished;
}

StudyEnd compute_map(const StudyOptions& o, const Attendance& who) {
  const Case base = load_checked(o.path, o.overrides);
  if (!base.map.enabled)
    throw InputError(fmt::format("{} has no [map]", o.path),
                     {.expected = "the window in which the particle's place varies",
                      .example = "[map] along = [\"-30 mm\", \"20 mm\"], across = [\"-18 mm\", \"18 mm\"]"});
  const std::filesystem::path directory = study_directory(o, "map");
  TaskStore store = TaskStore::create(directory, study_header("map", base), o.force);
  if (o.retry)
    for (std::size_t task = 0; task < store.tasks().size(); ++task) store.forget_failure(task);
  const StudyDriver driver(store);
  store.ask_to_stop(false);
  const int at_once = at_once_of(o, base);
  who.tell(fmt::format("{}: at most {} runs, {} side by side -> {}", o.path, base.map.max_runs, at_once,
                       directory.string()));
  const MapWorkers workers{
      .run =
          [&](const TaskStore& tasks, std::span<const std::size_t> which) {
            return o.print_commands ? tell_commands(tasks, which, who) : work(o, tasks, which, at_once, who);
          },
      .further = all_checks(),
      .place = [tree = case_tree(o.path, o.overrides)](const std::string& key) { return locate(tree, key); },
      .show =
          [&](const nlohmann::ordered_json& result) {
            output::write_study_report("map", result, directory / "report.html");
            who.tell(map_sentence(result));
          },
      .note = [&](const std::string& line) { who.tell(line); }};
  switch (make_map(base, store, workers)) {
    case MapEnd::stopped:
      return o.print_commands ? StudyEnd::commands_left : StudyEnd::stopped;
    case MapEnd::contradicted:
      return StudyEnd::failures;
    default:
      return StudyEnd::finished;
  }
}

int compute_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads,
                  const Attendance& who) {
  const TaskStore store = TaskStore::open(directory);
  if (store.tasks().empty())
    throw InputError(fmt::format("{} has no tasks: its tasks.jsonl is gone", directory),
                     {.expected = "the command that made the study, which writes it again",
                      .example = "ejecta study my-case.toml"});
  for (const std::size_t task : tasks)
    if (task >= store.tasks().size())
      throw InputError(fmt::format("{} has the tasks 0 to {}; there is no task {}", directory,
                                   store.tasks().size() - 1, static_cast<std::ptrdiff_t>(task)));
  int code = exit_done;
  for (const std::size_t task : tasks) {
    switch (perform_task(store, task, threads, run_for_study, who.stop, who.note)) {
      case Performed::done:
      case Performed::was_done:
        break;
      case Performed::runs_elsewhere:
        who.tell(fmt::format("task {} of {} runs in another process", task, directory));
        code = exit_failure;
        break;
      case Performed::stopped:
        return exit_stopped;
      case Performed::diverged:
        who.tell("error: " + store.failure(task));
        code = exit_diverged;
        break;
      case Performed::refused:
        who.tell("error: " + store.failure(task));
        code = exit_bad_input;
    }
  }
  return code;
}

int compute_campaign(const std::string& path, CampaignOptions o, const std::filesystem::path& program,
                     const Attendance& who) {
  const Case c = load_checked(path);
  if (!c.campaign.enabled)
    throw InputError(fmt::format("{} has no [campaign]", path),
                     {.expected = "the cases that belong to it",
                      .example = "[[campaign.part]] kind = \"run\", case = \"10mm-cubic.toml\""});
  o.out = output::directory_for(o.out, path, "campaign").string();
  return run_campaign(c, o, hands_for(program, who));
}

void check_study(const Node& root, const Case& c) { set_up_study(root, c, all_checks()); }

std::string campaign_checked(const Case& c) { return check_campaign(c, hands_for({}, {})); }

}  // namespace ejecta
