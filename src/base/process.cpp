#include "base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/exit_code.hpp"

namespace ejecta {

pid_t start_process(std::vector<std::string> words, const std::filesystem::path& log) {
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  const std::string errors_to = log.string();
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child > 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(127);
  if (!errors_to.empty()) {
    const int nothing = ::open("/dev/null", O_RDWR);
    const int errors = ::open(errors_to.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(nothing, 0);
    ::dup2(nothing, 1);
    ::dup2(errors >= 0 ? errors : nothing, 2);
  }
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

int run_process(std::vector<std::string> words, const std::function<bool()>& stop) {
  const pid_t child = start_process(std::move(words));
  bool asked = false;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (stop && stop() && !asked) {
      ::kill(child, SIGTERM);
      asked = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (asked) return exit_stopped;
  return WIFEXITED(status) ? WEXITSTATUS(status) : exit_failure;
}

}  // namespace ejecta
