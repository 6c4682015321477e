#pragma once
#include <fmt/format.h>

#include <string>

#include "case/findings.hpp"

/// Names in lists of structs with a `name`.
namespace ejecta {

/// A name that occurs twice is an error.
template <class List>
void check_names(const List& list, const std::string& section, Findings& found) {
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (list[i].name == list[j].name) {
        found.error(fmt::format("{}.{}.name", section, i),
                    fmt::format("the name \"{}\" is taken already", list[i].name),
                    "a name of its own for each", fmt::format("name = \"{}-2\"", list[i].name));
        break;
      }
}

inline constexpr std::size_t kLongestName = 100;  ///< that becomes part of a file name

/// As check_names, for names that become part of a file name.
template <class List>
void check_file_names(const List& list, const std::string& section, Findings& found) {
  check_names(list, section, found);
  for (std::size_t n = 0; n < list.size(); ++n)
    if (list[n].name.empty() || list[n].name.size() > kLongestName ||
        list[n].name.find_first_of("/\\") != std::string::npos)
      found.error(fmt::format("{}.{}.name", section, n), "the name becomes part of a file name",
                  fmt::format("a name without slashes of at most {} letters", kLongestName),
                  "name = \"at-75mm\"");
}

}  // namespace ejecta
