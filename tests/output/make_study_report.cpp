#include <nlohmann/json.hpp>

#include "output/output_file.hpp"
#include "output/report.hpp"

/// make_study_report OUT.html KIND RESULT.json: the page of a study or map.
int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto result = nlohmann::ordered_json::parse(ejecta::output::read_file(argv[3]));
  ejecta::output::write_study_report(argv[2], result, argv[1]);
  return 0;
}
