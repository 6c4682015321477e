#include "serve/queue.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/file_lock.hpp"
#include "output/output_file.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json queued_json(const std::vector<Job>& jobs) {
  Json list = Json::array();
  for (const Job& j : jobs)
    list.push_back({{"name", j.name},
                    {"kind", j.kind},
                    {"case", j.case_name},
                    {"digest", j.digest},
                    {"resumes", j.resumes},
                    {"said", j.said}});
  return list;
}

std::vector<Job> queued_jobs(const Json& list) {
  std::vector<Job> jobs;
  for (const Json& j : list)
    jobs.push_back({.name = j.at("name"),
                    .kind = j.at("kind"),
                    .case_name = j.at("case"),
                    .digest = j.at("digest"),
                    .resumes = j.at("resumes"),
                    .said = j.at("said")});
  return jobs;
}

std::string text_of(const Queue::State& state) {
  const Json json{{"at_once", state.at_once},
                  {"waiting", queued_json(state.waiting)},
                  {"started", queued_json(state.started)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Queue::State Queue::read() const {
  std::error_code none;
  if (!std::filesystem::exists(file(), none)) return {};
  try {
    const Json json = Json::parse(output::read_file(file()));
    const Json& at_once = json.at("at_once");
    if (at_once.is_number_integer() && at_once >= 1 && at_once <= kMostAtOnce)
      return {at_once, queued_jobs(json.at("waiting")), queued_jobs(json.at("started"))};
  } catch (const Json::exception&) {  // it is told below
  }
  throw Error(fmt::format("{} is damaged: remove it, and start again what waited", file().string()));
}

void Queue::change(const std::function<void(State&, const Keep&)>& act) const {
  std::filesystem::create_directories(place_);
  const FileLock lock(place_ / "lock");
  State state = read();
  std::string kept = text_of(state);
  const auto keep = [&] {
    std::string text = text_of(state);
    if (text == kept) return;
    output::OutputFile written(file());
    written.write(text);
    written.commit_durably();
    kept = std::move(text);
  };
  act(state, keep);
  keep();
}

}  // namespace ejecta
