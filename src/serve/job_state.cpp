#include "serve/job_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "base/error.hpp"
#include "base/file_lock.hpp"
#include "output/output_file.hpp"
#include "output/verdict.hpp"
#include "serve/processes.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kMostSaid = 2000;

/// Of result.json only what the list shows; of a map, a sorter also their sentence.
Json listed_result(const Json& result) {
  if (!result.is_object()) return nullptr;
  Json shown{{"title", result.value("title", "")}, {"wall_time_s", result.value("wall_time_s", 0.0)}};
  if (result.contains("summary")) shown["verdict"] = result["summary"];
  else if (!result.contains("kind")) shown["verdict"] = output::verdict_sentence(result);
  for (const char* key : {"outcome", "state"})
    if (result.contains(key)) shown[key == std::string("state") ? "map_state" : key] = result[key];
  if (result.contains("parts")) {  // of a campaign: as far as it is
    const Json& parts = result["parts"];
    const auto done =
        std::count_if(parts.begin(), parts.end(), [](const Json& part) { return part.value("done", false); });
    shown["verdict"] = fmt::format("{} of {} parts done", done, parts.size());
    shown["complete"] = done == static_cast<std::ptrdiff_t>(parts.size());
  }
  return shown;
}

std::string last_line(const fs::path& log) {
  std::string said = last_words(log, kMostSaid);
  while (said.ends_with('\n')) said.pop_back();
  return said.substr(said.rfind('\n') + 1);  // npos + 1 is 0
}

/// Whether what ended before it was done was meant to. `directory`: of the job.
bool was_stopped(const fs::path& directory) {
  const std::string line = last_line(directory.string() + ".log");
  return line == kAskedToStop || line.starts_with("stopped");
}

void state_of_run(const fs::path& directory, bool held, JobFiles& files, Json& state) {
  const bool claimed = is_claimed(directory);  // before what it says
  const Json progress = files.read(directory / "progress.json"),
             result = files.read(directory / "result.json");
  std::string word = progress.is_object() ? progress.value("state", "") : "";
  if (claimed || held) word = progress.is_object() && claimed ? "running" : "starting";
  else if (result.is_object()) word = "done";
  else if (word != "stopped" && word != "diverged") word = was_stopped(directory) ? "stopped" : "failed";
  state["state"] = word;
  if (progress.is_object() && word != "starting")
    for (const char* key : {"fraction", "time_s", "end_time_s", "step", "eta_s", "wall_time_s"})
      if (progress.contains(key)) state[key] = progress[key];
  if (result.is_object() && word == "done") state.update(result);
}

/// A study or a map. One that ended without having been asked to, and before it was done, has died.
void state_of_study(const fs::path& directory, bool held, JobFiles& files, Json& state) {
  const bool works = held || is_held(directory / "driver");
  const Json result = files.read(directory / "result.json");
  std::error_code none;
  if (!fs::exists(directory / "tasks.jsonl", none)) {
    state["state"] = works ? "starting" : "failed";
    return;
  }
  const TaskStore store = TaskStore::open(directory);
  const StudyStatus status = study_status(store);
  const bool is_map = store.header().value("kind", "") == "map";
  const bool complete = is_map ? result.is_object() && result.value("map_state", "running") != "running"
                               : result.is_object() && status.done + status.failed == status.tasks;
  state["state"] = works                                                ? "running"
                   : complete                                           ? "done"
                   : store.is_asked_to_stop() || was_stopped(directory) ? "stopped"
                                                                        : "failed";
  state["title"] = store.header().value("title", "");
  if (result.is_object() && result.contains("verdict")) state["verdict"] = result["verdict"];
  state["progress"] = status_line(status);
  if (!is_map && status.tasks > 0)  // a map asks for runs as it goes
    state["fraction"] = static_cast<double>(status.done + status.failed) / static_cast<double>(status.tasks);
  if (works && status.seconds_left >= 0.0) state["eta_s"] = status.seconds_left;
}

/// A sorter or a campaign: what it says is all that tells how far it is.
void state_of_other(const fs::path& directory, bool held, JobFiles& files, Json& state) {
  const Json result = files.read(directory / "result.json");
  const bool complete = result.is_object() && result.value("complete", true);
  state["state"] = held ? "running" : complete ? "done" : was_stopped(directory) ? "stopped" : "failed";
  if (held) state["progress"] = last_line(directory.string() + ".log");
  if (result.is_object()) state.update(result);
}

}  // namespace

const Json& JobFiles::read(const fs::path& file) {
  static const Json nothing;
  std::error_code missing;
  const auto written = fs::last_write_time(file, missing);
  if (missing) return nothing;
  Kept& kept = kept_[file];
  if (kept.content.is_null() || kept.written != written) {
    kept.written = written;
    try {
      kept.content = Json::parse(output::read_file(file), nullptr, false);
      if (kept.content.is_discarded()) kept.content = nullptr;
      if (file.filename() == "result.json") kept.content = listed_result(kept.content);
      else if (file.filename() == "manifest.json" || file.filename() == "study.json")
        kept.content = {{"case", kept.content.value("case", "")},
                        {"kind", kept.content.value("kind", "study")}};
    } catch (const std::exception&) {  // it went away, or is of another program
      kept.content = nullptr;
    }
  }
  return kept.content;
}

Json job_state(const std::string& kind, const fs::path& directory, bool held, JobFiles& files) {
  Json state = Json::object();
  try {
    if (kind == "run") state_of_run(directory, held, files, state);
    else if (kind == "study" || kind == "map") state_of_study(directory, held, files, state);
    else state_of_other(directory, held, files, state);
  } catch (const std::exception& e) {  // files that are damaged, or of another program
    state["state"] = held ? "running" : "failed";
    state["said"] = e.what();
  }
  std::error_code none;
  const std::string word = state["state"];
  state["report"] = (kind != "run" || word == "done") && fs::exists(directory / "report.html", none);
  if ((word == "failed" || word == "diverged") && !state.contains("said"))
    if (const std::string said = last_words(directory.string() + ".log", kMostSaid); !said.empty())
      state["said"] = said;
  return state;
}

bool is_worked_on(const std::string& kind, const fs::path& directory) {
  if (kind == "run") return is_claimed(directory);
  return (kind == "study" || kind == "map") && is_held(directory / "driver");
}

std::string last_words(const fs::path& file, std::size_t bytes) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return "";
  const auto size = static_cast<std::size_t>(in.tellg());
  std::string text(std::min(size, bytes), '\0');
  in.seekg(static_cast<std::streamoff>(size - text.size()));
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace ejecta
