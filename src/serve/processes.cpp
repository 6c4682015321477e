#include "serve/processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "base/error.hpp"

namespace ejecta {

void Processes::start(const std::string& name, const std::vector<std::string>& words,
                      const std::filesystem::path& folder, const std::filesystem::path& log) {
  std::vector<std::string> all{program_.string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::posix_spawn_file_actions_adddup2(&files, 1, 2);
  ::posix_spawn_file_actions_addclosefrom_np(&files, 3);  // no socket of the server
  posix_spawnattr_t how;
  ::posix_spawnattr_init(&how);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);  // ^C ends the server, not the run
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, argv[0], &files, &how, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&how);
  if (failed != 0) throw Error(fmt::format("cannot start {}: {}", program_.string(), std::strerror(failed)));
  running_[name] = child;
}

void Processes::forget_ended() {
  std::erase_if(running_, [](const auto& entry) { return ::waitpid(entry.second, nullptr, WNOHANG) != 0; });
}

pid_t Processes::find(const std::string& name) {
  forget_ended();
  const auto it = running_.find(name);
  return it == running_.end() ? 0 : it->second;
}

std::vector<std::string> Processes::names() {
  forget_ended();
  std::vector<std::string> all;
  for (const auto& [name, unused] : running_) all.push_back(name);
  return all;
}

}  // namespace ejecta
