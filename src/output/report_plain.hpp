#pragma once
#include <string>
#include <string_view>

namespace ejecta::output {

/// The report of a program built without npm: verdict and result of each run of `report_json` as HTML tables,
/// and how to get the full page.
std::string plain_report(std::string_view report_json);

}  // namespace ejecta::output
