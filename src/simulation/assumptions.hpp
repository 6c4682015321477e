#pragma once
#include <vector>

#include "case/case.hpp"
#include "output/report_data.hpp"

namespace ejecta {

/// What a run takes for granted that the user should know: the defaults that decide its result, of keys that
/// act in this case and that the user has not set. `check` and the report show this one list.
std::vector<output::Assumption> assumptions(const Case& c);

/// What the user has set that decides the result, as one reads it: pressures of the supply above the ambient.
std::vector<output::Input> inputs(const Case& c);

}  // namespace ejecta
