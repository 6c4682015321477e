#include "workflow/result_of.hpp"

#include <fmt/format.h>

#include <ostream>
#include <utility>

#include "base/shell_word.hpp"
#include "workflow/watched_run.hpp"

namespace ejecta {

std::optional<nlohmann::ordered_json> result_of(const Case& c, const std::filesystem::path& directory,
                                                Context context) {
  const std::string command =
      fmt::format("ejecta run {} --out {}", shell_word(c.path), shell_word(directory.string()));
  context.files = RunFiles{directory, true, false, command, command};
  const RunOfCase any = [](const Case& of, const Context& in) {
    return is_jet_case(of) ? run_jet(of, jet_of(of).kept_at, in) : run(of, in);
  };
  std::ostream nobody(nullptr);
  Result r = WatchedRun(c, nobody, {.verbosity = output::Verbosity::quiet}).compute(any, std::move(context));
  if (r.end == RunEnd::stopped) return std::nullopt;
  return std::move(r.quantities);
}

}  // namespace ejecta
