#include "workflow/study_run.hpp"

#include "base/error.hpp"
#include "base/thread_budget.hpp"
#include "simulation/run.hpp"
#include "simulation/sorter_run.hpp"
#include "workflow/sort.hpp"

namespace ejecta {
namespace {

bool has_checkpoint(const std::filesystem::path& directory) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "checkpoints", none))
    if (entry.path().extension() == ".h5") return true;
  return false;
}

RunAnswer answer_of(const Result& result) {
  return {.stopped = result.end == RunEnd::stopped,
          .quantities = result.quantities,
          .wall_time = result.wall_time};
}

/// A whole sorter: of it too the result is what its directory says. Without one it is computed in memory.
RunAnswer sort_for_study(const Case& c, const RunRequest& request) {
  const auto alive = [&](double share) {
    if (request.alive) request.alive(share);
  };
  const auto stop = [&] { return request.stop && request.stop(); };
  if (!request.directory.empty()) {
    const SortEnd end = compute_sorter(
        c, {.out = request.directory.string(), .program = {}, .threads = request.threads},
        {.note = request.note, .share = [&](double share, bool) { alive(share); }, .stop = stop});
    return {.stopped = end.stopped,
            .quantities = end.result,
            .wall_time = end.stopped ? 0.0 : end.result.value("wall_time_s", 0.0)};
  }
  const ThreadBudget budget(request.threads);
  const Sorter sorter(c, fast_ejection(c, *make_jet_source(c, request.note)));
  const std::int64_t cells = cells_of_sorter(c, sorter.feed());
  SorterState state;
  const bool finished = run_sorter(
      c, sorter, cells, state,
      [&](const SorterState& now) { alive(static_cast<double>(now.cells) / static_cast<double>(cells)); },
      stop);
  return {.stopped = !finished, .quantities = sorter_result(c, sorter, state), .wall_time = state.wall_time};
}

}  // namespace

RunAnswer run_for_study(const Case& c, const RunRequest& request) {
  if (c.sorter.enabled) return sort_for_study(c, request);
  Context context{.files = {},
                  .threads = request.threads,
                  .observe =
                      [&](const Moment& m) {
                        if (request.alive) request.alive(m.busy_until > 0.0 ? m.time / m.busy_until : 0.0);
                      },
                  .stop = request.stop,
                  .keep = {},
                  .note = request.note,
                  .keep_histories = false};
  if (request.directory.empty()) return answer_of(run(c, context));
  if (auto done = finished_run(c, request.directory)) {
    done->wall_time = done->quantities.value("wall_time_s", 0.0);
    return answer_of(*done);
  }
  context.files = RunFiles{.directory = request.directory,
                           .overwrite = false,
                           .resume = has_checkpoint(request.directory),
                           .command = "ejecta run " + c.path,
                           .here = "ejecta run " + c.path + " --out " + request.directory.string()};
  if (context.files->resume) try {
      return answer_of(run(c, context));
    } catch (const InputError&) {  // damaged, or of another version
    }
  context.files->resume = false;
  context.files->overwrite = true;
  return answer_of(run(c, context));
}

}  // namespace ejecta
