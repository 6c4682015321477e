#include "simulation/run.hpp"

#include <ostream>

#include "base/file_lock.hpp"
#include "base/stopwatch.hpp"
#include "bindings.hpp"
#include "case_tree.hpp"
#include "output/paraview_view.hpp"
#include "output/report.hpp"
#include "output/results_table.hpp"
#include "output/verdict.hpp"
#include "workflow/watched_run.hpp"

namespace ejecta::python {
namespace {

/// What a callback is shown.
struct Progress {
  double time = 0.0, dt = 0.0, busy_until = 0.0;
  std::int64_t step = 0, cells = 0;
};

/// What Python may do while a run goes: look on after each step, and end it by ^C, by True from the callback
/// or by an exception there, which is raised again once the run has left its checkpoint.
class Onlooker {
 public:
  explicit Onlooker(std::optional<py::object> callback) : callback_(std::move(callback)) {}

  void observe(const Moment& m) {
    if (!callback_ || stop_) return;
    const py::gil_scoped_acquire python;
    try {
      const py::object answer = (*callback_)(Progress{m.time, m.dt, m.busy_until, m.step, m.model.cells()});
      stop_ = answer.ptr() == Py_True;
    } catch (py::error_already_set& e) {
      keep(e);
    }
  }

  bool stop() {
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

  void rethrow() {
    if (error_) throw py::error_already_set(std::move(*error_));
  }

 private:
  void keep(py::error_already_set& e) {
    error_.emplace(std::move(e));
    stop_ = true;
  }

  std::optional<py::object> callback_;
  std::optional<py::error_already_set> error_;
  bool stop_ = false;
  double looked_ = wall_seconds();
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

/// `kind`: "run" or "jet".
py::dict run_case(const CaseTree& tree, const std::string& kind, std::optional<std::string> directory,
                  bool overwrite, bool resume, int threads, std::optional<py::object> callback, bool fields,
                  const std::string& command, const py::object& note) {
  Onlooker onlooker(std::move(callback));
  Context context{.threads = threads,
                  .observe = [&](const Moment& m) { onlooker.observe(m); },
                  .stop = [&] { return onlooker.stop(); },
                  .note =
                      [&](const std::string& line) {
                        const py::gil_scoped_acquire python;
                        note(line);
                      },
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
    const JetOrder order = jet ? jet_of(tree.checked()) : JetOrder{tree.checked()};
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

}  // namespace

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
