#include "output/run_directory.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <system_error>

#include "base/error.hpp"
#include "base/shell_word.hpp"
#include "output/output_file.hpp"

namespace fs = std::filesystem;

namespace ejecta::output {
namespace {

/// What a run may hold. The manifest, which says that it is one, goes last when it is cleared.
constexpr std::array kContents{"case.toml",    "result.json",  "progress.json", "history",
                               "replay.jsonl", "figures.json", "fields",        "checkpoints",
                               "report.html",  "view.py",      "manifest.json"};

constexpr const char* kEarlier = "earlier";

[[noreturn]] void refuse(const fs::path& path, const std::error_code& why) {
  throw InputError(fmt::format("cannot write the run directory {}: {} (choose another place with --out DIR)",
                               path.string(), why.message()));
}

/// Names and paths may hold bytes that are no UTF-8; they must not cost the result.
std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void check_finite(const nlohmann::ordered_json& value, const std::string& key) {
  if (value.is_number_float() && !std::isfinite(value.get<double>()))
    throw DivergedError(fmt::format("the result {} is {}", key, value.get<double>()));
  if (!value.is_structured()) return;
  for (const auto& [name, child] : value.items()) check_finite(child, key + '/' + name);
}

}  // namespace

fs::path directory_for(const std::string& out, const fs::path& case_path, const std::string& kind) {
  return path_word(out.empty() ? case_path.stem().string() + "." + kind : out);
}

void RunDirectory::require_creatable(const fs::path& path, bool force) {
  std::error_code failed;
  if (fs::exists(path, failed)) {
    if (!fs::is_directory(path))
      throw InputError(fmt::format("{} is a file; a run needs a directory", path.string()));
    const bool is_run = fs::exists(path / "manifest.json") || fs::exists(path / kEarlier / "manifest.json");
    const bool is_empty = holds_no_file(path, "manifest.json", failed);
    if (failed) refuse(path, failed);
    if (is_run && !force)
      throw InputError(
          fmt::format("{} already holds a run: go on with --resume, overwrite it with --force, or choose "
                      "another place with --out DIR",
                      path.string()));
    if (!is_run && !is_empty)
      throw InputError(fmt::format(
          "{} holds files that are not of a run; choose another place with --out DIR", path.string()));
  }
}

RunDirectory RunDirectory::create(const fs::path& path, bool force) {
  require_creatable(path, force);
  std::error_code failed;
  const auto checked = [&] {
    if (failed) refuse(path, failed);
  };
  if (fs::exists(path, failed)) {
    const fs::path aside = path / kEarlier;
    const bool finished = fs::exists(path / "result.json");
    if (finished) {
      fs::remove_all(aside, failed);
      checked();
      fs::create_directory(aside, failed);
      checked();
    }
    for (const char* name : kContents) {
      fs::remove(path / (std::string(name) + ".tmp"), failed);
      if (finished && fs::exists(path / name)) fs::rename(path / name, aside / name, failed);
      else fs::remove_all(path / name, failed);
      checked();
    }
  }
  for (const char* name : {"history", "fields", "checkpoints"}) {
    fs::create_directories(path / name, failed);
    if (failed) refuse(path, failed);
  }
  return RunDirectory(path);
}

RunDirectory RunDirectory::open(const fs::path& path) {
  std::error_code failed;
  if (fs::is_regular_file(path, failed))
    throw InputError(fmt::format("{} is a file; the directory of a run is needed", path.string()));
  if (!fs::is_directory(path, failed))
    throw InputError(fmt::format("there is no directory {}", path.string()));
  if (!fs::exists(path / "manifest.json", failed))
    throw InputError(fmt::format("{} is not the directory of a run: it has no manifest.json", path.string()));
  return RunDirectory(path);
}

fs::path RunDirectory::history(std::string_view name) const {
  return path_ / "history" / fmt::format("{}.csv", name);
}

void RunDirectory::forget_earlier() const {
  std::error_code none;
  fs::remove_all(path_ / kEarlier, none);
}

std::optional<fs::path> RunDirectory::earlier() const {
  std::error_code none;
  if (!fs::exists(path_ / kEarlier, none)) return std::nullopt;
  return path_ / kEarlier;
}

void RunDirectory::write_case(std::string_view toml) const { write_file(path_ / "case.toml", toml); }

void RunDirectory::write_manifest(const nlohmann::ordered_json& manifest) const {
  write_file(path_ / "manifest.json", json_text(manifest) + '\n');
}

void RunDirectory::remove_result() const {
  std::error_code none;
  for (const char* name : {"result.json", "report.html"}) fs::remove(path_ / name, none);
}

void RunDirectory::write_result(const nlohmann::ordered_json& result) const {
  write_file(path_ / "result.json",
             json_text(result) + '\n');  // what is no number becomes null: the rest counts
  check_finite(result, "");
}

}  // namespace ejecta::output
