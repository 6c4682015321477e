#include <filesystem>

#include "simulation/forecast.hpp"
#include "simulation/sorter_correction.hpp"
#include "study/local.hpp"
#include "study/study.hpp"
#include "workflow/sort.hpp"

namespace ejecta {

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
