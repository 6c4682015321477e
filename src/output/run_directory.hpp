#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ejecta::output {

/// Where and by what a run was made.
struct Provenance {
  std::string command;  ///< the command line
  std::string case_path;
  std::string input;  ///< resolved case: its SHA-256 is the input hash
  int threads = 1;
  std::vector<std::string> overrides{};  ///< what the command changed in the case, "section.key=value"
  std::vector<std::string> files{};      ///< that the case reads: meshes, traces, ...
};

/// SHA-256 of each file by its name, {"/a/rock.stl": "..."}; "" of one that cannot be read.
nlohmann::ordered_json digests_of(const std::vector<std::string>& files);
/// manifest.json: version, git revision, compiler, flags, precision, machine, threads, input hash, start.
nlohmann::ordered_json make_manifest(const Provenance& p);
/// The lines that start a history file.
std::vector<std::string> provenance_lines(const Provenance& p);

/// Where a command leaves its files: `out` if that is given, else CASE.KIND in the working directory, for
/// "cases/x.toml" and "run": "x.run". It can be a word of another command.
std::filesystem::path directory_for(const std::string& out, const std::filesystem::path& case_path,
                                    const std::string& kind);

/// The directory of one run. Its files are described in docs/files.md.
class RunDirectory {
 public:
  /// Makes an empty run directory. Throws InputError when `path` holds a run already and `force` is not set,
  /// when it holds anything that is not a run, or when it cannot be made or written. With `force` a finished
  /// run is put aside in earlier/, until forget_earlier(); of an unfinished one its files are removed.
  static RunDirectory create(const std::filesystem::path& path, bool force);
  /// Throws what create() would throw and changes nothing: for those who want to know before long work, and
  /// must not lose a run to a case that then cannot start.
  static void require_creatable(const std::filesystem::path& path, bool force);
  /// An existing one; throws InputError when `path` is not the directory of a run.
  static RunDirectory open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path history(std::string_view name) const;  ///< history/NAME.csv
  std::filesystem::path fields() const { return path_ / "fields"; }
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path replay() const { return path_ / "replay.jsonl"; }
  std::filesystem::path figures() const { return path_ / "figures.json"; }
  std::filesystem::path progress() const { return path_ / "progress.json"; }

  /// Of the run that stood here before this one: to be called when this one is finished.
  void forget_earlier() const;
  std::optional<std::filesystem::path> earlier() const;  ///< where it is, if it is there

  void write_case(std::string_view toml) const;
  void write_manifest(const nlohmann::ordered_json& manifest) const;
  /// A number that is not finite is written as null, and then told: throws DivergedError with its key.
  void write_result(const nlohmann::ordered_json& result) const;
  /// Of a run that goes on: what it said at its earlier end is no longer so.
  void remove_result() const;

 private:
  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace ejecta::output
