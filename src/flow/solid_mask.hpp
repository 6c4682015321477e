#pragma once
#include "flow/cut_cells.hpp"

namespace ejecta {

/// The seam between bodies and flow. Coupling (or an analytic test) fills it; the flow adds what walls took.
struct SolidMask {
  CutCells cut;
};

}  // namespace ejecta
