#include <algorithm>

#include "app/simulation.hpp"

namespace ejecta {
namespace {

/// A word as the shell takes it for what it is.
std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/=:+,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word)
    if (c == '\'') quoted += "'\\''";
    else quoted += c;
  return quoted + "'";
}

}  // namespace

std::string command_line_of(const std::string& command, const Case& c, const RunOptions& options) {
  std::string line = "ejecta " + command + " " + shell_word(c.path);
  for (const std::string& set : options.overrides) line += " --set " + shell_word(set);
  if (!options.out.empty()) line += " --out " + shell_word(options.out);
  return line;
}

}  // namespace ejecta
