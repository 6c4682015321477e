#pragma once
#include <string>

#include "case/case.hpp"
#include "case/findings.hpp"

namespace ejecta {

/// Whether the file that `key` names is there; what is not is told. `missing`: what to say where none is
/// named; `example`: a line with one.
bool require_file(const Case& c, const std::string& key, const std::string& file, const std::string& missing,
                  const std::string& example, Findings& found);

}  // namespace ejecta
