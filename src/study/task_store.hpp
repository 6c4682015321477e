#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// One run of a study: its resolved case under the hash of what decides the result.
struct Task {
  std::string hash;               ///< names all its files
  nlohmann::ordered_json labels;  ///< what tells it from the others, e.g. {"valve.supply_pressure": 801325.0}
};
struct NewTask {
  Case resolved;
  nlohmann::ordered_json labels;
};

/// running: somebody holds its lock. crashed: ended without a word; tried again by the next call.
enum class TaskState { waiting, running, done, diverged, refused, crashed };
const char* word(TaskState state);

/// Last sign of life of a task.
struct TaskLife {
  double fraction = 0.0;  ///< of its run
  double age = 0.0;       ///< s since it was given
  std::int64_t process = 0;
  std::string host;
};

/// The directory of a study (docs/files.md): study.json says of what; tasks.jsonl is the table, one task a
/// line; cases/HASH.toml the case of each, and results/, failed/, running/ and runs/ hold what became of it,
/// under the same name. Every file is written beside and renamed and belongs to one task, so that any number
/// of processes on any number of machines may work on it at once. What is known of the tasks is known from
/// these folders alone.
class TaskStore {
 public:
  /// A new study, or the same one (`header["input_sha256"]`) again with all it has. Throws InputError where
  /// another study or anything else is; with `force` a study that is there is removed first.
  static TaskStore create(const std::filesystem::path& directory, const nlohmann::ordered_json& header,
                          bool force);
  static TaskStore open(const std::filesystem::path& directory);

  const std::filesystem::path& path() const { return path_; }
  const nlohmann::ordered_json& header() const { return header_; }
  const std::vector<Task>& tasks() const { return tasks_; }
  /// Their places in the table; those that are there already keep theirs. Throws InputError where two differ
  /// in nothing that decides the result.
  std::vector<std::size_t> add(const std::vector<NewTask>& tasks);

  /// The case of a task; throws InputError where its file, or one it reads, is no longer what it was.
  Case case_of(std::size_t task) const;
  std::filesystem::path run_directory(std::size_t task) const { return file(task, "runs", ""); }
  std::filesystem::path log(std::size_t task) const { return file(task, "logs", ".txt"); }

  std::vector<TaskState> states() const;  ///< one listing a folder: fast for any number of tasks
  TaskState state(std::size_t task) const;
  nlohmann::ordered_json result(std::size_t task) const;  ///< of one that is done
  std::string failure(std::size_t task) const;            ///< why, of one that failed
  std::optional<TaskLife> life(std::size_t task) const;   ///< of one that runs

  void write_result(std::size_t task, const nlohmann::ordered_json& result) const;
  void write_failure(std::size_t task, TaskState state, const std::string& reason) const;
  void forget_failure(std::size_t task) const;
  void write_json(const std::string& name, const nlohmann::ordered_json& json) const;

  /// Asks whoever works on the study to stop, and takes that back.
  void ask_to_stop(bool stop) const;
  bool is_asked_to_stop() const;

  /// When the last results came, s since 1970, ascending; at most `count`.
  std::vector<double> latest_results(std::size_t count) const;

 private:
  friend class TaskClaim;
  explicit TaskStore(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path file(std::size_t task, const char* folder, const char* extension) const;
  void read_tasks();

  std::filesystem::path path_;
  nlohmann::ordered_json header_;
  std::vector<Task> tasks_;
  std::map<std::string, std::size_t> places_;           // of tasks, by hash
  mutable std::map<std::string, std::string> digests_;  // of files that cases read
};

/// The right to decide what is run next, which dies with the process: one driver a study.
class StudyDriver {
 public:
  /// Throws InputError where another process has it.
  explicit StudyDriver(const TaskStore& store);
  ~StudyDriver();
  StudyDriver(const StudyDriver&) = delete;
  StudyDriver& operator=(const StudyDriver&) = delete;

 private:
  int descriptor_ = -1;
};

/// The right to work on a task, which dies with the process; and its sign of life.
class TaskClaim {
 public:
  TaskClaim(const TaskStore& store, std::size_t task);
  ~TaskClaim();
  TaskClaim(const TaskClaim&) = delete;
  TaskClaim& operator=(const TaskClaim&) = delete;

  bool held() const { return descriptor_ >= 0; }  ///< false: another process has it
  /// At most once a second the file is written; cheap to call every step.
  void sign_of_life(double fraction);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  double last_ = -1e300;
};

}  // namespace ejecta
