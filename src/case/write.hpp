#pragma once
#include <string>

#include "case/case.hpp"

namespace ejecta {

/// The resolved case as TOML, every key with its value; load_case reads it back to the same bits.
std::string write_case(const Case&);

}  // namespace ejecta
