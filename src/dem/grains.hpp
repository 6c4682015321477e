#pragma once
#include "case/case.hpp"
#include "dem/particles.hpp"

namespace ejecta {

/// Adds the [[grains]] of a case to its bodies, one sphere each, behind those that are there: sizes and
/// places are drawn by counting, so that any run of the case gets the same. At random they keep clear of each
/// other, of bodies and of planes. Throws InputError where they find no room.
void add_grains(const Case& c, Particles& particles);

}  // namespace ejecta
