#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "base/error.hpp"
#include "base/shell_word.hpp"
#include "validation/validation.hpp"

namespace ejecta {
namespace {

using std::filesystem::path;

std::vector<path> toml_files(const path& directory) {
  std::vector<path> list;
  if (!std::filesystem::is_directory(directory)) return list;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    if (entry.is_regular_file() && entry.path().extension() == ".toml") list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

bool expects_something(const path& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("[[expect]]")) return true;
  return false;
}

}  // namespace

std::vector<path> validation_cases(const std::vector<std::string>& names, const path& shipped) {
  std::vector<path> all;
  for (const char* folder : {"verification", "validation"})
    for (const path& file : toml_files(shipped / folder))
      if (expects_something(file)) all.push_back(file);
  if (names.empty()) return all;
  std::vector<path> chosen;
  for (const std::string& name : names) {
    if (std::filesystem::is_regular_file(name)) {
      chosen.emplace_back(name);
      continue;
    }
    const std::size_t before = chosen.size();
    const std::vector<path> below = toml_files(name);
    std::copy_if(below.begin(), below.end(), std::back_inserter(chosen), expects_something);
    if (below.empty())
      std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&](const path& file) {
        return file.lexically_relative(shipped).string().find(name) != std::string::npos;
      });
    if (chosen.size() == before)
      throw InputError(
          fmt::format("\"{}\" is no case file, no directory of cases and in no name of a shipped case ({})",
                      name, shipped.string()));
  }
  return chosen;
}

std::vector<std::string> names_of(const std::vector<path>& files) {
  const auto name = [](const path& file, int folders) {
    std::string text = file.stem().string();
    path folder = std::filesystem::absolute(file).lexically_normal().parent_path();
    for (int n = 0; n < folders && folder.has_filename(); ++n, folder = folder.parent_path())
      text = folder.filename().string() + "-" + text;
    return text;
  };
  std::vector<std::string> names;
  for (const path& file : files) {
    const auto is_alone = [&](int folders) {
      return std::count_if(files.begin(), files.end(), [&](const path& other) {
               return name(other, folders) == name(file, folders);
             }) == 1;
    };
    int folders = 0;
    while (folders < 32 && !is_alone(folders)) ++folders;
    names.push_back(name(file, folders < 32 ? folders : 0));
  }
  return names;
}

path shipped_cases() {
  if (const char* share = std::getenv("EJECTA_SHARE")) return share;
  Dl_info here{};
  ::dladdr(reinterpret_cast<const void*>(&shipped_cases), &here);
  std::error_code ignored;
  const path library = std::filesystem::canonical(here.dli_fname ? here.dli_fname : "", ignored);
  for (path above = library.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (const path share = above / "share" / "ejecta"; std::filesystem::is_directory(share)) return share;
  return path("share") / "ejecta";
}

std::string case_file(const std::string& given) {
  if (std::filesystem::exists(given) || path(given).is_absolute()) return path_word(given);
  for (const path& name : {path(given), path(given + ".toml")})
    for (const path& folder : {shipped_cases() / "cases", shipped_cases()})
      if (std::filesystem::is_regular_file(folder / name)) return (folder / name).string();
  return given;
}

}  // namespace ejecta
