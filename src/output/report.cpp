#include "output/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.hpp"
#include "output/build_info.hpp"
#include "output/encode.hpp"
#include "output/history.hpp"
#include "output/output_file.hpp"
#include "output/replay.hpp"
#include "output/report_plain.hpp"
#include "output/run_directory.hpp"
#include "output/verdict.hpp"

namespace fs = std::filesystem;

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

/// Rows of a history that the page holds at most; longer ones are thinned evenly. Rows that share a time (the
/// points of a line) stay together.
constexpr std::size_t kMostRows = 4000;
constexpr std::string_view kPlaceholder = "\"EJECTA_DATA\"";

ordered_json json_file(const fs::path& path) {
  if (!fs::exists(path)) return nullptr;
  try {
    return ordered_json::parse(read_file(path));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{} is not JSON: {}", path.string(), e.what()));
  }
}

/// Every `stride`-th moment's rows; the first column is time.
std::vector<std::size_t> rows_shown(const std::vector<double>& time, std::size_t stride) {
  std::vector<std::size_t> rows;
  std::size_t moment = 0;
  for (std::size_t r = 0; r < time.size(); ++r) {
    if (r > 0 && time[r] != time[r - 1]) ++moment;
    if (moment % stride == 0) rows.push_back(r);
  }
  return rows;
}

/// Columns as base64 of float32.
ordered_json history_json(const fs::path& path) {
  const HistoryTable table = read_history(path);
  ordered_json json{{"columns", ordered_json::array()}, {"rows", 0}, {"data", ordered_json::array()}};
  const std::vector<double>& time = table.values.at(0);
  const std::size_t stride = std::max<std::size_t>(1, (time.size() + kMostRows - 1) / kMostRows);
  const std::vector<std::size_t> rows = rows_shown(time, stride);
  std::vector<float> column;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    column.clear();
    for (const std::size_t r : rows) column.push_back(static_cast<float>(table.values[c][r]));
    std::string data;
    append_base64(data, column.data(), column.size() * sizeof(float));
    json["columns"].push_back({{"name", table.columns[c].name}, {"unit", table.columns[c].unit}});
    json["data"].push_back(std::move(data));
  }
  json["rows"] = rows.size();
  json["stride"] = stride;
  return json;
}

std::vector<fs::path> files_in(const fs::path& directory, std::string_view extension) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(directory, none))
    if (entry.path().extension() == extension) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string run_json(const fs::path& directory) {
  const RunDirectory run = RunDirectory::open(directory);
  const ordered_json result = json_file(directory / "result.json");
  ordered_json json{{"name", fs::weakly_canonical(directory).filename().string()},
                    {"verdict", result.is_null() ? "This run is not finished." : verdict_sentence(result)},
                    {"result", result},
                    {"manifest", json_file(directory / "manifest.json")},
                    {"case", fs::exists(directory / "case.toml") ? read_file(directory / "case.toml") : ""},
                    {"figures", json_file(run.figures())},
                    {"history", ordered_json::object()}};
  for (const fs::path& path : files_in(directory / "history", ".csv"))
    json["history"][path.stem().string()] = history_json(path);
  // The frames are JSON already; taking them as they are keeps a long replay out of the parser.
  // A case file may hold bytes that are no UTF-8.
  std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  text.pop_back();
  text += ",\"replay\":[";
  const std::vector<std::string> lines = read_replay_lines(run.replay());
  for (std::size_t n = 0; n < lines.size(); ++n) text.append(n ? "," : "").append(lines[n]);
  return text + "]}";
}

}  // namespace

namespace {

/// So that it can stand inside a script element.
std::string in_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json)
    if (c == '<') safe += "\\u003c";
    else safe += c;
  return safe;
}

void write_page(const std::string& json, const fs::path& out) {
  const std::string_view page = report_page();
  const std::size_t at = page.find(kPlaceholder);
  OutputFile file(out);
  if (at == std::string_view::npos) {
    file.write(plain_report(json));
  } else {
    file.write(page.substr(0, at));
    file.write(json);
    file.write(page.substr(at + kPlaceholder.size()));
  }
  file.commit();
}

}  // namespace

std::string report_json(std::span<const fs::path> runs) {
  std::string text = fmt::format("{{\"format\":1,\"version\":\"{}\",\"runs\":[", version());
  for (std::size_t n = 0; n < runs.size(); ++n) text.append(n ? "," : "").append(run_json(runs[n]));
  return in_script(text + "]}");
}

void write_report(std::span<const fs::path> runs, const fs::path& out) { write_page(report_json(runs), out); }

void write_study_report(const std::string& kind, const ordered_json& result, const fs::path& out) {
  const ordered_json data{
      {"format", 1}, {"version", version()}, {"runs", ordered_json::array()}, {kind, result}};
  write_page(in_script(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace)), out);
}

void write_campaign_report(const ordered_json& campaign, std::span<const fs::path> runs,
                           const fs::path& out) {
  std::string json = report_json(runs);
  json.pop_back();
  const std::string parts = campaign.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  write_page(json + ",\"campaign\":" + in_script(parts) + "}", out);
}

void write_report(const fs::path& run) { write_report(std::span(&run, 1), run / "report.html"); }

}  // namespace ejecta::output
