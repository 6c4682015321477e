#pragma once
#include "case/case.hpp"
#include "study/perform.hpp"

namespace ejecta {

/// One run as a study asks for it: goes on from its last checkpoint, or takes the result that is there.
RunAnswer run_for_study(const Case& c, const RunRequest& request);

}  // namespace ejecta
