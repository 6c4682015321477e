#pragma once
#include <filesystem>
#include <functional>
#include <span>

#include "study/task_store.hpp"

namespace ejecta {

/// How a machine works on tasks: in processes of their own, so that one that crashes takes nobody along.
/// Short ones share a process, and are run again alone if it crashes.
struct LocalExecutor {
  std::filesystem::path program;  ///< `ejecta`
  int at_once = 1;                ///< processes side by side
  int threads = 1;                ///< of each
  std::function<bool()> stop;     ///< true: no more tasks, those that run end with a checkpoint
  std::function<void()> look;     ///< called now and then, and after each task
};

/// Runs those of the tasks that wait or have crashed before. Returns false where it was stopped first. Throws
/// Error where results cannot be kept (a full disk): every task would fail so.
bool run_locally(const TaskStore& store, std::span<const std::size_t> tasks, const LocalExecutor& executor);

}  // namespace ejecta
