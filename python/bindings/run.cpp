#include "simulation/run.hpp"

#include <ostream>

#include "base/file_lock.hpp"
#include "bindings.hpp"
#include "case_tree.hpp"
#include "output/paraview_view.hpp"
#include "output/report.hpp"
#include "output/results_table.hpp"
#include "output/verdict.hpp"
#include "simulation/jet_sweep.hpp"
#include "workflow/watched_run.hpp"

namespace ejecta::python {
namespace {

/// What a callback is shown.
struct Progress {
  double time = 0.0, dt = 0.0, busy_until = 0.0;
  std::int64_t step = 0, cells = 0;
};

py::dict table_of(output::HistoryTable&& table) {
  py::dict columns;
  for (std::size_t n = 0; n < table.columns.size(); ++n)
    columns[py::str(table.columns[n].name)] =
        py::make_tuple(as_array(std::move(table.values[n])), table.columns[n].unit);
  return columns;
}

py::object fields_of(std::optional<ResultFields>&& air) {
  if (!air) return py::none();
  std::vector<py::ssize_t> cells;
  for (int d = 2; d >= 0; --d) cells.push_back(py::ssize_t(air->faces[std::size_t(d)].size()) - 1);
  py::dict fields;
  for (ResultField& f : air->fields) {
    std::vector<py::ssize_t> shape = cells;
    if (f.components > 1) shape.push_back(f.components);
    fields[py::str(f.name)] = py::make_tuple(as_array(std::move(f.values), shape), f.unit);
  }
  py::list faces;
  for (std::vector<double>& f : air->faces) faces.append(as_array(std::move(f)));
  return py::make_tuple(faces, fields);
}

const char* word_of(RunEnd end) {
  return end == RunEnd::decided ? "decided" : end == RunEnd::undecided ? "undecided" : "stopped";
}

py::dict as_dict(Result&& r) {
  py::dict d;
  d["end"] = word_of(r.end);
  d["time"] = r.time;
  d["steps"] = r.steps;
  d["wall_time"] = r.wall_time;
  d["quantities"] = r.quantities.is_null() ? py::object(py::none()) : as_object(r.quantities);
  d["verdict"] = r.quantities.is_null() ? std::string() : output::verdict_sentence(r.quantities);
  d["later_end"] = r.later_end;
  py::dict histories;
  for (auto& [name, table] : r.histories) histories[py::str(name)] = table_of(std::move(table));
  d["histories"] = histories;
  d["fields"] = fields_of(std::move(r.fields));
  return d;
}

/// Shows a moment of a run to the callback.
void show(Onlooker& onlooker, const Moment& m) {
  if (!onlooker.looks_on()) return;
  const py::gil_scoped_acquire python;
  onlooker.show(Progress{m.time, m.dt, m.busy_until, m.step, m.model.cells()});
}

/// The case, with what is unlikely to be meant told.
Case checked(const CaseTree& tree, const Note& note) {
  std::vector<Problem> warnings;
  Case c = tree.checked(&warnings);
  for (const Problem& p : warnings) note(render(p));
  return c;
}

/// `kind`: "run" or "jet".
py::dict run_case(const CaseTree& tree, const std::string& kind, std::optional<std::string> directory,
                  bool overwrite, bool resume, int threads, std::optional<py::object> callback, bool fields,
                  const std::string& command, const py::object& note) {
  Onlooker onlooker(std::move(callback));
  Context context{.threads = threads,
                  .observe = [&](const Moment& m) { show(onlooker, m); },
                  .stop = [&] { return onlooker.stop(); },
                  .note = told_to(note),
                  .keep_fields = fields};
  if (directory)
    context.files = RunFiles{.directory = *directory,
                             .overwrite = overwrite,
                             .resume = resume,
                             .command = command,
                             .here = command};
  Result result;
  {
    const py::gil_scoped_release others_may_run;
    const bool jet = kind == "jet";
    const Case c = checked(tree, context.note);
    const JetOrder order = jet ? jet_of(c) : JetOrder{c};
    const RunOfCase compute = [&](const Case& c, const Context& in) {
      return jet ? run_jet(c, order.kept_at, in) : run(c, in);
    };
    std::optional<Result> finished;
    if (resume) finished = finished_run(order.jet, *directory);
    std::ostream nowhere(nullptr);
    result = finished    ? std::move(*finished)
             : directory ? WatchedRun(order.jet, nowhere, {.alone = false}).compute(compute, context)
                         : compute(order.jet, context);
  }
  onlooker.rethrow();
  return as_dict(std::move(result));
}

/// Of `ejecta jet --sweep`: result.json.
py::object sweep(const CaseTree& tree, std::optional<std::string> directory, bool overwrite, int threads,
                 const std::string& command, const std::vector<std::string>& overrides,
                 const py::object& note) {
  Onlooker onlooker;
  Context context{.threads = threads, .stop = [&] { return onlooker.stop(); }, .note = told_to(note)};
  if (directory) context.files = RunFiles{*directory, overwrite, false, command, command, overrides};
  std::optional<nlohmann::ordered_json> result;
  {
    const py::gil_scoped_release others_may_run;
    result = sweep_jet(jet_of(checked(tree, context.note)).jet, context);
  }
  onlooker.rethrow();
  return result ? as_object(*result) : py::none();
}

}  // namespace

bool Onlooker::stop() {
  constexpr double kBetweenLooks = 0.05;  // s; the interpreter is asked so seldom that it costs nothing
  if (const double now = wall_seconds(); !stop_ && now - looked_ > kBetweenLooks) {
    looked_ = now;
    const py::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) {
      py::error_already_set e;
      keep(e);
    }
  }
  return stop_;
}

