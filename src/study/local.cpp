#include "study/local.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "output/output_file.hpp"

namespace ejecta {
namespace {

/// Exit codes of `ejecta study run-task` that mean that the task itself knows why (app/exit_code.hpp).
constexpr int kDone = 0, kBadInput = 2, kDiverged = 3, kStopped = 4;

class Pool {
 public:
  Pool(const TaskStore& store, const LocalExecutor& executor) : store_(store), executor_(executor) {}
  ~Pool() {
    end_all();
    while (!running_.empty()) reap(true);
  }

  std::size_t size() const { return running_.size(); }

  void start(std::size_t task) {
    const std::string index = std::to_string(task), threads = std::to_string(executor_.threads);
    const std::string log = store_.log(task).string(), directory = store_.path().string();
    std::vector<std::string> words{
        executor_.program.string(), "study", "run-task", directory, index, "--threads", threads};
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    const pid_t driver = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    if (child == 0) {
      // A driver that is killed takes its tasks along, which leave checkpoints.
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (::getppid() != driver) ::_exit(127);
      const int nothing = ::open("/dev/null", O_RDWR);
      const int errors = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      ::dup2(nothing, 0);
      ::dup2(nothing, 1);
      ::dup2(errors >= 0 ? errors : nothing, 2);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    running_[child] = task;
  }

  /// One task that has ended, if any has.
  bool reap(bool wait) {
    int status = 0;
    const pid_t child = ::waitpid(-1, &status, wait ? 0 : WNOHANG);
    if (child <= 0) return false;
    const auto it = running_.find(child);
    if (it == running_.end()) return false;
    const std::size_t task = it->second;
    running_.erase(it);
    judge(task, status);
    return true;
  }

  void end_all() const {
    for (const auto& [child, task] : running_) ::kill(child, SIGTERM);
  }

  const std::string& broken() const { return broken_; }

 private:
  std::string last_words(std::size_t task) const {
    std::error_code none;
    if (!std::filesystem::exists(store_.log(task), none)) return "";
    std::string text = output::read_file(store_.log(task));
    while (text.ends_with('\n')) text.pop_back();
    return text.size() > 2000 ? text.substr(text.size() - 2000) : text;
  }

  void judge(std::size_t task, int status) {
    if (WIFEXITED(status)) {
      const int code = WEXITSTATUS(status);
      if (code == kDone) {
        std::error_code none;
        std::filesystem::remove(store_.log(task), none);  // there is nothing in it, or only notes
        return;
      }
      if (code == kStopped || code == kDiverged || (code == kBadInput && knows(task))) return;
      const std::string words = last_words(task);
      if (code == 127 && words.empty()) broken_ = "cannot start " + executor_.program.string();
      crashed(task, words.empty() ? fmt::format("ended with exit code {}", code) : words);
      return;
    }
    const int sign = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (sign == SIGTERM || sign == SIGINT) return;  // stopped before its first step
    crashed(task, fmt::format("ended by signal {} ({}){}", sign, ::strsignal(sign),
                              sign == SIGKILL ? ": killed, or out of memory" : ""));
  }

  bool knows(std::size_t task) const { return store_.state(task) == TaskState::refused; }

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
  std::map<pid_t, std::size_t> running_;
  std::string broken_;
};

}  // namespace

bool run_locally(const TaskStore& store, std::span<const std::size_t> tasks, const LocalExecutor& executor) {
  const std::vector<TaskState> states = store.states();
  std::vector<std::size_t> left;
  for (const std::size_t task : tasks)
    if (states[task] == TaskState::waiting || states[task] == TaskState::crashed) left.push_back(task);
  std::reverse(left.begin(), left.end());
  Pool pool(store, executor);
  bool stopped = false;
  auto pause = std::chrono::microseconds(200);
  const auto longest = std::chrono::microseconds(50'000);
  while (pool.size() > 0 || (!left.empty() && !stopped)) {
    while (!stopped && !left.empty() && pool.size() < static_cast<std::size_t>(executor.at_once)) {
      pool.start(left.back());
      left.pop_back();
    }
    if (pool.reap(false)) {
      pause = std::chrono::microseconds(200);
      if (executor.look) executor.look();
      if (!pool.broken().empty()) throw Error(pool.broken());
      continue;
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
