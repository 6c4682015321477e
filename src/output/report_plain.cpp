#include "output/report_plain.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "output/vtk_appended.hpp"

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

/// Lists of more plain values than this are counted, not shown.
constexpr std::size_t kLongest = 6;

void add_rows(std::string& html, const std::string& key, const ordered_json& value) {
  if (value.size() > kLongest && value.is_array() && !value.front().is_structured()) {
    html +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{} values</td></tr>\n", xml_escaped(key), value.size());
    return;
  }
  if (value.is_structured()) {
    for (const auto& [name, child] : value.items())
      add_rows(html, key.empty() ? name : key + '/' + name, child);
    return;
  }
  html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", xml_escaped(key),
                      xml_escaped(value.is_string() ? value.get<std::string>() : value.dump()));
}

}  // namespace

std::string plain_report(std::string_view report_json) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Ejecta report</title>\n"
      "<style>:root{color-scheme:light dark}body{font:16px/1.5 sans-serif;max-width:50em;margin:2em "
      "auto;padding:0 1em}"
      "th{text-align:left;font-weight:normal;padding-right:2em}td{font-variant-numeric:tabular-nums}</"
      "style></head><body>\n";
  const ordered_json data = ordered_json::parse(report_json);
  for (const ordered_json& run : data.at("runs")) {
    html += fmt::format("<h1>{}</h1>\n<p><strong>{}</strong></p>\n<table>\n",
                        xml_escaped(run.at("name").get<std::string>()),
                        xml_escaped(run.at("verdict").get<std::string>()));
    add_rows(html, "", run.at("result"));
    html += "</table>\n";
  }
  for (const char* kind : {"map", "study", "campaign"})
    if (data.contains(kind)) {
      html += fmt::format("<h1>{}</h1>\n<p><strong>{}</strong></p>\n<table>\n",
                          xml_escaped(data[kind].value("title", "")),
                          xml_escaped(data[kind].value("summary", "")));
      add_rows(html, "", data[kind]);
      html += "</table>\n";
    }
  return html +
         "<p>This is the plain report: the program was built where npm was missing. Install nodejs and npm, "
         "build "
         "again, and run <code>ejecta report DIR</code> for the page with replay and "
         "charts.</p>\n</body></html>\n";
}

}  // namespace ejecta::output
