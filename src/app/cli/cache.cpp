#include "jet/cache.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/cli/commands.hpp"
#include "base/exit_code.hpp"

namespace ejecta {

void add_cache(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("cache", "Lists the stored jets, or removes them");
  auto clear = std::make_shared<bool>(false);
  command->add_flag("--clear", *clear, "Remove them; later runs compute their jets again");
  command->footer("Example:\n  ejecta cache --clear");
  command->callback([clear, &action] {
    action = [clear] {
      if (*clear) fmt::print("jets removed: {}\n", clear_cache(cache_directory()));
      else fmt::print("{}", cache_listing(cache_directory()));
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
