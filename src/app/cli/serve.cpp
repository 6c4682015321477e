#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "app/cli/commands.hpp"
#include "base/error.hpp"

namespace ejecta {
namespace {

/// The server is a program of its own beside this one: its libraries would double the time that this one
/// takes to start.
std::filesystem::path server_program() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const auto& place :
       {folder / "ejecta-serve", folder.parent_path() / "libexec" / "ejecta" / "ejecta-serve"})
    if (std::filesystem::exists(place)) return place;
  throw InputError(
      "this program was built without its server\n  expected: libcpp-httplib-dev installed when it is built "
      "(tools/setup.sh does that)");
}

}  // namespace

void add_serve(CLI::App& app, Action& action) {
  struct Options {
    std::string folder = ".";
    int port = 0;
  };
  CLI::App* command =
      app.add_subcommand("serve", "The workbench in the browser: cases, runs, reports of a folder");
  auto o = std::make_shared<Options>();
  command->add_option("FOLDER", o->folder, "Folder with cases (default: this one)")->type_name("");
  command->add_option("--port", o->port, "Port (default: any that is free)")
      ->type_name("N")
      ->check(CLI::Range(1, 65535).description(""));
  command->footer(
      "Only this machine, and only who knows the address it prints, can open it. ^C ends the server; runs go "
      "on,\n"
      "and the next server finds them.\n\nExample:\n  ejecta serve my-cases");
  command->callback([o, &action] {
    action = [o]() -> int {
      const std::string server = server_program().string(), port = std::to_string(o->port);
      ::execl(server.c_str(), server.c_str(), o->folder.c_str(), port.c_str(), nullptr);
      throw Error(fmt::format("cannot start {}: {}", server, std::strerror(errno)));
    };
  });
}

}  // namespace ejecta
