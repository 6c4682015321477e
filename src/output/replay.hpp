#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "output/output_file.hpp"
#include "output/report_data.hpp"

namespace ejecta::output {

/// replay.jsonl: one JSON object a line, the header and then the frames (docs/files.md). Every frame reaches
/// the system at once.
class ReplayFile {
 public:
  ReplayFile(const std::filesystem::path& path, const ReplayHeader& header);
  /// Goes on with an existing file after removing the frames later than `time`, s.
  ReplayFile(const std::filesystem::path& path, double time);
  void add(const ReplayFrame& frame);

 private:
  LineFile file_;
  std::string line_;
  std::vector<std::uint8_t> packed_;
};

/// The whole lines of a replay file, the torn last one left out; empty when there is no such file.
std::vector<std::string> read_replay_lines(const std::filesystem::path& path);

}  // namespace ejecta::output
