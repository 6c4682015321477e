#pragma once
#include <string>

#include "case/case.hpp"

namespace ejecta {

/// The resolved case as TOML: what the user gave and what follows from it; the defaults of all other keys as
/// comments, so that who reads it sees them and load_case still tells what was given. load_case reads it back
/// to the same bits.
std::string write_case(const Case&);

/// The same without the keys that have their default: stays as it is when the schema gains a key.
std::string write_changes(const Case&);

}  // namespace ejecta
