#include "app/study_commands.hpp"

#include <fmt/format.h>

#include "app/signals.hpp"
#include "app/teller.hpp"
#include "base/exit_code.hpp"

namespace ejecta {
namespace {

Attendance attendance(Teller& teller, bool quiet) {
  return {
      .note = quiet ? Note{} : Note(print_note),
      .command = print_result,
      .look = [&teller](
                  const TaskStore& store) { teller.tell([&] { return status_line(study_status(store)); }); },
      .stop = stop_on_signal()};
}

/// The end of a study or map as the user sees it: where its results are, or why there are none.
int told(StudyEnd end, const std::filesystem::path& directory, bool quiet, const char* failures) {
  if (end == StudyEnd::commands_left) return exit_done;
  if (end == StudyEnd::stopped) {
    print_note("stopped; go on with the same command");
    return exit_stopped;
  }
  if (!quiet) {
    print_result(fmt::format("results: {}", (directory / "result.json").string()));
    if (std::filesystem::exists(directory / "runs.csv"))
      print_result(fmt::format("table:   {}", (directory / "runs.csv").string()));
    print_result(fmt::format("report:  {}", (directory / "report.html").string()));
  }
  if (end == StudyEnd::finished) return exit_done;
  if (*failures) print_note(failures);
  return exit_failure;
}

}  // namespace

int study_case(const StudyOptions& o, bool quiet) {
  Teller teller(quiet);
  const StudyEnd end = compute_study(o, attendance(teller, quiet));
  const std::filesystem::path directory = study_directory(o, "study");
  if (end != StudyEnd::commands_left && !o.print_commands) {
    const StudyStatus status = study_status(TaskStore::open(directory));
    teller.tell([&] { return status_line(status); }, true);
    if (end != StudyEnd::stopped)
      for (const std::string& line : status.lines) print_note(line);
  }
  return told(end, directory, quiet || o.print_commands, "");
}

int map_case(const StudyOptions& o, bool quiet) {
  Teller nobody(true);  // a map says what it has found instead
  const StudyEnd end = compute_map(o, attendance(nobody, quiet));
  return told(end, study_directory(o, "map"), quiet,
              "error: the map contradicts some of its runs: see \"contradictions\" in the report");
}

int campaign_case(const std::string& path, const CampaignOptions& o) {
  Attendance who{.note = o.quiet ? Note{} : Note(print_note),
                 .command = o.quiet ? Note{} : Note(print_result),
                 .stop = stop_on_signal()};
  const int end = compute_campaign(path, o, this_program(), who);
  if (end == exit_stopped) print_note("stopped; go on with the same command");
  return end;
}

int study_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads) {
  return compute_tasks(directory, tasks, threads, {.note = print_note, .stop = stop_on_signal()});
}

int study_tell(const std::string& directory) {
  const TaskStore store = TaskStore::open(directory);
  const StudyStatus status = study_status(store);
  print_result(fmt::format("{} \"{}\" of {}\n{}", store.header().value("kind", "study"),
                           store.header().value("title", ""), store.header().value("case", ""),
                           status_line(status)));
  for (const std::string& line : status.lines) print_result("  " + line);
  return exit_done;
}

int study_stop(const std::string& directory) {
  TaskStore::open(directory).ask_to_stop(true);
  print_result("asked to stop: runs end with a checkpoint within a second or two");
  return exit_done;
}

int study_collect(const std::string& directory) {
  const TaskStore store = TaskStore::open(directory);
  collect_study(store);
  print_result((store.path() / "result.json").string());
  print_result((store.path() / "runs.csv").string());
  return exit_done;
}

}  // namespace ejecta
