#pragma once
#include "base/text.hpp"

namespace ejecta {

/// Measures the compressible solver on the axisymmetric jet of a valve and tells its cell-steps per second.
void bench_jet(int steps, const Note& tell);

}  // namespace ejecta
