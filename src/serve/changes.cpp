#include "serve/changes.hpp"

#include <set>

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

std::string compact(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

/// The version it gets is that of this look.
bool Changes::put(Entry& entry, const Json& value) {
  if (entry.version > 0 && entry.value == value) return false;
  entry = {value, version_ + 1};
  return true;
}

bool Changes::look(const Json& jobs, const Json& rest) {
  bool changed = false;
  std::set<std::string> there;
  for (const Json& job : jobs) {
    const std::string& name = job["name"].get_ref<const std::string&>();
    there.insert(name);
    changed = put(jobs_[name], job) || changed;
  }
  for (auto& [name, entry] : jobs_)
    if (!jobs.is_null() && !there.contains(name)) changed = put(entry, nullptr) || changed;
  for (const auto& [name, value] : rest.items()) changed = put(rest_[name], value) || changed;
  if (changed) ++version_;
  return changed;
}

std::string Changes::since(std::int64_t version) const {
  std::string all = "{\"jobs\":[";
  Json gone = Json::array();
  const char* comma = "";
  for (const auto& [name, entry] : jobs_) {
    if (entry.version <= version) continue;
    if (entry.value.is_null()) {
      if (version > 0) gone.push_back(name);
      continue;
    }
    all += comma + compact(entry.value);
    comma = ",";
  }
  all += "],\"gone\":" + compact(gone);
  for (const auto& [name, entry] : rest_)
    if (entry.version > version) all += "," + compact(name) + ":" + compact(entry.value);
  if (version == 0) all += ",\"all\":true";
  return all + "}";
}

}  // namespace ejecta
