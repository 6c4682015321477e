#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace ejecta {

/// What a page is told of the folder: all of it when it comes, then only what has changed. Versions count
/// from 1.
class Changes {
 public:
  /// As it is now: `jobs` have a "name" each (null: they could not be seen), `rest` is told whole. True where
  /// anything has changed.
  bool look(const nlohmann::ordered_json& jobs, const nlohmann::ordered_json& rest);
  std::int64_t version() const { return version_; }
  /// What has changed after a version, as JSON: "jobs", names that are "gone", and of the rest what is new;
  /// after version 0 everything, and "all" says so.
  std::string since(std::int64_t version) const;

 private:
  struct Entry {
    nlohmann::ordered_json value;  ///< null: it is gone
    std::int64_t version = 0;
  };
  bool put(Entry& entry, const nlohmann::ordered_json& value);
  std::map<std::string, Entry> jobs_, rest_;
  std::int64_t version_ = 0;
};

}  // namespace ejecta
