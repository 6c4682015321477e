#include "serve/run_list.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/file_lock.hpp"
#include "output/output_file.hpp"
#include "output/verdict.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The names of a run of a case: "flat.run", "flat-2.run", ...
std::string run_name(const std::string& case_name, int number) {
  const std::string stem = fs::path(case_name).replace_extension().string();
  return number == 1 ? stem + ".run" : fmt::format("{}-{}.run", stem, number);
}

/// Of result.json only what the list shows.
nlohmann::json summary(const nlohmann::json& result) {
  return {{"verdict", output::verdict_sentence(Json(result))},
          {"outcome", result.value("outcome", "")},
          {"title", result.value("title", "")},
          {"wall_time_s", result.value("wall_time_s", 0.0)}};
}

}  // namespace

nlohmann::json RunList::read(const fs::path& file) {
  std::error_code missing;
  const auto written = fs::last_write_time(file, missing);
  if (missing) return nullptr;
  Kept& kept = kept_[file];
  if (kept.content.is_null() || kept.written != written) {
    kept.written = written;
    try {
      kept.content = nlohmann::json::parse(output::read_file(file), nullptr, false);
      if (file.filename() == "result.json") kept.content = summary(kept.content);
      else if (file.filename() == "manifest.json") kept.content = {{"case", kept.content.value("case", "")}};
    } catch (const std::exception&) {  // it went away, or is of another program
      kept.content = nullptr;
    }
  }
  return kept.content;
}

std::string RunList::case_of(const std::string& run) {
  if (const auto it = case_of_started_.find(run); it != case_of_started_.end()) return it->second;
  const nlohmann::json manifest = read(folder_.inside(run) / "manifest.json");
  if (!manifest.is_object()) return "";
  const fs::path file = folder_.path() / manifest.value("case", "");
  return file.lexically_normal().lexically_relative(folder_.path()).string();
}

Json RunList::state_of(const std::string& run) {
  const fs::path directory = folder_.inside(run);
  Json state{{"name", run}, {"case", case_of(run)}};
  const bool claimed = is_claimed(directory), started = processes_.find(run) != 0;  // before what it says
  const nlohmann::json progress = read(directory / "progress.json"), result = read(directory / "result.json");
  std::string word = progress.is_object() ? progress.value("state", "") : "";
  if (claimed || started) word = progress.is_object() && claimed ? "running" : "starting";
  else if (result.is_object()) word = "done";
  else if (word != "stopped" && word != "diverged") word = "failed";
  state["state"] = word;
  if (progress.is_object() && word != "starting")
    for (const char* key : {"fraction", "time_s", "end_time_s", "step", "eta_s", "wall_time_s"})
      if (progress.contains(key)) state[key] = progress[key];
  if (result.is_object() && word == "done") state.update(Json(result));
  std::error_code none;
  state["report"] = word == "done" && fs::exists(directory / "report.html", none);
  if (word == "failed" || word == "diverged") {
    const fs::path log = directory.string() + ".log";
    if (fs::exists(log, none)) {
      const std::string said = output::read_file(log);
      state["said"] = said.substr(said.size() - std::min<std::size_t>(said.size(), 2000));
    }
  }
  return state;
}

Json RunList::all() {
  const std::lock_guard lock(one_at_a_time_);
  std::vector<std::string> names = folder_.content().runs;
  for (const std::string& name : processes_.names()) names.push_back(name);  // before they have a directory
  for (const auto& [name, unused] : case_of_started_)  // those that never got one: their log says why
    if (fs::exists(folder_.inside(name).string() + ".log")) names.push_back(name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  Json list = Json::array();
  for (const std::string& name : names) list.push_back(state_of(name));
  return list;
}

void RunList::require_idle(const std::string& run) {
  if (processes_.find(run) != 0 || is_claimed(folder_.inside(run)))
    throw InputError(fmt::format("{} runs already", run));
}

std::string RunList::start(const std::string& case_name) {
  const std::lock_guard lock(one_at_a_time_);
  if (!fs::is_regular_file(folder_.inside(case_name)))
    throw InputError(fmt::format("there is no case {}", case_name));
  std::string run;
  for (int number = 1; run.empty(); ++number) {
    const std::string name = run_name(case_name, number);
    require_idle(name);
    const fs::path directory = folder_.inside(name);
    if (!fs::exists(directory) && !fs::exists(directory.string() + ".log")) run = name;
  }
  processes_.start(run, {"run", case_name, "--out", run}, folder_.path(),
                   folder_.inside(run).string() + ".log");
  case_of_started_[run] = case_name;
  return run;
}

void RunList::resume(const std::string& run) {
  const std::lock_guard lock(one_at_a_time_);
  require_idle(run);
  if (!fs::exists(folder_.inside(run) / "manifest.json"))
    throw InputError(fmt::format("there is no run {}", run));
  processes_.start(run, {"run", (fs::path(run) / "case.toml").string(), "--out", run, "--resume"},
                   folder_.path(), folder_.inside(run).string() + ".log");
}

void RunList::stop(const std::string& run) {
  const std::lock_guard lock(one_at_a_time_);
  const fs::path directory = folder_.inside(run);
  pid_t process = processes_.find(run);
  if (process == 0 && is_claimed(directory)) {
    const nlohmann::json progress = read(directory / "progress.json");
    if (progress.is_object()) process = progress.value("process", 0);
  }
  if (process <= 0) throw InputError(fmt::format("{} does not run", run));
  ::kill(process, SIGTERM);
}

}  // namespace ejecta
