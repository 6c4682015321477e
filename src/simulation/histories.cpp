#include "simulation/histories.hpp"

namespace ejecta {

output::History& Histories::open(const std::string& name, std::vector<output::Column> columns) {
  if (!place_.resumed || !std::filesystem::exists(place_.directory->history(name)))
    return open_anew(name, std::move(columns));
  all_.emplace_back(name, std::make_unique<output::HistoryFile>(place_.directory->history(name),
                                                                std::move(columns), *place_.resumed));
  return *all_.back().second;
}

output::History& Histories::open_anew(const std::string& name, std::vector<output::Column> columns) {
  if (place_.directory)
    all_.emplace_back(name, std::make_unique<output::HistoryFile>(place_.directory->history(name),
                                                                  place_.provenance, std::move(columns)));
  else all_.emplace_back(name, std::make_unique<output::HistoryInMemory>(name, std::move(columns)));
  return *all_.back().second;
}

output::NamedHistories Histories::in_memory() const {
  output::NamedHistories tables;
  if (!place_.directory)
    for (const auto& [name, history] : all_) tables.emplace(name, history->table());
  return tables;
}

}  // namespace ejecta
