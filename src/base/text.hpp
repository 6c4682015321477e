#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ejecta {

/// The candidate that differs from `word` in the fewest letters or begins with it, if that is a likely typing
/// error; else "".
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view separator = ", ");

}  // namespace ejecta
