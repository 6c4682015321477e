#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulation/run.hpp"

namespace ejecta {

/// Runs a case anew into a directory, or computes the jet where it is one of those, without a word: what its
/// result.json says. Nothing where it was stopped. `context`: who looks on; its files are these.
std::optional<nlohmann::ordered_json> result_of(const Case& c, const std::filesystem::path& directory,
                                                Context context);

}  // namespace ejecta
