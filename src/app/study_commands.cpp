#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "app/signals.hpp"
#include "app/study_runs.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/stopwatch.hpp"
#include "case/node_path.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "study/local.hpp"
#include "study/map.hpp"
#include "study/map_result.hpp"
#include "study/slurm.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

FurtherChecks all_checks() {
  return [](const Case& c) { return check_bodies(c); };
}

/// Says every few seconds how far a study is.
class Teller {
 public:
  Teller(const TaskStore& store, bool quiet) : store_(store), quiet_(quiet), terminal_(::isatty(2) == 1) {}
  void tell(bool last = false) {
    const double now = wall_seconds(), interval = terminal_ ? 1.0 : 10.0;
    if (quiet_ || (!last && now - said_ < interval)) return;
    said_ = now;
    const std::string line = status_line(study_status(store_));
    if (terminal_) fmt::print(stderr, "\r\x1b[K{}{}", line, last ? "\n" : "");
    else fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
  }

 private:
  const TaskStore& store_;
  bool quiet_, terminal_;
  double said_ = wall_seconds();
};

/// Works on tasks where the options say, until none is left; false: was stopped.
bool work(const StudyOptions& o, const TaskStore& store, std::span<const std::size_t> tasks, int at_once,
          const SignalWatch& signals, const std::function<void()>& look) {
  const auto stop = [&] { return signals.stop_requested(); };
  if (o.slurm)
    return run_on_slurm(store, tasks,
                        {.program = this_program(), .options = o.sbatch, .stop = stop, .look = look});
  return run_locally(
      store, tasks,
      {.program = this_program(), .at_once = at_once, .threads = 1, .stop = stop, .look = look});
}

void write_collected(const TaskStore& store) {
  const auto result = study_result(store);
  output::write_file(store.path() / "runs.csv", study_table(result));
  store.write_json("result.json", result);
  output::write_study_report("study", result, store.path() / "report.html");
}

/// True where nothing is left to run.
bool print_commands(const TaskStore& store, std::span<const std::size_t> tasks) {
  const std::vector<TaskState> states = store.states();
  bool finished = true;
  for (const std::size_t task : tasks) {
    const bool open = states[task] == TaskState::waiting || states[task] == TaskState::crashed;
    if (open) fmt::print("ejecta study run-task {} {}\n", store.path().string(), task);
    finished = finished && !open && states[task] != TaskState::running;
  }
  return finished;
}

/// Runs this program with these words, which has the terminal; what asks us to stop asks it too. Its exit
/// code.
int run_this_program(std::vector<std::string> words, const SignalWatch& signals) {
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  const std::string program = this_program().string();
  const pid_t child = ::fork();
  if (child < 0) throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) {
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  bool asked = false;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (signals.stop_requested() && !asked) {
      ::kill(child, SIGTERM);
      asked = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (asked) return exit_stopped;
  return WIFEXITED(status) ? WEXITSTATUS(status) : exit_failure;
}

CampaignHands hands_for(const SignalWatch& signals, bool quiet) {
  return {
      .load = [](const std::string& path,
                 const std::vector<std::string>& set) { return load_checked(path, set); },
      .command = [&](std::vector<std::string> words) { return run_this_program(std::move(words), signals); },
      .note =
          [quiet](const std::string& line) {
            if (!quiet) fmt::print(stderr, "{}\n", line);
          },
      .result =
          [quiet](const std::string& line) {
            if (!quiet) fmt::print("{}\n", line);
          }};
}

}  // namespace

int study_case(const StudyOptions& o) {
  const Case base = load_checked(o.path, o.overrides);
  StudySetup setup = set_up_study(case_tree(o.path, o.overrides), base, all_checks());
  const std::filesystem::path directory =
      o.out.empty() ? std::filesystem::path(o.path).stem().string() + ".study" : o.out;
  TaskStore store = TaskStore::create(directory, setup.header, o.force);
  const std::vector<std::size_t> tasks = store.add(setup.tasks);
  if (o.retry)
    for (const std::size_t task : tasks) store.forget_failure(task);
  if (o.print_commands) {
    print_commands(store, tasks);
    return exit_done;
  }
  const StudyDriver driver(store);
  store.ask_to_stop(false);
  const int at_once = o.at_once > 0 ? o.at_once : runs_side_by_side(setup.tasks.front().resolved);
  Teller teller(store, o.quiet);
  if (!o.quiet)
    fmt::print(stderr, "{}: {} runs, {} -> {}\n", o.path, tasks.size(),
               o.slurm ? "as job arrays" : fmt::format("{} side by side", at_once), directory.string());
  SignalWatch signals;
  const bool finished = work(o, store, tasks, at_once, signals, [&] { teller.tell(); });
  teller.tell(true);
  write_collected(store);
  const StudyStatus status = study_status(store);
  if (!finished) {
    fmt::print(stderr, "stopped; go on with the same command\n");
    return exit_stopped;
  }
  for (const std::string& line : status.lines) fmt::print(stderr, "{}\n", line);
  if (!o.quiet)
    fmt::print("results: {}\ntable:   {}\nreport:  {}\n", (directory / "result.json").string(),
               (directory / "runs.csv").string(), (directory / "report.html").string());
  return status.failed > 0 ? exit_failure : exit_done;
}

