#pragma once
#include <string>

namespace ejecta::output {

/// What the words of results mean that `word` is, or is part of; none: "".
std::string explain_result(const std::string& word);

}  // namespace ejecta::output
