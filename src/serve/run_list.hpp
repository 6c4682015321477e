#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serve/folder.hpp"
#include "serve/processes.hpp"

namespace ejecta {

/// The runs of a folder: what stands on disk of each, and those that are started and stopped here. Many
/// threads may ask at once.
class RunList {
 public:
  RunList(const Folder& folder, std::filesystem::path program)
      : folder_(folder), processes_(std::move(program)) {}

  /// One object a run: name, case, state ("starting", "running", "done", "stopped", "diverged", "failed"),
  /// and where they are known fraction, time_s, eta_s, wall_time_s, verdict, outcome, report.
  nlohmann::ordered_json all();

  /// Starts a run of the case into a directory of its own beside it and returns its name. Throws InputError
  /// where the case already runs: a second click is no second run.
  std::string start(const std::string& case_name);
  /// Goes on with one that has stopped or died.
  void resume(const std::string& run);
  /// Asks it to stop with a checkpoint.
  void stop(const std::string& run);

 private:
  nlohmann::ordered_json state_of(const std::string& run);
  void require_idle(const std::string& run);
  std::string case_of(const std::string& run);
  /// A small JSON file, read again only where it has changed.
  nlohmann::json read(const std::filesystem::path& file);

  const Folder& folder_;
  std::mutex one_at_a_time_;
  Processes processes_;
  std::map<std::string, std::string> case_of_started_;  // run -> case
  struct Kept {
    std::filesystem::file_time_type written;
    nlohmann::json content;
  };
  std::map<std::filesystem::path, Kept> kept_;
};

}  // namespace ejecta
