#pragma once
#include <string>

namespace ejecta {

/// Help on the case file, all of it made from the schema.
///
/// `topic` empty: the tree of all keys. A section ("valve") or key ("valve.rise_time", "body.0.size"): that.
/// Any other word: every key whose name or help contains it. Throws InputError with the nearest key if
/// nothing does.
std::string explain(const std::string& topic);

/// docs/reference.md
std::string reference_page();

/// docs/ejecta.schema.json: lets editors complete and check case files.
std::string json_schema();

}  // namespace ejecta
