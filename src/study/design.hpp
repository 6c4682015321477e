#pragma once
#include <cstdint>
#include <vector>

namespace ejecta {

/// Points of the unit cube, one list of coordinates a point.
using Samples = std::vector<std::vector<double>>;

/// Each coordinate takes one value in each of `samples` equal parts of (0, 1), in random order (McKay,
/// Beckman & Conover 1979).
Samples latin_hypercube(int samples, int dimensions, std::int64_t seed);

inline constexpr int kSobolDimensions = 16;
/// The first points of the Sobol sequence with the direction numbers of Joe & Kuo (2008), all moved by one
/// random vector (modulo 1), so that none lies at an end. At most kSobolDimensions.
Samples sobol(int samples, int dimensions, std::int64_t seed);

}  // namespace ejecta
