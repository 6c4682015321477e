#include "study/task_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/stopwatch.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/build_info.hpp"
#include "output/output_file.hpp"
#include "output/run_directory.hpp"

namespace fs = std::filesystem;

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

/// Of the hash, in the names of files: 80 bits.
constexpr std::size_t kHashDigits = 20;
constexpr std::array kFolders{"cases", "results", "failed", "running", "runs", "logs", "slurm"};
constexpr std::array kFiles{"tasks.jsonl", "result.json", "runs.csv",  "report.html",
                            "stop",        "driver",      "study.json"};

std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json parse_json(const fs::path& path) {
  Json json = Json::parse(output::read_file(path), nullptr, false);
  if (json.is_discarded())
    throw InputError(
        fmt::format("{} is damaged: it is not JSON; remove it and start the study again", path.string()));
  return json;
}

/// The case that decides the result: not what the study makes of it, nor what is only written down.
Case task_case(Case c) {
  c.study = {};
  c.map = {};
  c.expects.clear();
  c.convergence = {};
  return with_absolute_files(std::move(c));
}

/// Files of a run that nothing but the run reads may stand where the case has them; the result does not know.
std::string hash_of(const Case& c, std::map<std::string, std::string>& digests) {
  std::string text = write_changes(c);
  for (const std::string& file : files_of(c)) {
    const auto known = digests.find(file);
    const std::string digest =
        known != digests.end() ? known->second : output::digests_of({file})[file].get<std::string>();
    if (known == digests.end()) digests[file] = digest;
    text += file + " " + digest + "\n";
  }
  return sha256_hex(text).substr(0, kHashDigits);
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".tmp") names.insert(path.stem().string());
  }
  return names;
}

TaskState failed_state(const fs::path& file) {
  const Json json = Json::parse(output::read_file(file), nullptr, false);
  const std::string state = json.is_object() ? json.value("state", "") : "";
  return state == "diverged"  ? TaskState::diverged
         : state == "refused" ? TaskState::refused
                              : TaskState::crashed;
}

/// Whether a living process holds the file's lock.
bool is_locked(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return locked;
}

}  // namespace

const char* word(TaskState state) {
  return std::array{
      "waiting", "running", "done", "diverged", "refused", "crashed"}[static_cast<std::size_t>(state)];
}

TaskStore TaskStore::create(const fs::path& directory, const Json& header, bool force) {
  TaskStore store(directory);
  std::error_code failed;
  const fs::path head = directory / "study.json";
  if (fs::exists(head, failed)) {
    const Json there = parse_json(head);
    const bool same = there.value("input_sha256", "") == header.value("input_sha256", "-");
    if (!same && !force)
      throw InputError(
          fmt::format("{} holds another {}: \"{}\" of {}\n  choose another place with --out DIR, "
                      "or start anew there with --force",
                      directory.string(), there.value("kind", "study"), there.value("title", ""),
                      there.value("case", "")));
    if (force && is_locked(directory / "driver"))
      throw InputError(fmt::format("another process works on {}; stop it first:  ejecta study stop {}",
                                   directory.string(), directory.string()));
    if (force) {
      for (const char* name : kFolders) fs::remove_all(directory / name, failed);
      for (const char* name : kFiles) fs::remove(directory / name, failed);
    }
  } else if (!output::holds_no_file(directory, "study.json", failed)) {
    throw InputError(fmt::format(
        "{} holds files that are not of a study; choose another place with --out DIR", directory.string()));
  }
  for (const char* name : kFolders) {
    fs::create_directories(directory / name, failed);
    if (failed)
      throw InputError(fmt::format("cannot write the study {}: {} (choose another place with --out DIR)",
                                   directory.string(), failed.message()));
  }
  store.header_ = header;
  if (!fs::exists(head, failed)) store.write_json("study.json", header);
  store.read_tasks();
  return store;
}

