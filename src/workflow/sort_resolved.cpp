#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "simulation/sorter_correction.hpp"
#include "study/local.hpp"
#include "study/study.hpp"
#include "workflow/sort.hpp"

namespace ejecta {
namespace {

/// Before the first of them has taken minutes: without those that are refused the others say nothing of all.
void refuse_what_cannot_run(const std::vector<NewTask>& runs) {
  std::size_t refused = 0;
  std::string first;
  for (const NewTask& run : runs)
    for (const Problem& p : check_set_up(run.resolved)) {
      if (p.severity != Severity::error) continue;
      if (refused++ == 0) first = p.key + ": " + p.what;
      break;
    }
  if (refused > 0)
    throw InputError(
        fmt::format("{} of {} shots cannot be computed as runs; {}", refused, runs.size(), first),
        {.expected = "a box and cells that hold every shot of this feed",
         .example = "[grid] refinement = 1.5"});
}

}  // namespace

nlohmann::ordered_json resolve_shots(const Case& c, const Sorter& sorter, const SorterState& state,
                                     const std::filesystem::path& directory, const SortOptions& o,
                                     const Attendance& who) {
  const DrawnShots drawn = draw_shots(c, sorter, state, o.resolved);
  std::vector<NewTask> runs;
  for (const DrawnShots::Run& run : drawn.runs)
    runs.push_back({resolved_case(c, run.shot),
                    {{"cell", run.cell},
                     {"shot", run.which},
                     {"bodies", run.shot.bodies.size()},
                     {"valves", run.shot.valves.size()}}});
  refuse_what_cannot_run(runs);
  TaskStore store = TaskStore::create(directory, study_header("resolved shots", c), false);
  const std::vector<std::size_t> tasks = store.add(runs);
  if (!tasks.empty()) {
    const StudyDriver driver(store);
    store.ask_to_stop(false);
    if (!run_locally(store, tasks,
                     {.program = o.program,
                      .at_once = runs_side_by_side(runs.front().resolved),
                      .threads = 1,
                      .stop = who.stop,
                      .look = {}}))
      return nullptr;
  }
  return corrected_products(c, state, drawn, [&](std::size_t run) -> ResolvedShot {
    const std::size_t task = tasks[run];
    if (store.state(task) != TaskState::done) return {{}, store.failure(task)};
    return {resolved_bodies(store.result(task).at("result")), {}};
  });
}

}  // namespace ejecta
