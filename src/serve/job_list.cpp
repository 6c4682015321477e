#include "serve/job_list.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/sha256.hpp"
#include "base/shell_word.hpp"
#include "base/told.hpp"
#include "case/load.hpp"
#include "output/output_file.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The names of jobs of a case: "flat.run", "flat-2.run", ...
std::string job_name(const std::string& case_name, const std::string& kind, int number) {
  const std::string stem = fs::path(case_name).replace_extension().string();
  return number == 1 ? stem + "." + kind : fmt::format("{}-{}.{}", stem, number, kind);
}

/// Of a case with all that it extends and reads. One that cannot be read as a case is known by its text.
std::string digest_of_case(const fs::path& file) {
  try {
    return study_header("", load_case(file.string())).at("input_sha256");
  } catch (const Error&) {
    return sha256_hex(output::read_file(file));
  }
}

Json listed(const std::string& name, const std::string& kind, const std::string& case_name) {
  return {{"name", name}, {"kind", kind}, {"case", case_name}};
}

const Job* find(const std::vector<Job>& jobs, const std::string& name) {
  const auto it = std::find_if(jobs.begin(), jobs.end(), [&](const Job& j) { return j.name == name; });
  return it == jobs.end() ? nullptr : &*it;
}

std::uintmax_t size_of(const fs::path& file) {
  std::error_code missing;
  const auto size = fs::file_size(file, missing);
  return missing ? 0 : size;
}

/// Changes when somebody goes on with a job: he writes there. `kind`: of its directory.
std::string stamp_of(const fs::path& directory, const std::string& kind) {
  std::string stamp = std::to_string(size_of(directory.string() + ".log"));
  std::vector<const char*> places{"result.json"};
  if (kind == "run") places.push_back("progress.json");
  if (kind == "study") places.insert(places.end(), {"running", "results", "failed"});
  if (kind == "sort") places.push_back("state.json");
  for (const char* place : places) {
    std::error_code none;
    const auto written = fs::last_write_time(directory / place, none);
    stamp += fmt::format(" {}", none ? 0 : written.time_since_epoch().count());
  }
  return stamp;
}

}  // namespace

bool JobList::goes_on(const std::string& name) {
  return is_held(log_of(name)) || is_worked_on(kind_of(name), folder_.inside(name));
}

/// Whether it was started, by a server that may have died before it could say so.
bool JobList::has_begun(const Job& job) const {
  const fs::path log = log_of(job.name);
  return is_held(log) || size_of(log) > job.said || (!job.resumes && fs::exists(folder_.inside(job.name)));
}

std::string JobList::kind_of(const std::string& name) {
  const fs::path directory = folder_.inside(name);
  const std::string kind = kind_of_directory(directory);
  return kind.empty() ? kind_of_name(name) : kind_of(directory, kind);
}

/// A study may be a map.
std::string JobList::kind_of(const fs::path& directory, const std::string& kind) {
  if (kind == "study")
    if (const Json& head = files_.read(directory / "study.json"); head.is_object()) return head["kind"];
  return kind;
}

std::string JobList::case_of(const std::string& name) {
  const fs::path directory = folder_.inside(name);
  std::error_code none;
  for (const char* file : {"manifest.json", "study.json"})
    if (const Json& head = files_.read(directory / file); head.is_object()) {
      const fs::path full = (folder_.path() / head.value("case", "")).lexically_normal();
      if (full.filename() != "case.toml" && fs::is_regular_file(full, none))
        return full.lexically_relative(folder_.path()).string();
    }
  // "flat-2.run" is of flat-2.toml or else of flat.toml
  std::string stem = fs::path(name).replace_extension().string();
  if (fs::is_regular_file(folder_.path() / (stem + ".toml"), none)) return stem + ".toml";
  if (const auto dash = stem.rfind('-'); dash != std::string::npos) stem.resize(dash);
  return stem + ".toml";
}

