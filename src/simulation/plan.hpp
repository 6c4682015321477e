#pragma once
#include <string>
#include <vector>

#include "base/stopwatch.hpp"
#include "case/case.hpp"

namespace ejecta {

/// The operators of a time step of a case in their order, with their equations; none has run. Throws
/// InputError where the case cannot be set up.
std::vector<OperatorTime> planned_step(const Case& c);
/// The same as `ejecta plan` prints it.
std::string plan_text(const Case& c, const std::vector<OperatorTime>& step);

}  // namespace ejecta
