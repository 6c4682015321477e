#include "case/required_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "case/load.hpp"

namespace ejecta {

bool require_file(const Case& c, const std::string& key, const std::string& file, const std::string& missing,
                  const std::string& example, Findings& found) {
  std::error_code none;
  const std::string path = beside_case(c, file);
  if (!file.empty() && std::filesystem::is_regular_file(path, none)) return true;
  found.error(key, file.empty() ? missing : fmt::format("there is no file \"{}\"", path),
              "a file, relative to the folder of the case", example);
  return false;
}

}  // namespace ejecta
