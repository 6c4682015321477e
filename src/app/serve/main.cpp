#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "app/cli/commands.hpp"
#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "serve/server.hpp"

/// ejecta-serve FOLDER PORT: what `ejecta serve` becomes.
int main(int, char** argv) {
  using namespace ejecta;
  namespace fs = std::filesystem;
  try {
    const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
    const fs::path beside = here / "ejecta";
    const fs::path program =
        fs::exists(beside) ? beside : here.parent_path().parent_path() / "bin" / "ejecta";
    const SignalWatch signals;
    const Workbench workbench({.folder = argv[1], .program = program, .port = std::atoi(argv[2])});
    fmt::print("{}\n\nOpen this address in a browser of this machine. ^C ends the server, not the runs.\n",
               workbench.address());
    std::fflush(stdout);
    while (!signals.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return exit_done;
  } catch (const InputError& e) {
    print_input_error(e);
    return exit_bad_input;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return exit_failure;
  }
}
