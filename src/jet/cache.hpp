#pragma once
#include <filesystem>
#include <string>

namespace ejecta {

/// Where computed jets are kept: $EJECTA_CACHE, else $XDG_CACHE_HOME/ejecta, else ~/.cache/ejecta. Made when
/// first written to. Throws Error when none of these variables is set.
std::filesystem::path cache_directory();

/// The files of the cache with their sizes, as text.
std::string cache_listing(const std::filesystem::path& directory);

/// Removes the files of the cache, and nothing else; returns how many.
int clear_cache(const std::filesystem::path& directory);

}  // namespace ejecta
