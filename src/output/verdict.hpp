#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ejecta::output {

/// The result in one sentence (docs/files.md: result.json), for the terminal and the head of the report: the
/// outcome of the body with its margins, of several bodies which are ejected, or what was computed when there
/// is no verdict.
std::string verdict_sentence(const nlohmann::ordered_json& result);

/// Names of the bodies that the end of the run kept from a verdict.
std::vector<std::string> undecided_bodies(const nlohmann::ordered_json& result);

}  // namespace ejecta::output
