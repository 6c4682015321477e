#pragma once
#include "base/text.hpp"

namespace ejecta {

/// Measures bodies that touch: 10,000 spheres that settle, a belt of 2,000 mixed polyhedra, and 1,000 to
/// 100,000 spheres in contact; or only spheres that have settled. Tells particle-steps/s, cost of a contact
/// and share of each stage.
void bench_dem(bool only_settled, const Note& tell);

}  // namespace ejecta
