#pragma once
#include "base/text.hpp"

namespace ejecta {

/// What grains smaller than a cell add to a step of the flow, in the box of `standard` without its body:
/// none, 100,000 and 1,000,000 of them.
void bench_grains(const char* standard, int steps, const Note& tell);

}  // namespace ejecta
