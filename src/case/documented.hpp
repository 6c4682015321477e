#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/key.hpp"

namespace ejecta {

/// A case that has one default element in every list, so that every key of the schema is there to be
/// described.
Case documented_case();

/// The sections of a documented case as they are shown: [boundary.x_min] stands for all six faces.
std::vector<Section> documented_sections(Case& documented);

/// "[valve]", "[[body]]", "[boundary.x_min] ... [boundary.z_max]".
std::string header(const Section& s);

/// What holds when the key is left out, e.g. "8 ms", "ambient", "required".
std::string default_words(const Key& key);

/// "section.key" of every key, as --set and `explain` take it.
std::vector<std::string> all_keys();

}  // namespace ejecta
