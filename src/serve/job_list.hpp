#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "serve/folder.hpp"
#include "serve/job_state.hpp"
#include "serve/processes.hpp"
#include "serve/queue.hpp"

namespace ejecta {

/// Runs, studies, maps, sorters and campaigns of a folder: what stands on disk of each, and those that are
/// queued, started and stopped here. Many threads may ask at once, and many servers.
class JobList {
 public:
  JobList(const Folder& folder, std::filesystem::path program)
      : folder_(folder), queue_(folder.path()), processes_(std::move(program)) {}

  /// One object a job, sorted by name: name, kind, case, state ("waiting", "starting", "running", "done",
  /// "stopped", "diverged", "failed"), and what job_state() knows of it.
  /// `ended_too`: those that had ended are looked at as well; it takes three looks at the disk for each.
  nlohmann::ordered_json all(const Folder::Content& content, bool ended_too = true);
  /// {"at_once": of the jobs that wait, so many are started side by side}
  nlohmann::ordered_json settings();
  void set_at_once(int count);

  /// Queues a command ("run", "map", ...) on a case, into a directory of its own beside it, and returns the
  /// name of that. Throws InputError where the same waits or goes on already: a second click is no second
  /// run.
  std::string start(const std::string& case_name, const std::string& kind);
  /// Queues one that has stopped or died, to go on.
  void resume(const std::string& name);
  /// Takes one that waits out of the queue; asks one that goes on to stop, with a checkpoint.
  void stop(const std::string& name);
  /// Puts one that has ended out of sight, into .removed/ in the folder, whence it can be taken back.
  void remove(const std::string& name);
  /// Starts of those that wait as many as may run.
  void advance();

 private:
  std::filesystem::path log_of(const std::string& name) const { return folder_.inside(name + ".log"); }
  bool goes_on(const std::string& name);
  bool has_begun(const Job& job) const;
  std::string kind_of(const std::string& name);
  std::string kind_of(const std::filesystem::path& directory, const std::string& kind);
  std::string case_of(const std::string& name);
  void launch(const Job& job, int side_by_side);

  const Folder& folder_;
  std::mutex one_at_a_time_;
  Queue queue_;
  Processes processes_;
  JobFiles files_;
  struct Ended {  // needs no second look until its files change
    std::string stamp;
    nlohmann::ordered_json state;
  };
  std::map<std::string, Ended> ended_;
};

}  // namespace ejecta
