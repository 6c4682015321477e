#pragma once
#include <string>
#include <string_view>

namespace ejecta {

/// A word as the shell takes it for what it is.
inline std::string shell_word(std::string_view word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/=:+,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word)
    if (c == '\'') quoted += "'\\''";
    else quoted += c;
  return quoted + "'";
}

/// The path of a file as a word of a command: one that begins with "-" would be taken for an option.
inline std::string path_word(const std::string& path) { return path.starts_with('-') ? "./" + path : path; }

}  // namespace ejecta
