#pragma once
#include <filesystem>
#include <string>

namespace httplib {
struct Response;
}

namespace ejecta {

/// Whether a file is one of those that the server shows.
bool is_shown(const std::filesystem::path& file);

/// Answers with a file from a byte on ("": from its beginning), a piece at a time. Throws InputError where
/// there is no such byte.
void send_file(const std::filesystem::path& file, const std::string& from, httplib::Response& response);

}  // namespace ejecta
