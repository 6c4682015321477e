#pragma once
#include <string>

#include "base/text.hpp"

namespace ejecta {

struct BenchOptions {
  int threads = 0;
  int steps = 20;    ///< timed steps
  std::string only;  ///< "flow": a step of the standard case; "dem": bodies that touch; "settled": of these
                     ///< only settled spheres; "grains": grains in the flow
};

/// Measures cell-steps and particle-steps per second on standard cases; `tell` receives the tables line by
/// line.
void bench(const BenchOptions& options, const Note& tell);

}  // namespace ejecta
