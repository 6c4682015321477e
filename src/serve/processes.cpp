#include "serve/processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/error.hpp"

namespace ejecta {
namespace {

/// An open file that goes when it is left.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

/// Who only asks, see is_held(), holds it for a moment.
bool lock_soon(int descriptor) {
  for (int tries = 0; tries < 10; ++tries) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace

void Processes::start(const std::vector<std::string>& words, const std::filesystem::path& folder,
                      const std::filesystem::path& log) {
  forget_ended();
  std::vector<std::string> all{program_.string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  const Descriptor output(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (output.number < 0) throw Error(fmt::format("cannot write {}: {}", log.string(), std::strerror(errno)));
  if (!lock_soon(output.number)) throw InputError(fmt::format("{} is of one that goes on", log.string()));
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, output.number, 1);
  ::posix_spawn_file_actions_adddup2(&files, output.number, 2);
  ::posix_spawn_file_actions_addclosefrom_np(&files, 3);  // no socket of the server
  posix_spawnattr_t how;
  ::posix_spawnattr_init(&how);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);  // ^C ends the server, not the run
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, argv[0], &files, &how, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&how);
  if (failed != 0) throw Error(fmt::format("cannot start {}: {}", program_.string(), std::strerror(failed)));
  children_.push_back(child);
}

Processes::~Processes() { forget_ended(); }

void Processes::forget_ended() {
  std::erase_if(children_, [](pid_t child) { return ::waitpid(child, nullptr, WNOHANG) != 0; });
}

bool is_held(const std::filesystem::path& file) {
  const Descriptor asks(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return asks.number >= 0 && ::flock(asks.number, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

bool ask_to_stop(const std::filesystem::path& log) {
  bool asked = false;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
    const std::string name = entry.path().filename().string();
    pid_t process = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), process).ptr != name.data() + name.size())
      continue;
    // Of those that write there the one that was started: it passes it on to those that it has started.
    if (::getsid(process) != process || std::filesystem::read_symlink(entry.path() / "fd" / "1", none) != log)
      continue;
    asked = ::kill(process, SIGTERM) == 0 || asked;
  }
  return asked;
}

}  // namespace ejecta
