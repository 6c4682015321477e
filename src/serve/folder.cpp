#include "serve/folder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 3;  ///< folders below the first that are looked into

bool is_run(const fs::path& directory) {
  std::error_code none;
  return fs::exists(directory / "manifest.json", none);
}

bool is_study(const fs::path& directory) {
  std::error_code none;
  return fs::exists(directory / "study.json", none);
}

}  // namespace

Folder::Folder(const fs::path& path) {
  std::error_code failed;
  path_ = fs::canonical(path, failed);
  if (failed || !fs::is_directory(path_))
    throw InputError(fmt::format(
        "{} is no folder\n  expected: a folder with cases\n  example:  ejecta serve cases", path.string()));
}

fs::path Folder::inside(const std::string& name) const {
  const fs::path given(name);
  const bool climbs = std::any_of(given.begin(), given.end(), [](const fs::path& part) {
    return part == ".." || part.string().find('\0') != std::string::npos;
  });
  if (name.empty() || given.is_absolute() || climbs)
    throw InputError(fmt::format("\"{}\" is not in the folder", name));
  std::error_code failed;
  const fs::path full = fs::weakly_canonical(path_ / given, failed);
  const auto [end, unused] = std::mismatch(path_.begin(), path_.end(), full.begin(), full.end());
  if (failed || end != path_.end()) throw InputError(fmt::format("\"{}\" is not in the folder", name));
  return full;
}

Folder::Content Folder::content() const {
  Content found;
  std::error_code failed;
  const auto options = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(path_, options, failed);
       !failed && entry != fs::recursive_directory_iterator(); entry.increment(failed)) {
    const std::string name = entry->path().lexically_relative(path_).string();
    if (entry->is_directory(failed)) {
      if (is_run(entry->path())) found.runs.push_back(name);
      if (is_run(entry->path()) || is_study(entry->path()) || entry.depth() >= kDeepest ||
          entry->path().filename().string().starts_with('.'))
        entry.disable_recursion_pending();
    } else if (entry->path().extension() == ".toml") {
      found.cases.push_back(name);
    }
  }
  std::sort(found.cases.begin(), found.cases.end());
  std::sort(found.runs.begin(), found.runs.end());
  return found;
}

void require_file_name(const std::string& name, const std::string& extension) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || c == '-' || c == '_' || c == '.' || c == ' ';
  });
  if (name.size() > extension.size() && name.size() <= 100 && plain && name.ends_with(extension) &&
      !name.starts_with('.'))
    return;
  throw InputError(
      fmt::format("\"{}\" cannot be the name of a file here\n  expected: letters, digits, - _ and {}"
                  "\n  example:  my-rock{}",
                  name, extension, extension));
}

}  // namespace ejecta
