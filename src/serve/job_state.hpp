#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace ejecta {

/// Small JSON files, read again only where they have changed.
class JobFiles {
 public:
  /// Of result.json, manifest.json and study.json only what lists show; null where there is no such file.
  const nlohmann::ordered_json& read(const std::filesystem::path& file);

 private:
  struct Kept {
    std::filesystem::file_time_type written;
    nlohmann::ordered_json content;
  };
  std::map<std::filesystem::path, Kept> kept_;
};

/// What is known of a job from its directory. `held`: its process was started by a server and goes on. state,
/// and where they are known fraction, time_s, eta_s, wall_time_s, verdict, title, outcome, report, progress
/// (in words), said (the end of its log, where something went wrong).
nlohmann::ordered_json job_state(const std::string& kind, const std::filesystem::path& directory, bool held,
                                 JobFiles& files);

/// Whether somebody works in the directory, by whom ever it was started; of a sorter or a campaign that is
/// not to be seen.
bool is_worked_on(const std::string& kind, const std::filesystem::path& directory);

/// What stands in the log of one that was asked to stop.
inline constexpr const char* kAskedToStop = "asked to stop";

/// The end of a text file; "" where there is none.
std::string last_words(const std::filesystem::path& file, std::size_t bytes);

}  // namespace ejecta
