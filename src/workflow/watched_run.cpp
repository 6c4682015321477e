#include "workflow/watched_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "output/run_directory.hpp"

namespace ejecta {
namespace {

std::string plural(std::int64_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string start_line(const Case& c, const Moment& m, const std::filesystem::path& directory) {
  return fmt::format("{}: {} cells, {}, {} -> {}{}", c.path, m.model.cells(),
                     plural(static_cast<std::int64_t>(m.model.bodies()), "body", "bodies"),
                     plural(thread_count(), "thread", "threads"), directory.string(),
                     m.step > 0 ? fmt::format(", from t = {:.3f} ms", 1e3 * m.time) : "");
}

}  // namespace

WatchedRun::WatchedRun(const Case& c, std::ostream& out, const output::ProgressOptions& options)
    : case_(c), out_(out), options_(options) {}

void WatchedRun::observe(const Moment& m, const std::filesystem::path& directory) {
  last_ = {m.time, m.busy_until, m.step, m.dt, m.model.courant(), m.model.cells()};
  if (progress_) return progress_->update(last_);
  options_.file = output::RunDirectory::open(directory).progress();
  progress_.emplace(out_, options_);
  progress_->note(start_line(case_, m, directory));
  if (thread_count() > core_count())
    progress_->note(fmt::format("{} threads share {}: more threads than cores make a run slower",
                                thread_count(), plural(core_count(), "core", "cores")));
}

void WatchedRun::note(const std::string& line) {
  if (progress_) progress_->note(line);
}

void WatchedRun::finish(const std::string& state) {
  if (progress_) progress_->finish(last_, state);
}

/// Leaves the reason in progress.json, if that can still be written.
void WatchedRun::give_up(const std::string& state) {
  try {
    finish(state);
  } catch (const Error&) {
  }
}

Result WatchedRun::compute(const RunOfCase& run, Context context) {
  context.observe = [this, others = std::move(context.observe),
                     directory = context.files->directory](const Moment& m) {
    if (others) others(m);
    observe(m, directory);
  };
  try {
    const Result result = run(case_, context);
    finish(result.end == RunEnd::stopped ? "stopped" : "done");
    return result;
  } catch (const DivergedError&) {
    give_up("diverged");
    throw;
  } catch (...) {
    give_up("failed");
    throw;
  }
}

}  // namespace ejecta
