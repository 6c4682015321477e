#pragma once
#include <string>
#include <vector>

#include "case/words.hpp"

namespace ejecta {

/// The kinds of case `ejecta new` knows, the usual one first.
const std::vector<Word>& template_kinds();

/// A case of that kind that runs as it is: its keys with a comment each, and the other keys of its sections
/// commented out with their defaults. Throws InputError for an unknown kind.
std::string case_template(const std::string& kind);

}  // namespace ejecta
