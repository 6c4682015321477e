#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ejecta {

/// The folder that the workbench shows. Nothing outside it can be named.
class Folder {
 public:
  /// Throws InputError where it is no directory.
  explicit Folder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  /// The file or directory of a name such as "rocks/flat.toml"; it need not be there. Throws InputError for
  /// one that leads, or links, out of the folder.
  std::filesystem::path inside(const std::string& name) const;

  struct Content {
    std::vector<std::string> cases;  ///< names of case files, sorted
    /// What has been started from them, by name, and its kind_of_directory(): also logs of what never came to
    /// have a directory, with kind_of_name().
    std::map<std::string, std::string> jobs;
  };
  Content content() const;

 private:
  std::filesystem::path path_;  // without links
};

/// What a directory holds: "run", "sort", "campaign", or "study" for studies and maps, whose study.json says
/// which; "" for nothing of these.
std::string kind_of_directory(const std::filesystem::path& directory);
/// The command that has made it, by the end of its name: "flat-2.map" -> "map"; "" of any other name.
std::string kind_of_name(const std::string& name);

/// Throws InputError unless it can be the name of a file here: letters, digits, blanks, - _ . and the
/// extension.
void require_file_name(const std::string& name, const std::string& extension);

}  // namespace ejecta
