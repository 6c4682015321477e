#include "app/simulation.hpp"
#include "base/shell_word.hpp"

namespace ejecta {
std::string command_line_of(const std::string& command, const Case& c, const RunOptions& options) {
  std::string line = "ejecta " + command + " " + shell_word(c.path);
  for (const std::string& set : options.overrides) line += " --set " + shell_word(set);
  if (!options.out.empty()) line += " --out " + shell_word(options.out);
  return line;
}

}  // namespace ejecta
