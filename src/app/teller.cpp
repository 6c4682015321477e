#include "app/teller.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "base/stopwatch.hpp"

namespace ejecta {

void print_note(const std::string& line) { fmt::print(stderr, "{}\n", line); }
void print_result(const std::string& line) { fmt::print("{}\n", line); }

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

Teller::Teller(bool quiet) : quiet_(quiet), terminal_(::isatty(2) == 1), said_(wall_seconds()) {}

void Teller::tell(const std::function<std::string()>& line, bool last) {
  const double now = wall_seconds();
  if (quiet_ || (!last && now - said_ < (terminal_ ? 0.5 : 5.0))) return;
  said_ = now;
  if (terminal_) fmt::print(stderr, "\r\x1b[K{}{}", line(), last ? "\n" : "");
  else print_note(line());
  std::fflush(stderr);
}

}  // namespace ejecta
