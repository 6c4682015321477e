#pragma once
#include <string>

namespace ejecta {

/// The text of a case with a key ("valve.duration", "body.0.size") set to a value that stands as TOML;
/// everything else stays as it was written, comments too. A key that is not there comes to the end of its
/// section, or to where it stands as a comment; a section that is not there to the end. Throws InputError for
/// a text that is no TOML and for a path that leads nowhere.
std::string with_key(const std::string& text, const std::string& path, const std::string& value);

/// The same without the key: the line goes, with its comment.
std::string without_key(const std::string& text, const std::string& path);

}  // namespace ejecta
