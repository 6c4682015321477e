#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/text.hpp"
#include "case/case.hpp"
#include "study/task_store.hpp"

namespace ejecta {

/// What a study asks of one run.
struct RunRequest {
  std::filesystem::path directory;  ///< goes on with what is there; empty: nothing is written
  int threads = 1;
  std::function<bool()> stop;         ///< true: end with a checkpoint
  std::function<void(double)> alive;  ///< to be called every step, with the part that is done
  Note note;
};
struct RunAnswer {
  bool stopped = false;               ///< before its end
  nlohmann::ordered_json quantities;  ///< result.json of the run
  double wall_time = 0.0;             ///< s
};
/// A run, as those provide who know more than this room. Throws InputError and DivergedError.
using RunFunction = std::function<RunAnswer(const Case&, const RunRequest&)>;

enum class Performed { done, was_done, runs_elsewhere, stopped, diverged, refused };

/// Runs one task of a study and leaves its result or the reason why there is none. Doing it twice, or in two
/// processes at once, gives one result. Throws Error where the result cannot be kept.
Performed perform_task(const TaskStore& store, std::size_t task, int threads, const RunFunction& run,
                       const std::function<bool()>& stop, const Note& note = {});

}  // namespace ejecta
