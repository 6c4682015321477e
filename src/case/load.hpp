#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// Reads the case file, applies `overrides` ("run.end_time=8 ms", "body.0.velocity=[...]"; list elements by
/// number or name), fills in what follows from other keys and checks the sense of it. Throws InputError that
/// lists all errors of the file, each with its line.
Case load_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from a text; `name` stands for the path in messages.
Case parse_case(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {});

}  // namespace ejecta