int map_case(const StudyOptions& o) {
  const Case base = load_checked(o.path, o.overrides);
  if (!base.map.enabled)
    throw InputError(
        fmt::format("{} has no [map]\n  expected: the window in which the particle's place varies\n"
                    "  example:  [map] along = [\"-30 mm\", \"20 mm\"], across = [\"-18 mm\", \"18 mm\"]",
                    o.path));
  const std::filesystem::path directory =
      o.out.empty() ? std::filesystem::path(o.path).stem().string() + ".map" : o.out;
  TaskStore store = TaskStore::create(directory, study_header("map", base), o.force);
  if (o.retry)
    for (std::size_t task = 0; task < store.tasks().size(); ++task) store.forget_failure(task);
  const StudyDriver driver(store);
  store.ask_to_stop(false);
  const int at_once = o.at_once > 0 ? o.at_once : runs_side_by_side(base);
  if (!o.quiet)
    fmt::print(stderr, "{}: at most {} runs, {} side by side -> {}\n", o.path, base.map.max_runs, at_once,
               directory.string());
  SignalWatch signals;
  const auto note = [&](const std::string& line) {
    if (!o.quiet) fmt::print(stderr, "{}\n", line);
  };
  MapWorkers workers;
  workers.run = [&](const TaskStore& tasks, std::span<const std::size_t> which) {
    if (o.print_commands) return print_commands(tasks, which);
    return work(o, tasks, which, at_once, signals, {});
  };
  workers.further = all_checks();
  workers.place = [tree = case_tree(o.path, o.overrides)](const std::string& key) {
    return locate(tree, key);
  };
  workers.show = [&](const nlohmann::ordered_json& result) {
    output::write_study_report("map", result, directory / "report.html");
    note(map_sentence(result));
  };
  workers.note = note;
  const MapEnd end = make_map(base, store, workers);
  if (end == MapEnd::stopped) {
    if (!o.print_commands) fmt::print(stderr, "stopped; go on with the same command\n");
    return exit_stopped;
  }
  if (!o.quiet)
    fmt::print("results: {}\nreport:  {}\n", (directory / "result.json").string(),
               (directory / "report.html").string());
  if (end == MapEnd::contradicted) {
    fmt::print(stderr, "error: the map contradicts some of its runs: see \"contradictions\" in the report\n");
    return exit_failure;
  }
  return exit_done;
}

int campaign_case(const std::string& path, CampaignOptions o) {
  const Case c = load_checked(path);
  if (!c.campaign.enabled)
    throw InputError(
        fmt::format("{} has no [campaign]\n  expected: the cases that belong to it\n"
                    "  example:  [[campaign.part]] kind = \"run\", case = \"10mm-cubic.toml\"",
                    path));
  if (o.out.empty()) o.out = std::filesystem::path(path).stem().string() + ".campaign";
  const SignalWatch signals;
  const int end = run_campaign(c, o, hands_for(signals, o.quiet));
  if (end == exit_stopped) fmt::print(stderr, "stopped; go on with the same command\n");
  return end;
}

std::string campaign_checked(const Case& c) {
  const SignalWatch signals;
  return check_campaign(c, hands_for(signals, true));
}

int study_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads) {
  const TaskStore store = TaskStore::open(directory);
  for (const std::size_t task : tasks)
    if (task >= store.tasks().size())
      throw InputError(fmt::format("{} has the tasks 0 to {}; there is no task {}", directory,
                                   store.tasks().size() - 1, task));
  std::optional<SignalWatch> signals;  // until the first step a signal ends the program at once
  const auto stop = [&] {
    if (!signals) signals.emplace();
    return signals->stop_requested();
  };
  const auto note = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  int code = exit_done;
  for (const std::size_t task : tasks) {
    switch (perform_task(store, task, threads, run_for_study, stop, note)) {
      case Performed::done:
      case Performed::was_done:
        break;
      case Performed::runs_elsewhere:
        note(fmt::format("task {} of {} runs in another process", task, directory));
        code = exit_failure;
        break;
      case Performed::stopped:
        return exit_stopped;
      case Performed::diverged:
        note("error: " + store.failure(task));
        code = exit_diverged;
        break;
      case Performed::refused:
        note("error: " + store.failure(task));
        code = exit_bad_input;
    }
  }
  return code;
}

int study_tell(const std::string& directory) {
  const TaskStore store = TaskStore::open(directory);
  const StudyStatus status = study_status(store);
  fmt::print("{} \"{}\" of {}\n{}\n", store.header().value("kind", "study"),
             store.header().value("title", ""), store.header().value("case", ""), status_line(status));
  for (const std::string& line : status.lines) fmt::print("  {}\n", line);
  return exit_done;
}

int study_stop(const std::string& directory) {
  TaskStore::open(directory).ask_to_stop(true);
  fmt::print("asked to stop: runs end with a checkpoint within a second or two\n");
  return exit_done;
}

int study_collect(const std::string& directory) {
  const TaskStore store = TaskStore::open(directory);
  if (store.header().value("kind", "study") != "study")
    throw InputError(fmt::format("{} is a map; `ejecta map CASE` collects it as it goes", directory));
  write_collected(store);
  fmt::print("{}\n{}\n", (store.path() / "result.json").string(), (store.path() / "runs.csv").string());
  return exit_done;
}

}  // namespace ejecta
