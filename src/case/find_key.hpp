#pragma once
#include <optional>
#include <string>

#include "case/case.hpp"
#include "case/key.hpp"

namespace ejecta {

/// The key of a path such as "valve.rise_time" or "body.particle.density" (elements of lists by number or by
/// their `name`), bound to `c`; nothing where the schema has none or the list no such element.
std::optional<Key> find_key(Case& c, const std::string& path);

/// The known key that a path is most likely meant to be, or "".
std::string nearest_key(Case& c, const std::string& path);

}  // namespace ejecta
