#include "output/results_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "output/output_file.hpp"

namespace ejecta::output {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// "impulse_z_N_s" -> "impulse_z [N s]": the unit that ends a key of result.json.
std::string with_unit_apart(const std::string& key) {
  static constexpr std::array<std::pair<const char*, const char*>, 7> kUnits{{{"_rad_s", "rad/s"},
                                                                              {"_N_s", "N s"},
                                                                              {"_N_m", "N m"},
                                                                              {"_m_s", "m/s"},
                                                                              {"_kg", "kg"},
                                                                              {"_N", "N"},
                                                                              {"_m", "m"}}};
  for (const auto& [end, unit] : kUnits)
    if (key.ends_with(end))
      return fmt::format("{} [{}]", key.substr(0, key.size() - std::string_view(end).size()), unit);
  return key.ends_with("_s") ? key.substr(0, key.size() - 2) + " [s]" : key;
}

json read_json(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none) ? json::parse(read_file(file), nullptr, false) : json();
}

/// A column for each key, a row for what has it.
class Builder {
 public:
  void begin_row() { table_.rows.emplace_back(table_.columns.size()); }
  void set(const std::string& column, const json& value) {
    const auto at = std::find(table_.columns.begin(), table_.columns.end(), column);
    const auto n = static_cast<std::size_t>(at - table_.columns.begin());
    if (at == table_.columns.end()) {
      table_.columns.push_back(column);
      for (auto& row : table_.rows) row.emplace_back();
    }
    table_.rows.back()[n] = value;
  }
  ResultsTable take() { return std::move(table_); }

 private:
  ResultsTable table_;
};

void set_body(Builder& builder, const nlohmann::ordered_json& body) {
  for (const auto& [key, value] : body.items()) {
    const std::string name = key == "name" ? "body" : with_unit_apart(key);
    if (!value.is_array()) {
      builder.set(name, value.is_boolean() ? json(value ? "yes" : "no") : json(value));
      continue;
    }
    const std::size_t bracket = std::min(name.find(" ["), name.size());
    for (std::size_t n = 0; n < value.size() && n < 3; ++n)
      builder.set(fmt::format("{}_{}{}", name.substr(0, bracket), "xyz"[n], name.substr(bracket)),
                  json(value[n]));
  }
}

}  // namespace

ResultsTable results_table(std::span<const fs::path> runs) {
  Builder builder;
  for (const fs::path& run : runs) {
    if (!fs::exists(run / "result.json"))
      throw InputError(fmt::format(
          "{} holds no result\n  expected: the directory of a run that came to its end", run.string()));
    const auto result = nlohmann::ordered_json::parse(read_file(run / "result.json"));
    const json manifest = read_json(run / "manifest.json");
    const auto bodies =
        result.value("bodies", nlohmann::ordered_json::array({nlohmann::ordered_json::object()}));
    for (const auto& body : bodies) {
      builder.begin_row();
      builder.set("run", run.lexically_normal().filename().empty() ? run.parent_path().filename().string()
                                                                   : run.filename().string());
      builder.set("title", result.value("title", ""));
      if (manifest.is_object() && manifest.contains("set"))
        for (const json& set : manifest["set"]) {
          const std::string text = set, key = text.substr(0, text.find('='));
          builder.set(key, text.substr(std::min(key.size() + 1, text.size())));
        }
      set_body(builder, body);
      builder.set("simulated_time [s]", result.value("simulated_time_s", 0.0));
    }
  }
  return builder.take();
}

std::string csv_text(const ResultsTable& table) {
  const auto cell = [](const json& value) {
    if (value.is_null()) return std::string();
    if (value.is_number_float()) return fmt::format("{}", value.get<double>());
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
  };
  std::string text;
  const auto add_row = [&](const auto& cells) {
    for (std::size_t n = 0; n < cells.size(); ++n) text += (n > 0 ? "," : "") + cell(json(cells[n]));
    text += '\n';
  };
  add_row(table.columns);
  for (const auto& row : table.rows) add_row(row);
  return text;
}

void write_results(std::span<const fs::path> runs, const fs::path& file) {
  if (file.extension() == ".xlsx") return write_workbook(runs, file);
  if (file.extension() == ".csv") return write_file(file, csv_text(results_table(runs)));
  throw InputError(fmt::format("\"{}\" is no table", file.string()),
                   {.expected = "a name that ends with .csv or .xlsx", .example = "results.xlsx"});
}

}  // namespace ejecta::output