Note told_to(const py::object& callable) {
  return [&callable](const std::string& line) {
    const py::gil_scoped_acquire python;
    callable(line);
  };
}

void bind_run(py::module_& m) {
  py::class_<Progress>(m, "Progress", "A run between two steps.")
      .def_readonly("time", &Progress::time, "Simulated, s.")
      .def_readonly("dt", &Progress::dt, "Of the step that was taken, s; 0 before the first.")
      .def_readonly("step", &Progress::step)
      .def_readonly("cells", &Progress::cells, "That the next step computes.")
      .def_readonly("busy_until", &Progress::busy_until,
                    "What comes later is free flight, which costs nothing; s.")
      .def_property_readonly(
          "fraction", [](const Progress& p) { return p.busy_until > 0.0 ? p.time / p.busy_until : 0.0; },
          "Done of what costs time, 0 to 1.");
  m.def("run", &run_case, py::arg("case"), py::arg("kind"), py::arg("directory"), py::arg("overwrite"),
        py::arg("resume"), py::arg("threads"), py::arg("callback"), py::arg("fields"), py::arg("command"),
        py::arg("note"));
  m.def("sweep", &sweep, py::arg("case"), py::arg("directory"), py::arg("overwrite"), py::arg("threads"),
        py::arg("command"), py::arg("overrides"), py::arg("note"));
  m.def(
      "is_running", [](const std::string& directory) { return is_claimed(directory); }, py::arg("directory"));
  // What hands runs to people and other programs.
  using Paths = std::vector<std::string>;
  const auto paths = [](const Paths& names) {
    return std::vector<std::filesystem::path>(names.begin(), names.end());
  };
  m.def(
      "write_report",
      [paths](const Paths& runs, const std::string& file) { output::write_report(paths(runs), file); },
      py::arg("runs"), py::arg("file"));
  m.def(
      "write_results",
      [paths](const Paths& runs, const std::string& file) { output::write_results(paths(runs), file); },
      py::arg("runs"), py::arg("file"));
  m.def(
      "paraview_view", [](const std::string& run) { return output::paraview_view(run); }, py::arg("run"));
  m.def("verdict_sentence", [](const std::string& result_json) {
    return output::verdict_sentence(nlohmann::ordered_json::parse(result_json));
  });
}

}  // namespace ejecta::python
