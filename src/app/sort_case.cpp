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
#include "simulation/sorter_result.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::int64_t kStretch = 4;    ///< cells that are computed in one piece
constexpr std::int64_t kStretches = 8;  ///< pieces between two checkpoints
constexpr double kTellEvery = 2.0;      ///< s

/// The directory of a sorter: state.json says how far it is, and of what.
class SortDirectory {
 public:
  SortDirectory(fs::path path, const std::string& input, bool force) : path_(std::move(path)), input_(input) {
    const bool mine = fs::exists(state());
    if (!mine && holds_anything())
      throw InputError(fmt::format("{} is there and is no directory of a sorter\n  expected: another --out",
                                   path_.string()));
    if (mine && force) fs::remove_all(path_);
    fs::create_directories(path_);
    if (!fs::exists(state())) write({});
  }
  /// Throws InputError where the case was another.
  SorterState read(std::size_t kinds) const {
    Json json;
    try {
      json = Json::parse(output::read_file(state()));
    } catch (const nlohmann::json::exception&) {
      throw InputError(fmt::format("{} is damaged\n  expected: --force, to start anew", state().string()));
    }
    if (json.value("input_sha256", "") != input_)
      throw InputError(
          fmt::format("{} holds the results of another case, or of this one before it was changed\n"
                      "  expected: --force, to start anew, or another --out",
                      path_.string()));
    return sorter_state(json, kinds);
  }
  void write(const SorterState& s) const {
    Json json{{"input_sha256", input_}};
    json.update(json_of(s));
    output::write_file(state(), json.dump());
  }
  fs::path file(const char* name) const { return path_ / name; }

 private:
  fs::path state() const { return path_ / "state.json"; }
  /// But for what a kill left of the first state.
  bool holds_anything() const {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(path_, none))
      if (!entry.path().filename().string().starts_with("state.json")) return true;
    return false;
  }
  fs::path path_;
  std::string input_;
};

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
                   const SortDirectory& directory, const Json& corrected) {
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
  const SortDirectory directory(path, study_header("sort", c).at("input_sha256"), o.force);
  SorterState state = directory.read(c.classes.size());
  const Note note = [&](const std::string& line) {
    if (!o.quiet) fmt::print(stderr, "{}\n", line);
  };
  const auto source = make_jet_source(c, note);
  const Sorter sorter(c, fast_ejection(c, *source));
  const Feed& feed = sorter.feed();
  const std::int64_t cells =
      feed.cells_of_file() > 0
          ? feed.cells_of_file()
          : std::max<std::int64_t>(
                1, static_cast<std::int64_t>(std::ceil(c.sorter.particles / feed.mean_count())));
  note(fmt::format("{}: {:.3g} m of belt, {} thread{} -> {}{}", c.path,
                   static_cast<double>(cells) * feed.cell_length(), thread_count(),
                   thread_count() == 1 ? "" : "s", path.string(),
                   state.cells > 0 ? fmt::format(", from {:.0f} %", 100.0 * static_cast<double>(state.cells) /
                                                                        static_cast<double>(cells))
                                   : ""));
  if (!fs::exists(directory.file("view.json"))) {
    output::write_file(directory.file("case.toml"), write_case(c));
    output::write_file(directory.file("view.json"),
                       sorter_view(c, sorter.sort(0, std::min(cells, kStretch), c.sorter.shown)).dump());
  }
  SignalWatch signals;
  SortTeller teller(cells, o.quiet);
  while (state.cells < cells) {
    if (signals.stop_requested()) {
      fmt::print(stderr, "stopped; go on with the same command\n");
      return exit_stopped;
    }
    const double began = wall_seconds();
    const std::int64_t until = std::min(cells, state.cells + kStretch * kStretches);
    const auto pieces = static_cast<int>((until - state.cells + kStretch - 1) / kStretch);
    std::vector<SortedStretch> sorted(static_cast<std::size_t>(pieces));
    std::vector<std::string> failed(static_cast<std::size_t>(pieces));
    for_each_index_dynamic(pieces, [&](int n) {
      const std::int64_t first = state.cells + n * kStretch;
      try {
        sorted[static_cast<std::size_t>(n)] = sorter.sort(first, std::min(first + kStretch, until));
      } catch (const InputError& e) {
        failed[static_cast<std::size_t>(n)] = e.what();
      }
    });
    for (const std::string& why : failed)
      if (!why.empty()) throw InputError(why);
    for (const SortedStretch& piece : sorted)
      for (const Tally& cell : piece.cells) state.products.add(cell, c.classes);
    state.cells = until;
    state.wall_time += wall_seconds() - began;
    directory.write(state);
    teller.tell(state.cells, state.cells == cells);
  }
  Json corrected = Json::object();
  if (o.resolved > 0) {
    note(fmt::format("{} shots as runs -> {}", o.resolved, directory.file("resolved").string()));
    corrected = resolve_shots(c, sorter, state, directory.file("resolved"),
                              {.shots = o.resolved, .stop = [&] { return signals.stop_requested(); }});
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
