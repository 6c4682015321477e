#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace ejecta::output {

/// Makes the page of one run, or of several laid over each other, from their run directories
/// (docs/files.md): result.json, manifest.json, case.toml, history/*.csv, replay.jsonl; what is missing is
/// left out of the page. One file that works offline. Without the web page in the program (no npm when it was
/// built) a plain table.
void write_report(std::span<const std::filesystem::path> runs, const std::filesystem::path& out);

/// For one run: DIR/report.html.
void write_report(const std::filesystem::path& run);

/// The page of a "study" or "map", from its result.json; runs are linked where they lie, beside the page.
void write_study_report(const std::string& kind, const nlohmann::ordered_json& result,
                        const std::filesystem::path& out);

/// The page of a campaign: what `campaign` says of its parts, with the runs that they name by their number in
/// `runs`.
void write_campaign_report(const nlohmann::ordered_json& campaign,
                           std::span<const std::filesystem::path> runs, const std::filesystem::path& out);

/// The JSON that the page shows; "<" is written as \u003c so that it can stand inside a script element.
std::string report_json(std::span<const std::filesystem::path> runs);

/// The web page that was built into the program, or empty.
std::string_view report_page();

}  // namespace ejecta::output
