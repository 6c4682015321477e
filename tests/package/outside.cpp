#include <cstdio>

#include "case/load.hpp"
#include "simulation/run.hpp"

/// outside CASE: runs the case without files, on one thread and on two, and prints how far it came.
int main(int, char** argv) {
  const ejecta::Case c = ejecta::load_case(argv[1]);
  int seen = 0;
  const ejecta::Result one =
      ejecta::run(c, {.threads = 1, .observe = [&](const ejecta::Moment&) { ++seen; }});
  const ejecta::Result two = ejecta::run(c, {.threads = 2});
  std::printf("%lld steps to %.6f s, seen %d\n", static_cast<long long>(one.steps), one.time, seen);
  return one.steps == two.steps && one.quantities["bodies"] == two.quantities["bodies"] ? 0 : 1;
}
