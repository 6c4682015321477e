// Makes the report of run directories: make_report OUT.html DIR [DIR...]
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

#include "output/report.hpp"

int main(int argc, char** argv) try {
  const std::vector<std::filesystem::path> runs(argv + 2, argv + argc);
  ejecta::output::write_report(runs, argv[1]);
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
