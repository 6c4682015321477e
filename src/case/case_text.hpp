#pragma once
#include <string>

namespace ejecta {

/// What the file of a case says. Throws InputError when it cannot be read.
std::string read_case_text(const std::string& path);
/// Refuses what cannot be a case before the parser sees it: throws InputError. `name`: of the file, for the
/// message.
void check_text(const std::string& text, const std::string& name);

}  // namespace ejecta
