#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "study/task_store.hpp"

namespace ejecta {

/// How a cluster works on tasks: job arrays of `ejecta study run-task`. The directory of the study must be
/// seen by all nodes.
struct SlurmExecutor {
  std::filesystem::path program;     ///< `ejecta`, as the nodes see it
  std::vector<std::string> options;  ///< of sbatch, e.g. "--time=1:00:00"
  std::function<bool()> stop;        ///< true: cancel what is queued; what runs ends with a checkpoint
  std::function<void()> look;        ///< called at each poll
  double poll_interval = 5.0;        ///< s
  int submissions = 5;               ///< of a task that ends without a result, before it counts as crashed
};

/// Runs those of the tasks that wait or have crashed before, as run_locally() does: jobs that a time limit or
/// a failed node ended go on from their checkpoints in another job. Returns false where it was stopped.
/// Throws Error where SLURM's commands fail.
bool run_on_slurm(const TaskStore& store, std::span<const std::size_t> tasks, const SlurmExecutor& executor);

/// The script of a job array over the tasks whose numbers are the lines of `list`.
std::string slurm_script(const TaskStore& store, const std::filesystem::path& program,
                         const std::filesystem::path& list, std::size_t count);

}  // namespace ejecta
