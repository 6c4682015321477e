#pragma once
#include <memory>
#include <string>
#include <vector>

#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// For the reference and for editors.
inline constexpr const char* kExtendsHelp =
    "Another case file, relative to this one, that this one changes. Keys of a section replace those of the "
    "other one "
    "by one; an element of a list of sections ([[body]]) changes the one of the same name ([[expect]]: "
    "quantity, [[measured]]: "
    "of), or is added";

/// Parses the TOML of a case laid over that of the case it extends: `extends = "base.toml"`, before the first
/// section, relative to the file that says so (see kExtendsHelp).
/// `bases`: receives the paths of the files that were extended.
Node parse_extended(const std::shared_ptr<const Source>& source, std::vector<Problem>& problems,
                    std::vector<std::string>& bases);

}  // namespace ejecta