TaskStore TaskStore::open(const fs::path& directory) {
  std::error_code none;
  if (!fs::exists(directory / "study.json", none))
    throw InputError(
        fmt::format("{} is not the directory of a study: it has no study.json\n  make one:  "
                    "ejecta study CASE --out {}",
                    directory.string(), directory.string()));
  TaskStore store(directory);
  store.header_ = parse_json(directory / "study.json");
  store.read_tasks();
  return store;
}

void TaskStore::read_tasks() {
  std::error_code none;
  if (!fs::exists(path_ / "tasks.jsonl", none)) return;
  const std::string text = output::read_file(path_ / "tasks.jsonl");
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const Json line = Json::parse(text.substr(start, end - start), nullptr, false);
    if (!line.is_object() || !line.contains("hash") || !line.contains("labels"))
      throw InputError(fmt::format("{} is damaged in line {}; remove it and start the study again",
                                   (path_ / "tasks.jsonl").string(), tasks_.size() + 1));
    places_[line["hash"].get<std::string>()] = tasks_.size();
    tasks_.push_back({line["hash"], line["labels"]});
    start = end + 1;
  }
}

std::vector<std::size_t> TaskStore::add(const std::vector<NewTask>& tasks) {
  std::vector<std::size_t> places;
  std::set<std::string> cases = names_in(path_ / "cases");
  std::set<std::size_t> asked;
  bool grown = false;
  for (const NewTask& task : tasks) {
    const Case c = task_case(task.resolved);
    const std::string hash = hash_of(c, digests_);
    const auto [place, is_new] = places_.try_emplace(hash, tasks_.size());
    if (is_new) {
      tasks_.push_back({hash, task.labels});
      grown = true;
    }
    if (!asked.insert(place->second).second || tasks_[place->second].labels != task.labels)
      throw InputError(fmt::format("two runs of the study are the same run: {} and {}",
                                   json_text(tasks_[place->second].labels), json_text(task.labels)));
    if (!cases.contains(hash)) output::write_file(file(place->second, "cases", ".toml"), write_case(c));
    places.push_back(place->second);
  }
  if (grown) {
    std::string text;
    for (const Task& task : tasks_) text += json_text({{"hash", task.hash}, {"labels", task.labels}}) + '\n';
    output::write_file(path_ / "tasks.jsonl", text);
  }
  return places;
}

Case TaskStore::case_of(std::size_t task) const {
  const fs::path path = file(task, "cases", ".toml");
  std::error_code none;
  if (!fs::exists(path, none))
    throw InputError(fmt::format("{} is missing; start the study again", path.string()));
  Case c = load_case(path.string());
  if (hash_of(c, digests_) != tasks_[task].hash)
    throw InputError(fmt::format(
        "{} or a file that it reads has changed since the study was set up; start it anew with --force",
        path.string()));
  return c;
}

fs::path TaskStore::file(std::size_t task, const char* folder, const char* extension) const {
  return path_ / folder / (tasks_.at(task).hash + extension);
}

std::vector<TaskState> TaskStore::states() const {
  const std::set<std::string> done = names_in(path_ / "results"), failed = names_in(path_ / "failed"),
                              running = names_in(path_ / "running");
  std::vector<TaskState> states;
  for (std::size_t n = 0; n < tasks_.size(); ++n) {
    const std::string& hash = tasks_[n].hash;
    states.push_back(done.contains(hash)                                                ? TaskState::done
                     : running.contains(hash) && is_locked(file(n, "running", ".json")) ? TaskState::running
                     : failed.contains(hash) ? failed_state(file(n, "failed", ".json"))
                                             : TaskState::waiting);
  }
  return states;
}

TaskState TaskStore::state(std::size_t task) const {
  std::error_code none;
  if (fs::exists(file(task, "results", ".json"), none)) return TaskState::done;
  if (is_locked(file(task, "running", ".json"))) return TaskState::running;
  if (const fs::path failed = file(task, "failed", ".json"); fs::exists(failed, none))
    return failed_state(failed);
  return TaskState::waiting;
}

