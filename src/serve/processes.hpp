#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ejecta {

/// Runs as processes of their own, which outlive this one.
class Processes {
 public:
  /// `program`: `ejecta`.
  explicit Processes(std::filesystem::path program) : program_(std::move(program)) {}

  /// Starts the program with these words in that folder; what it says is added to `log`. Known as `name`
  /// until it has ended. Throws Error where it cannot be started.
  void start(const std::string& name, const std::vector<std::string>& words,
             const std::filesystem::path& folder, const std::filesystem::path& log);
  /// The process of that name, or 0 where none runs that was started here.
  pid_t find(const std::string& name);
  std::vector<std::string> names();

 private:
  void forget_ended();
  std::filesystem::path program_;
  std::map<std::string, pid_t> running_;
};

}  // namespace ejecta
