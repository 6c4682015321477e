#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/signals.hpp"
#include "app/sort_runs.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "case/write.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "simulation/sorter_run.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kTellEvery = 2.0;  ///< s

/// Says every few seconds how far a sorter is.
class SortTeller {
 public:
  SortTeller(std::int64_t cells, bool quiet) : cells_(cells), quiet_(quiet), terminal_(::isatty(2) == 1) {}
  void tell(std::int64_t done, bool last = false) {
    const double now = wall_seconds();
    if (quiet_ || (!last && now - said_ < (terminal_ ? 0.2 : kTellEvery))) return;
    said_ = now;
    const double share = static_cast<double>(done) / static_cast<double>(cells_);
    fmt::print(stderr, "{}{:.0f} % of the belt{}", terminal_ ? "\r\x1b[K" : "", 100 * share,
               terminal_ && !last ? "" : "\n");
    std::fflush(stderr);
  }

 private:
  std::int64_t cells_;
  bool quiet_, terminal_;
  double said_ = wall_seconds();
};

void write_results(const Case& c, const Sorter& sorter, const SorterState& state,
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
  if (!c.output.report) return;
  Json page = result;
  page["view"] = Json::parse(output::read_file(directory.file("view.json")));
  output::write_study_report("sort", page, directory.file("report.html"));
}

}  // namespace

int sort_case(const Case& c, const SortOptions& o) {
  if (!c.sorter.enabled)
    throw InputError(
        fmt::format("{} has no [sorter]\n  expected: the machine\n"
                    "  example:  [sorter] throughput = \"10 t/h\"",
                    c.path));
  if (o.threads > 0) set_thread_count(o.threads);
  const fs::path path = o.out.empty() ? fs::path(c.path).stem().string() + ".sort" : o.out;
  const SorterDirectory directory(path, study_header("sort", c).at("input_sha256"), o.force);
  SorterState state = directory.read(c.classes.size());
  const Note note = [&](const std::string& line) {
    if (!o.quiet) fmt::print(stderr, "{}\n", line);
  };
  const auto source = make_jet_source(c, note);
  const Sorter sorter(c, fast_ejection(c, *source));
  const std::int64_t cells = cells_of_sorter(c, sorter);
  note(fmt::format("{}: {:.3g} m of belt, {} thread{} -> {}{}", c.path,
                   static_cast<double>(cells) * sorter.feed().cell_length(), thread_count(),
                   thread_count() == 1 ? "" : "s", path.string(),
                   state.cells > 0 ? fmt::format(", from {:.0f} %", 100.0 * static_cast<double>(state.cells) /
                                                                        static_cast<double>(cells))
                                   : ""));
  if (!fs::exists(directory.file("view.json"))) {
    output::write_file(directory.file("case.toml"), write_case(c));
    output::write_file(directory.file("view.json"),
                       sorter_view(c, sorter.sort(0, std::min(cells, kSorterPiece), c.sorter.shown)).dump());
  }
  SignalWatch signals;
  SortTeller teller(cells, o.quiet);
  const auto stop = [&] { return signals.stop_requested(); };
  const auto keep = [&](const SorterState& now) {
    directory.write(now);
    teller.tell(now.cells, now.cells == cells);
  };
  if (!run_sorter(c, sorter, cells, state, keep, stop)) {
    fmt::print(stderr, "stopped; go on with the same command\n");
    return exit_stopped;
  }
  Json corrected = Json::object();
  if (o.resolved > 0) {
    note(fmt::format("{} shots as runs -> {}", o.resolved, directory.file("resolved").string()));
    corrected =
        resolve_shots(c, sorter, state, directory.file("resolved"), {.shots = o.resolved, .stop = stop});
    if (corrected.is_null()) {
      fmt::print(stderr, "stopped; go on with the same command\n");
      return exit_stopped;
    }
  }
  write_results(c, sorter, state, directory, corrected);
  const int failed = corrected.value("resolved_shots_failed", 0);
  if (failed > 0)
    fmt::print(
        stderr,
        "error: {} of {} shots could not be computed as runs, which leaves the others a biased sample: {}\n"
        "  all of them:  ejecta study status {}\n",
        failed, o.resolved, corrected.value("first_failure", ""), directory.file("resolved").string());
  if (!o.quiet) {
    const Json result = Json::parse(output::read_file(directory.file("result.json")));
    fmt::print("{}\nresults: {}\ntable:   {}\n", result.at("summary").get<std::string>(),
               directory.file("result.json").string(), directory.file("fates.csv").string());
    if (c.output.report) fmt::print("report:  {}\n", directory.file("report.html").string());
  }
  return failed > 0 ? exit_failure : exit_done;
}

}  // namespace ejecta
