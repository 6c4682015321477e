#pragma once
#include <string>

namespace ejecta {

/// What `ejecta explain` says: of the keys of a case file (case/explain.hpp) and of the words of results,
/// which users know apart only once they have been told. Throws InputError where nothing is about the topic.
std::string help_on(const std::string& topic);

}  // namespace ejecta