Json JobList::all(const Folder::Content& content, bool ended_too) {
  const std::lock_guard lock(one_at_a_time_);
  const Queue::State queue = queue_.read();
  Json list = Json::array();
  std::map<std::string, Ended> still_ended;
  std::map<std::string, std::string> there = content.jobs;
  for (const Job& job : queue.started)
    there.try_emplace(job.name, job.kind);  // since the folder was looked at
  for (const auto& [name, kind_there] : there) {
    if (find(queue.waiting, name)) continue;
    const fs::path directory = folder_.path() / name;
    const bool active = find(queue.started, name) != nullptr;
    const auto it = ended_.find(name);
    const bool known = !active && it != ended_.end();
    std::string stamp = known && !ended_too ? it->second.stamp : stamp_of(directory, kind_there);
    if (known && it->second.stamp == stamp) {
      list.push_back(it->second.state);
      still_ended.insert(ended_.extract(it));
      continue;
    }
    const std::string kind = kind_of(directory, kind_there);
    Json now = listed(name, kind, case_of(name));
    now.update(job_state(kind, directory, is_held(directory.string() + ".log"), files_));
    list.push_back(now);
    if (const std::string word = now["state"]; !active && word != "running" && word != "starting")
      still_ended[name] = {std::move(stamp), std::move(now)};
  }
  for (std::size_t n = 0; n < queue.waiting.size(); ++n) {
    const Job& job = queue.waiting[n];
    list.push_back(listed(job.name, job.kind, job.case_name));
    list.back().update(Json{{"state", "waiting"}, {"before", n}, {"report", false}});
  }
  ended_ = std::move(still_ended);
  if (!queue.waiting.empty())
    std::sort(list.begin(), list.end(), [](const Json& a, const Json& b) {
      return a["name"].get_ref<const std::string&>() < b["name"].get_ref<const std::string&>();
    });
  return list;
}

Json JobList::settings() { return {{"at_once", queue_.read().at_once}}; }

void JobList::set_at_once(int count) {
  if (count < 1 || count > Queue::kMostAtOnce)
    throw InputError(fmt::format("{} at once cannot be\n  expected: 1 to {}", count, Queue::kMostAtOnce));
  {
    const std::lock_guard lock(one_at_a_time_);
    queue_.change([&](Queue::State& q, const Queue::Keep&) { q.at_once = count; });
  }
  advance();
}

std::string JobList::start(const std::string& case_name, const std::string& kind) {
  if (kind.empty() || kind_of_name("." + kind) != kind)
    throw InputError(fmt::format("\"{}\" cannot be started", kind));
  const fs::path file = folder_.inside(case_name);
  if (!fs::is_regular_file(file)) throw InputError(fmt::format("there is no case {}", case_name));
  Job job{.name = "", .kind = kind, .case_name = case_name, .digest = digest_of_case(file)};
  {
    const std::lock_guard lock(one_at_a_time_);
    queue_.change([&](Queue::State& q, const Queue::Keep&) {
      for (int number = 1; job.name.empty(); ++number) {
        const std::string name = job_name(case_name, kind, number);
        if (find(q.waiting, name))
          throw InputError(fmt::format(
              "{} waits already\n  expected: another case, a copy of this one, or that one cancelled", name));
        if (goes_on(name))
          throw InputError(
              fmt::format("{} runs already\n  expected: another case or a copy of this one", name));
        if (!fs::exists(folder_.inside(name)) && !fs::exists(log_of(name))) job.name = name;
      }
      q.waiting.push_back(job);
    });
  }
  advance();
  return job.name;
}

void JobList::resume(const std::string& name) {
  if (!fs::exists(folder_.inside(name)) || kind_of(name).empty())
    throw InputError(fmt::format("there is nothing like {}", name));
  {
    const std::lock_guard lock(one_at_a_time_);
    queue_.change([&](Queue::State& q, const Queue::Keep&) {
      if (find(q.waiting, name)) throw InputError(fmt::format("{} waits already", name));
      if (goes_on(name)) throw InputError(fmt::format("{} runs already", name));
      q.waiting.push_back({.name = name,
                           .kind = kind_of(name),
                           .case_name = case_of(name),
                           .digest = "",
                           .resumes = true,
                           .said = size_of(log_of(name))});
    });
  }
  advance();
}

