#pragma once

namespace ejecta {

/// Measures the compressible solver on the axisymmetric jet of a valve and prints its cell-steps per second.
void bench_jet(int steps);

}  // namespace ejecta
