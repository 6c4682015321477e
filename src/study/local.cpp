#include "study/local.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/process.hpp"
#include "base/stopwatch.hpp"
#include "output/output_file.hpp"

namespace ejecta {
namespace {

/// Short tasks share a process, whose start takes longer than they do: about this long, s, and so many.
constexpr double kProcessTime = 1.0;
constexpr std::size_t kMostInProcess = 64;

class Pool {
 public:
  Pool(const TaskStore& store, const LocalExecutor& executor) : store_(store), executor_(executor) {}
  ~Pool() {
    end_all();
    while (!running_.empty()) reap(true);
  }

  std::size_t size() const { return running_.size(); }
  /// As many tasks as one process should have, from what the last ones took.
  std::size_t share() const { return share_; }
  /// Those that a process which crashed had not yet done: to be run alone.
  std::vector<std::size_t> take_back() { return std::exchange(back_, {}); }

  void start(const std::vector<std::size_t>& tasks) {
    const std::filesystem::path log = store_.log(tasks.front());
    std::vector<std::string> words{executor_.program.string(), "study", "run-task", store_.path().string()};
    for (const std::size_t task : tasks) words.push_back(std::to_string(task));
    words.push_back("--threads=" + std::to_string(executor_.threads));
    const pid_t child = start_process(std::move(words), log);
    running_[child] = {tasks, wall_seconds()};
  }

  /// One process that has ended, if any has.
  bool reap(bool wait) {
    int status = 0;
    const pid_t child = ::waitpid(-1, &status, wait ? 0 : WNOHANG);
    if (child <= 0) return false;
    const auto it = running_.find(child);
    if (it == running_.end()) return false;
    const Work work = it->second;
    running_.erase(it);
    const double seconds = std::max(1e-4, (wall_seconds() - work.start) / double(work.tasks.size()));
    share_ = std::clamp<std::size_t>(static_cast<std::size_t>(kProcessTime / seconds), 1,
                                     std::min(kMostInProcess, 2 * share_));
    judge(work.tasks, status);
    return true;
  }

  void end_all() const {
    for (const auto& [child, work] : running_) ::kill(child, SIGTERM);
  }

  const std::string& broken() const { return broken_; }

 private:
  struct Work {
    std::vector<std::size_t> tasks;
    double start = 0.0;
  };

  std::string last_words(std::size_t task) const {
    std::error_code none;
    if (!std::filesystem::exists(store_.log(task), none)) return "";
    std::string text = output::read_file(store_.log(task));
    while (text.ends_with('\n')) text.pop_back();
    return text.size() > 2000 ? text.substr(text.size() - 2000) : text;
  }

  void judge(const std::vector<std::size_t>& tasks, int status) {
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const int sign = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (code == exit_done) {
      std::error_code none;
      std::filesystem::remove(store_.log(tasks.front()), none);  // there is nothing in it, or only notes
      return;
    }
    if (code == exit_stopped || sign == SIGTERM || sign == SIGINT)
      return;                       // with a checkpoint, or before its first step
    std::vector<std::size_t> open;  // about which nobody has said anything
    for (const std::size_t task : tasks)
      if (const TaskState state = store_.state(task);
          state == TaskState::waiting || state == TaskState::crashed)
        open.push_back(task);
    if (tasks.size() > 1) {
      back_.insert(back_.end(), open.begin(), open.end());
      share_ = 1;
      return;
    }
    if (open.empty()) return;
    const std::string words = last_words(tasks.front());
    if (code == 127 && words.empty()) broken_ = "cannot start " + executor_.program.string();
    if (sign == 0)
      return crashed(tasks.front(), words.empty() ? fmt::format("ended with exit code {}", code) : words);
    crashed(tasks.front(), fmt::format("ended by signal {} ({}){}", sign, ::strsignal(sign),
                                       sign == SIGKILL ? ": killed, or out of memory" : ""));
  }

  /// A task whose end cannot even be noted ends the study: the disk is full.
  void crashed(std::size_t task, const std::string& reason) {
    try {
      store_.write_failure(task, TaskState::crashed, reason);
    } catch (const Error& e) {
      broken_ = e.what();
    }
  }

  const TaskStore& store_;
  const LocalExecutor& executor_;
  std::map<pid_t, Work> running_;
  std::vector<std::size_t> back_;
  std::size_t share_ = 1;
  std::string broken_;
};

}  // namespace

bool run_locally(const TaskStore& store, std::span<const std::size_t> tasks, const LocalExecutor& executor) {
  std::vector<std::size_t> left, alone, elsewhere;
  const std::vector<TaskState> states = store.states();
  for (const std::size_t task : tasks) {
    if (states[task] == TaskState::running) elsewhere.push_back(task);
    if (states[task] == TaskState::waiting || states[task] == TaskState::crashed) left.push_back(task);
  }
  std::reverse(left.begin(), left.end());
  Pool pool(store, executor);
  bool stopped = false;
  auto pause = std::chrono::microseconds(200);
  const auto longest = std::chrono::microseconds(50'000);
  double looked = wall_seconds();
  const auto more = [&] { return !stopped && !(left.empty() && alone.empty()); };
  while (pool.size() > 0 || more() || (!stopped && !elsewhere.empty())) {
    while (more() && pool.size() < static_cast<std::size_t>(executor.at_once)) {
      // Towards the end every process gets some.
      const auto fair = left.size() / static_cast<std::size_t>(executor.at_once);
      const std::size_t count = alone.empty() ? std::clamp<std::size_t>(fair, 1, pool.share()) : 1;
      std::vector<std::size_t> work;
      std::vector<std::size_t>& from = alone.empty() ? left : alone;
      for (std::size_t n = 0; n < count; ++n) {
        work.push_back(from.back());
        from.pop_back();
      }
      pool.start(work);
    }
    if (pool.reap(false)) {
      pause = std::chrono::microseconds(200);
      for (const std::size_t task : pool.take_back()) alone.push_back(task);
      if (executor.look) executor.look();
      if (!pool.broken().empty()) throw Error(pool.broken());
      continue;
    }
    // What another process had is ours if it ends without a result.
    if (wall_seconds() - looked > 1.0) {
      looked = wall_seconds();
      std::erase_if(elsewhere, [&](std::size_t task) {
        const TaskState state = store.state(task);
        if (state == TaskState::waiting) alone.push_back(task);
        return state != TaskState::running;
      });
    }
    if (!stopped && ((executor.stop && executor.stop()) || store.is_asked_to_stop())) {
      stopped = true;
      pool.end_all();
    }
    std::this_thread::sleep_for(pause);
    if (pause < longest) pause *= 2;
    else if (executor.look) executor.look();
  }
  return !stopped;
}

}  // namespace ejecta
