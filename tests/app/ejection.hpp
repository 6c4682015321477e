#pragma once
#include "case/load.hpp"
#include "case/template.hpp"

namespace ejecta {

/// The case that `ejecta new ejection` writes.
inline Case ejection(const std::vector<std::string>& overrides = {}) {
  return parse_case(case_template("ejection"), "ejection.toml", overrides);
}

}  // namespace ejecta