void JobList::stop(const std::string& name) {
  const fs::path directory = folder_.inside(name);
  const std::lock_guard lock(one_at_a_time_);
  bool waited = false;
  if (find(queue_.read().waiting, name))
    queue_.change([&](Queue::State& q, const Queue::Keep&) {
      waited = std::erase_if(q.waiting, [&](const Job& job) { return job.name == name; }) > 0;
    });
  if (waited) return;
  if (!goes_on(name)) throw InputError(fmt::format("{} does not run", name));
  const std::string kind = kind_of(name);
  std::error_code none;
  if ((kind == "study" || kind == "map") && fs::exists(directory / "tasks.jsonl", none))
    TaskStore::open(directory).ask_to_stop(true);
  if (ask_to_stop(log_of(name))) {
    std::ofstream(log_of(name), std::ios::app) << kAskedToStop << "\n";  // one that has not begun cannot say
    return;
  }
  if (kind != "run") return;
  const Json& progress = files_.read(directory / "progress.json");  // started at a terminal
  if (!progress.is_object()) return;                                // it has not begun
  const auto process = progress.value("process", std::int64_t{0});
  if (process <= 0 || !std::in_range<pid_t>(process))
    throw InputError(fmt::format("{} runs inside another program, such as a notebook: stop it there", name));
  ::kill(static_cast<pid_t>(process), SIGTERM);
}

void JobList::remove(const std::string& name) {
  const fs::path directory = folder_.inside(name), log = log_of(name);
  const std::lock_guard lock(one_at_a_time_);
  if (find(queue_.read().waiting, name)) throw InputError(fmt::format("{} waits: cancel it first", name));
  const fs::path inside = directory.lexically_relative(folder_.path());
  const bool hidden =
      std::any_of(inside.begin(), inside.end(), [](const fs::path& part) { return part.string()[0] == '.'; });
  if (hidden || kind_of(name).empty() || (!fs::exists(directory) && !fs::exists(log)))
    throw InputError(fmt::format("there is nothing like {}", name));
  if (goes_on(name)) throw InputError(fmt::format("{} goes on: stop it first", name));
  // That it has ended may not have been noticed yet.
  queue_.change([&](Queue::State& q, const Queue::Keep&) {
    std::erase_if(q.started, [&](const Job& job) { return job.name == name; });
  });
  fs::path away;
  for (int number = 1; away.empty() || fs::exists(away); ++number)
    away = folder_.path() / ".removed" / std::to_string(number);
  away /= inside;
  fs::create_directories(away.parent_path());
  if (fs::exists(directory)) fs::rename(directory, away);
  if (fs::exists(log)) fs::rename(log, away.string() + ".log");
}

void JobList::launch(const Job& job, int side_by_side) {
  const bool resumes = job.resumes && job.kind == "run";  // the others do so by themselves
  const std::string file = resumes ? (fs::path(job.name) / "case.toml").string() : job.case_name;
  std::vector<std::string> words{job.kind, path_word(file), "--out", path_word(job.name)};
  if (resumes) words.push_back("--resume");
  if (side_by_side > 1 && job.kind != "campaign")  // they share the cores
    words.push_back(fmt::format("--{}={}", job.kind == "run" || job.kind == "sort" ? "threads" : "at-once",
                                std::max(1, core_count() / side_by_side)));
  const fs::path log = log_of(job.name);
  try {
    if (!job.digest.empty() && digest_of_case(folder_.inside(job.case_name)) != job.digest)
      throw InputError(fmt::format("{}, or what it reads, was changed while {} waited: start it again",
                                   job.case_name, job.name));
    processes_.start(words, folder_.path(), log);
  } catch (const InputError& e) {  // said where a run says what it has met
    std::ofstream(log, std::ios::app) << "error: " << told(e) << "\n";
  } catch (const std::exception& e) {
    std::ofstream(log, std::ios::app) << "error: " << e.what() << "\n";
  }
}

void JobList::advance() {
  const std::lock_guard lock(one_at_a_time_);
  if (const Queue::State q = queue_.read(); q.waiting.empty() && q.started.empty()) return;
  queue_.change([&](Queue::State& q, const Queue::Keep& keep) {
    std::erase_if(q.started, [&](const Job& job) { return !goes_on(job.name); });
    while (!q.waiting.empty() && static_cast<int>(q.started.size()) < q.at_once) {
      const Job job = q.waiting.front();
      if (!has_begun(job)) launch(job, q.at_once);
      q.waiting.erase(q.waiting.begin());
      q.started.push_back(job);
      keep();  // at once: a job is started before it is no more said to wait, and has_begun() tells
    }
  });
}

}  // namespace ejecta
