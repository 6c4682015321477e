#include "jet/cache.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

#include "base/error.hpp"

namespace ejecta {
namespace {

/// Our own only: the directory may be one the user keeps other things in.
std::vector<std::filesystem::directory_entry> files(const std::filesystem::path& directory) {
  std::vector<std::filesystem::directory_entry> list;
  if (!std::filesystem::is_directory(directory)) return list;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    if (entry.is_regular_file() && entry.path().filename().string().starts_with("jet-"))
      list.push_back(entry);
  return list;
}

}  // namespace

std::filesystem::path cache_directory() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto own = variable("EJECTA_CACHE"); !own.empty()) return own;
  if (const auto shared = variable("XDG_CACHE_HOME"); !shared.empty()) return shared / "ejecta";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "ejecta";
  throw Error("no place for the cache: set EJECTA_CACHE to a directory");
}

std::string cache_listing(const std::filesystem::path& directory) {
  std::string text = fmt::format("{}\n", directory.string());
  double total = 0.0;
  for (const auto& entry : files(directory)) {
    const double size = static_cast<double>(entry.file_size());
    text += fmt::format("  {:>10.1f} kB  {}\n", size / 1e3, entry.path().filename().string());
    total += size;
  }
  return text + fmt::format("  {:>10.1f} kB  in all\n", total / 1e3);
}

int clear_cache(const std::filesystem::path& directory) {
  int count = 0;
  for (const auto& entry : files(directory)) count += std::filesystem::remove(entry.path()) ? 1 : 0;
  return count;
}

}  // namespace ejecta
