#include "study/slurm.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <thread>

#include "base/error.hpp"
#include "base/shell_word.hpp"
#include "base/stopwatch.hpp"
#include "output/output_file.hpp"

namespace ejecta {
namespace {

/// What a command prints. Throws Error where it cannot be run or fails.
std::string answer_of(const std::vector<std::string>& words) {
  int ends[2];
  if (::pipe(ends) != 0) throw Error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  const pid_t child = ::fork();
  if (child < 0) throw Error(fmt::format("cannot start {}: {}", words[0], std::strerror(errno)));
  if (child == 0) {
    ::dup2(ends[1], 1);
    ::dup2(ends[1], 2);
    ::close(ends[0]);
    ::close(ends[1]);
    std::vector<char*> argv;
    for (const std::string& w : words) argv.push_back(const_cast<char*>(w.c_str()));
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) != 0;) {
    if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
    else if (errno != EINTR) break;
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  while (text.ends_with('\n')) text.pop_back();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw Error(fmt::format("{} cannot be run: is this a machine of a SLURM cluster?", words[0]));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(fmt::format("{} failed: {}", words[0], text));
  return text;
}

/// The most elements that a job array may have here.
std::size_t largest_array() {
  const std::string text = answer_of({"scontrol", "show", "config"});
  const std::size_t at = text.find("MaxArraySize");
  const std::size_t equals = at == std::string::npos ? at : text.find('=', at);
  if (equals == std::string::npos) return 1000;
  return std::max<std::size_t>(1, std::stoul(text.substr(equals + 1)) - 1);  // indices run below it
}

class Cluster {
 public:
  Cluster(const TaskStore& store, const SlurmExecutor& executor)
      : store_(store), executor_(executor), array_(largest_array()) {
    std::error_code failed;
    std::filesystem::create_directories(folder(), failed);
  }

  void submit(const std::vector<std::size_t>& tasks) {
    for (std::size_t start = 0; start < tasks.size(); start += array_) {
      const std::size_t count = std::min(array_, tasks.size() - start);
      std::string lines;
      for (std::size_t n = start; n < start + count; ++n) {
        lines += std::to_string(tasks[n]) + '\n';
        ++submitted_[tasks[n]];
      }
      const std::string name = fmt::format("array-{}", arrays_++);
      const auto list = folder() / (name + ".txt"), script = folder() / (name + ".sh");
      output::write_file(list, lines);
      output::write_file(script, slurm_script(store_, executor_.program, list, count));
      std::vector<std::string> words{"sbatch", "--parsable"};
      words.insert(words.end(), executor_.options.begin(), executor_.options.end());
      words.push_back(script.string());
      const std::string answer = answer_of(words);
      jobs_.push_back(answer.substr(0, answer.find(';')));
    }
  }

  /// Whether any of our jobs is still queued or running.
  bool busy() const {
    if (jobs_.empty()) return false;
    std::string list;
    for (const std::string& job : jobs_) list += (list.empty() ? "" : ",") + job;
    try {
      return !answer_of({"squeue", "--noheader", "--jobs=" + list, "--format=%i"}).empty();
    } catch (const Error&) {
      return false;  // "Invalid job id": all are over and forgotten
    }
  }

  /// SIGTERM first, so that what runs leaves a checkpoint.
  void cancel() const {
    for (const std::string& job : jobs_) try {
        answer_of({"scancel", "--state=PENDING", job});
        answer_of({"scancel", "--signal=TERM", "--full", job});
      } catch (const Error&) {  // is over
      }
  }

  int submitted(std::size_t task) const {
    const auto it = submitted_.find(task);
    return it == submitted_.end() ? 0 : it->second;
  }

 private:
  std::filesystem::path folder() const { return store_.path() / "slurm"; }

  const TaskStore& store_;
  const SlurmExecutor& executor_;
  std::size_t array_, arrays_ = 0;
  std::vector<std::string> jobs_;
  std::map<std::size_t, int> submitted_;
};

}  // namespace

std::string slurm_script(const TaskStore& store, const std::filesystem::path& program,
                         const std::filesystem::path& list, std::size_t count) {
  const auto directory = std::filesystem::absolute(store.path()).string();
  // `exec`: the program itself gets the signal that comes before the time limit.
  return fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=ejecta\n"
      "#SBATCH --array=0-{}\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --signal=B:TERM@60\n"
      "#SBATCH --output={}/slurm/%A_%a.log\n"
      "task=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n"
      "exec {} study run-task {} \"$task\"\n",
      count - 1, directory, shell_word(std::filesystem::absolute(list).string()),
      shell_word(program.string()), shell_word(directory));
}

bool run_on_slurm(const TaskStore& store, std::span<const std::size_t> tasks, const SlurmExecutor& executor) {
  const auto unfinished = [&](bool crashed) {
    const std::vector<TaskState> states = store.states();
    std::vector<std::size_t> left;
    for (const std::size_t task : tasks)
      if (states[task] == TaskState::waiting || states[task] == TaskState::running ||
          (crashed && states[task] == TaskState::crashed))
        left.push_back(task);
    return left;
  };
  std::vector<std::size_t> left = unfinished(true);
  if (left.empty()) return true;
  for (const std::size_t task : left) store.forget_failure(task);
  Cluster cluster(store, executor);
  cluster.submit(left);
  while (!(left = unfinished(false)).empty()) {
    if ((executor.stop && executor.stop()) || store.is_asked_to_stop()) {
      cluster.cancel();
      return false;
    }
    if (executor.look) executor.look();
    if (!cluster.busy()) {
      left = unfinished(false);  // a result may have come since
      std::vector<std::size_t> again;
      for (const std::size_t task : left) {
        if (cluster.submitted(task) < executor.submissions) again.push_back(task);
        else
          store.write_failure(task, TaskState::crashed,
                              fmt::format("ended {} times without a result: see {}/slurm",
                                          executor.submissions, store.path().string()));
      }
      if (!again.empty()) cluster.submit(again);
      continue;
    }
    const double until = wall_seconds() + executor.poll_interval;
    while (wall_seconds() < until && !(executor.stop && executor.stop()))
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace ejecta
