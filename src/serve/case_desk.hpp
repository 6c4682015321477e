#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ejecta {

/// All keys with their help, section by section, for a form.
nlohmann::ordered_json form_of_schema();

/// What there is to say of the text of a case while it is typed. `path`: where it is or will be, for the
/// files that it names. problems (as `ejecta check --json` has them), values ({"valve.duration": {"text",
/// "given"}}), commands (of the program that the case has what it takes for), and without an error check (the
/// rest of `ejecta check --json`) and drawing (places in the plane of the path, m; of a body also the outline
/// of its convex hull about its centre).
nlohmann::ordered_json judge_case(const std::string& text, const std::string& path, double bandwidth);

/// Lengths of the box about the surface in an STL file along x, y, z, in its own unit. Throws InputError for
/// what is no such file.
nlohmann::ordered_json extent_of_stl(const std::string& bytes, const std::string& name);

}  // namespace ejecta
