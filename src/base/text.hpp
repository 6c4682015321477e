#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ejecta {

/// Is told a line about what takes long or was passed over; empty: nobody listens.
using Note = std::function<void(const std::string&)>;

/// The candidate that differs from `word` in the fewest letters or begins with it, if that is a likely typing
/// error; else "".
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view separator = ", ");

}  // namespace ejecta
