#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ejecta {

/// All keys with their help, section by section, for a form.
nlohmann::ordered_json form_of_schema();

/// What there is to say of the text of a case while it is typed. `path`: where it is or will be, for the
/// files that it names. problems (as `ejecta check --json` has them), values ({"valve.duration": {"text",
/// "given"}}), and without an error check (the rest of `ejecta check --json`) and drawing (places in the
/// plane of the path, m).
nlohmann::ordered_json judge_case(const std::string& text, const std::string& path, double bandwidth);

}  // namespace ejecta
