#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ejecta {

/// Commands of the program as processes of their own, which outlive this one. Each holds its log locked as
/// long as it lives, because its output is that open file: whoever looks, this server or a later one, learns
/// from the system alone whether it goes on, and nobody can start it twice.
class Processes {
 public:
  /// `program`: `ejecta`.
  explicit Processes(std::filesystem::path program) : program_(std::move(program)) {}
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  /// Starts the program with these words in that folder; what it says is added to `log`. Throws InputError
  /// where the process of that log goes on, and Error where it cannot be started.
  void start(const std::vector<std::string>& words, const std::filesystem::path& folder,
             const std::filesystem::path& log);

 private:
  void forget_ended();
  std::filesystem::path program_;
  std::vector<pid_t> children_;
};

/// Whether a living process holds the file locked.
bool is_held(const std::filesystem::path& file);
/// Asks the process that was started with this log to stop; false: there is none.
bool ask_to_stop(const std::filesystem::path& log);

}  // namespace ejecta
