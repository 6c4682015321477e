#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/history.hpp"
#include "output/run_directory.hpp"

namespace ejecta {

/// A new history, or the one of the run that is resumed at that time, s.
inline std::unique_ptr<output::HistoryFile> open_history(const output::RunDirectory& directory,
                                                         const std::string& name,
                                                         const std::vector<std::string>& provenance,
                                                         std::vector<output::Column> columns,
                                                         std::optional<double> resumed) {
  const auto path = directory.history(name);
  if (resumed && std::filesystem::exists(path))
    return std::make_unique<output::HistoryFile>(path, std::move(columns), *resumed);
  return std::make_unique<output::HistoryFile>(path, provenance, std::move(columns));
}

}  // namespace ejecta
