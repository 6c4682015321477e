#include "workflow/sort.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "case/write.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/run_directory.hpp"
#include "simulation/sorter_run.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json write_results(const Case& c, const Sorter& sorter, const SorterState& state,
                   const SorterDirectory& directory, const Json& corrected) {
  Json result = sorter_result(c, sorter, state);
  if (!corrected.empty()) {
    if (corrected.contains("recovery")) result["tier"] = "fast, corrected by resolved shots";
    for (const auto& [key, value] : corrected.items()) {
      if (result.contains(key) && key != "resolved_shots") result["fast"][key] = result[key];
      result[key] = value;
    }
  }
  result["summary"] = sorter_sentence(result);
  output::write_file(directory.file("result.json"), result.dump(1));
  output::write_file(directory.file("fates.csv"), fates_table(result));
  if (!c.output.report) return result;
  Json page = result;
  page["view"] = Json::parse(output::read_file(directory.file("view.json")), nullptr, false);
  if (page["view"].is_discarded())
    throw InputError(fmt::format("{} is damaged\n  expected: without it, it is made anew",
                                 directory.file("view.json").string()));
  output::write_study_report("sort", page, directory.file("report.html"));
  return result;
}

}  // namespace

SortEnd compute_sorter(const Case& c, const SortOptions& o, const Attendance& who) {
  if (!c.sorter.enabled)
    throw InputError(fmt::format("{} has no [sorter]", c.path),
                     {.expected = "the machine", .example = "[sorter] throughput = \"10 t/h\""});
  if (o.threads > 0) set_thread_count(o.threads);
  const fs::path path = output::directory_for(o.out, c.path, "sort");
  const SorterDirectory directory(path, study_header("sort", c).at("input_sha256"), o.force);
  SorterState state = directory.read(c.classes.size());
  const auto source = make_jet_source(c, who.note);
  const Sorter sorter(c, fast_ejection(c, *source));
  const std::int64_t cells = cells_of_sorter(c, sorter.feed());
  const auto part = [&] { return static_cast<double>(state.cells) / static_cast<double>(cells); };
  who.tell(fmt::format("{}: {:.3g} m of belt, {} thread{} -> {}{}", c.path,
                       static_cast<double>(cells) * sorter.feed().cell_length(), thread_count(),
                       thread_count() == 1 ? "" : "s", path.string(),
                       state.cells > 0 ? fmt::format(", from {:.0f} %", 100.0 * part()) : ""));
  if (!fs::exists(directory.file("view.json"))) {
    output::write_file(directory.file("case.toml"), write_case(c));
    output::write_file(directory.file("view.json"),
                       sorter_view(c, sorter.sort(0, std::min(cells, kSorterPiece), c.sorter.shown)).dump());
  }
  const auto keep = [&](const SorterState& now) {
    directory.write(now);
    if (who.share) who.share(static_cast<double>(now.cells) / static_cast<double>(cells), now.cells == cells);
  };
  if (!run_sorter(c, sorter, cells, state, keep, who.stop)) return {.stopped = true, .directory = path};
  Json corrected = Json::object();
  if (o.resolved > 0) {
    who.tell(fmt::format("{} shots as runs -> {}", o.resolved, directory.file("resolved").string()));
    corrected = resolve_shots(c, sorter, state, directory.file("resolved"), o, who);
    if (corrected.is_null()) return {.stopped = true, .directory = path};
  }
  return {.directory = path, .result = write_results(c, sorter, state, directory, corrected)};
}

}  // namespace ejecta
