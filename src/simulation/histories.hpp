#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/history.hpp"
#include "output/run_directory.hpp"

namespace ejecta {

/// Where a run keeps what it records.
struct OutputPlace {
  std::optional<output::RunDirectory> directory{};  ///< none: histories are kept in memory, nothing else is
  std::vector<std::string> provenance{};            ///< head lines of its files
  std::optional<double> resumed{};                  ///< s: goes on from there with the files of the directory
};

/// The histories of a run: files of its directory, or tables in memory.
class Histories {
 public:
  explicit Histories(OutputPlace place) : place_(std::move(place)) {}

  /// A new one, or that of the run that is resumed. Lives as long as this.
  output::History& open(const std::string& name, std::vector<output::Column> columns);
  /// One that is written at once, after the last step.
  output::History& open_anew(const std::string& name, std::vector<output::Column> columns);
  /// Those in memory, by name.
  output::NamedHistories in_memory() const;

 private:
  OutputPlace place_;
  std::vector<std::pair<std::string, std::unique_ptr<output::History>>> all_;
};

}  // namespace ejecta
