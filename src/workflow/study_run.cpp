#include "workflow/study_run.hpp"

#include "base/error.hpp"
#include "simulation/run.hpp"

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

}  // namespace

RunAnswer run_for_study(const Case& c, const RunRequest& request) {
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
