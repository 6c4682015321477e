#include "serve/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 3;  ///< folders below the first that are looked into

constexpr std::array kKinds{"run", "study", "map", "sort", "campaign"};

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
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (entry->is_directory(failed)) {
      const std::string kind = hidden ? "" : kind_of_directory(entry->path());
      if (!kind.empty()) found.jobs[name] = kind;
      if (!kind.empty() || hidden || entry.depth() >= kDeepest) entry.disable_recursion_pending();
    } else if (entry->path().extension() == ".toml" && !hidden) {
      found.cases.push_back(name);
    } else if (entry->path().extension() == ".log") {
      const std::string job = name.substr(0, name.size() - 4);
      if (!kind_of_name(job).empty()) found.jobs.try_emplace(job, kind_of_name(job));
    }
  }
  std::sort(found.cases.begin(), found.cases.end());
  return found;
}

std::string kind_of_directory(const fs::path& directory) {
  std::error_code none;
  if (fs::exists(directory / "manifest.json", none)) return "run";
  if (fs::exists(directory / "study.json", none)) return "study";
  const std::string name = kind_of_name(directory.filename().string());
  if (fs::exists(directory / "state.json", none) &&
      (name == "sort" || fs::exists(directory / "view.json", none)))
    return "sort";
  return name == "campaign" ? name : "";  // nothing in it but its parts
}

std::string kind_of_name(const std::string& name) {
  for (const char* kind : kKinds)
    if (name.ends_with("." + std::string(kind))) return kind;
  return "";
}

void require_file_name(const std::string& name, const std::string& extension) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || c == '-' || c == '_' || c == '.' || c == ' ';
  });
  if (name.size() > extension.size() && name.size() <= 100 && plain && name.ends_with(extension) &&
      !name.starts_with('.'))
    return;
  throw InputError(fmt::format(
      "\"{}\" cannot be the name of a file here\n  expected: letters, digits, blanks, - _ . and {}"
      "\n  example:  my-rock{}",
      name, extension, extension));
}

}  // namespace ejecta