Json TaskStore::result(std::size_t task) const { return parse_json(file(task, "results", ".json")); }

std::string TaskStore::failure(std::size_t task) const {
  return parse_json(file(task, "failed", ".json")).value("reason", "");
}

std::optional<TaskLife> TaskStore::life(std::size_t task) const {
  const fs::path path = file(task, "running", ".json");
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  const Json json = Json::parse(output::read_file(path), nullptr, false);  // may be just being written
  TaskLife life;
  life.age = seconds_since_1970() - (double(status.st_mtim.tv_sec) + 1e-9 * double(status.st_mtim.tv_nsec));
  if (json.is_object()) {
    life.fraction = json.value("fraction", 0.0);
    life.process = json.value("process", std::int64_t{0});
    life.host = json.value("host", "");
  }
  return life;
}

void TaskStore::write_result(std::size_t task, const Json& result) const {
  output::write_file(file(task, "results", ".json"), json_text(result, 1) + '\n');
  forget_failure(task);
}

void TaskStore::write_failure(std::size_t task, TaskState state, const std::string& reason) const {
  output::write_file(file(task, "failed", ".json"),
                     json_text({{"state", word(state)}, {"reason", reason}}, 1) + '\n');
}

void TaskStore::forget_failure(std::size_t task) const {
  std::error_code none;
  fs::remove(file(task, "failed", ".json"), none);
}

void TaskStore::write_json(const std::string& name, const Json& json) const {
  output::write_file(path_ / name, json_text(json, 2) + '\n');
}

void TaskStore::ask_to_stop(bool stop) const {
  std::error_code none;
  if (stop) output::write_file(path_ / "stop", "");
  else fs::remove(path_ / "stop", none);
}

bool TaskStore::is_asked_to_stop() const {
  std::error_code none;
  return fs::exists(path_ / "stop", none);
}

std::vector<double> TaskStore::latest_results(std::size_t count) const {
  std::vector<double> times;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(path_ / "results", none)) {
    struct stat status {};
    if (::stat(entry.path().c_str(), &status) == 0)
      times.push_back(double(status.st_mtim.tv_sec) + 1e-9 * double(status.st_mtim.tv_nsec));
  }
  std::sort(times.begin(), times.end());
  if (times.size() > count) times.erase(times.begin(), times.end() - static_cast<std::ptrdiff_t>(count));
  return times;
}

StudyDriver::StudyDriver(const TaskStore& store) {
  const fs::path file = store.path() / "driver";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) output::throw_system_error("cannot create", file);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  const std::string path = store.path().string();
  throw InputError(
      fmt::format("another process works on {}\n  how far it is:  ejecta study status {}\n  stop it:        "
                  "ejecta study stop {}",
                  path, path, path));
}

StudyDriver::~StudyDriver() { ::close(descriptor_); }

TaskClaim::TaskClaim(const TaskStore& store, std::size_t task) : file_(store.file(task, "running", ".json")) {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) output::throw_system_error("cannot create", file_);
  struct stat status {};
  const bool locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  // Of a file that its last owner has just removed the lock is worth nothing.
  if (locked && ::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return;
  const int code = locked ? EWOULDBLOCK : errno;
  ::close(descriptor_);
  descriptor_ = -1;
  errno = code;
  if (code != EWOULDBLOCK) output::throw_system_error("cannot lock", file_);
}

TaskClaim::~TaskClaim() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());  // while it is held: nobody else's
  ::close(descriptor_);
}

void TaskClaim::sign_of_life(double fraction) {
  const double now = wall_seconds();
  if (now - last_ < 1.0) return;
  last_ = now;
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  const std::string text = json_text({{"process", ::getpid()}, {"host", host}, {"fraction", fraction}});
  // Only a sign: a full disk must not end the run.
  if (::pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()))
    (void)!::ftruncate(descriptor_, static_cast<off_t>(text.size()));
}

}  // namespace ejecta
