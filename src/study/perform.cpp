#include "study/perform.hpp"

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "output/build_info.hpp"

namespace ejecta {

Performed perform_task(const TaskStore& store, std::size_t task, int threads, const RunFunction& run,
                       const std::function<bool()>& stop, const Note& note) {
  if (store.state(task) == TaskState::done) return Performed::was_done;
  TaskClaim claim(store, task);
  if (!claim.held()) return Performed::runs_elsewhere;
  if (store.state(task) == TaskState::done) return Performed::was_done;  // in between
  claim.sign_of_life(0.0);
  double looked = wall_seconds();
  bool asked = false;
  RunRequest request{.directory = {},
                     .threads = threads,
                     .stop =
                         [&] {
                           // The folder is asked once a second: it may lie on another machine.
                           if (const double now = wall_seconds(); now - looked > 1.0) {
                             looked = now;
                             asked = asked || store.is_asked_to_stop();
                           }
                           return asked || (stop && stop());
                         },
                     .alive = [&](double fraction) { claim.sign_of_life(fraction); },
                     .note = note};
  if (store.header().value("keep_runs", true)) request.directory = store.run_directory(task);
  try {
    const RunAnswer answer = run(store.case_of(task), request);
    if (answer.stopped) return Performed::stopped;
    store.write_result(task, {{"labels", store.tasks()[task].labels},
                              {"wall_time_s", answer.wall_time},
                              {"version", output::version()},
                              {"git_revision", output::git_revision()},
                              {"result", answer.quantities}});
    return Performed::done;
  } catch (const InputError& e) {
    store.write_failure(task, TaskState::refused, e.what());
    return Performed::refused;
  } catch (const DivergedError& e) {
    store.write_failure(task, TaskState::diverged, e.what());
    return Performed::diverged;
  }
}

}  // namespace ejecta
