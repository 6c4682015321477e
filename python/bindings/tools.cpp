#include <filesystem>
#include <ostream>

#include "base/thread_budget.hpp"
#include "bench/bench.hpp"
#include "bindings.hpp"
#include "case/template.hpp"
#include "case_tree.hpp"
#include "jet/cache.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/help.hpp"
#include "simulation/plan.hpp"
#include "validation/validation.hpp"
#include "workflow/result_of.hpp"
#include "workflow/studies.hpp"

namespace ejecta::python {
namespace {

using Names = std::vector<std::string>;

/// The text of `ejecta plan`, and name and equation of each operator.
py::tuple plan(const CaseTree& tree) {
  std::string text;
  std::vector<OperatorTime> step;
  {
    const py::gil_scoped_release others_may_run;
    const ThreadBudget as_before(0);
    const Case c = tree.checked();
    step = planned_step(c);
    text = plan_text(c, step);
  }
  py::list operators;
  for (const OperatorTime& op : step) operators.append(py::make_tuple(op.name, op.equation));
  return py::make_tuple(text, operators);
}

py::dict as_dict(const Validation& v) {
  py::list comparisons;
  for (const Comparison& c : v.comparisons)
    comparisons.append(py::dict(py::arg("quantity") = c.quantity, py::arg("computed") = c.computed,
                                py::arg("reference") = c.reference, py::arg("error") = c.error,
                                py::arg("source") = c.source, py::arg("series") = c.series,
                                py::arg("passed") = c.pass));
  return py::dict(py::arg("name") = v.name, py::arg("failure") = v.failure, py::arg("message") = v.message,
                  py::arg("comparisons") = comparisons, py::arg("passed") = v.pass());
}

std::vector<std::filesystem::path> cases_of(const Names& names) {
  return validation_cases(names, shipped_cases());
}

/// The table of `ejecta validate`, and what became of each case.
py::tuple validate(const Names& names, const std::string& out, int threads, const py::object& note) {
  Onlooker onlooker;
  std::vector<Validation> done;
  {
    const py::gil_scoped_release others_may_run;
    const Context context{.threads = threads, .stop = [&] { return onlooker.stop(); }};
    const Runner runner{
        .load = [](const std::string& path) { return load_checked(path); },
        .run = [&](const Case& c,
                   const std::filesystem::path& directory) { return result_of(c, directory, context); }};
    done = validate_cases(cases_of(names), out, runner, told_to(note));
  }
  onlooker.rethrow();
  py::list all;
  for (const Validation& v : done) all.append(as_dict(v));
  return py::make_tuple(validation_table(done), all);
}

Names validation_files(const Names& names) {
  Names files;
  for (const std::filesystem::path& file : cases_of(names)) files.push_back(file.string());
  return files;
}

void measure(int threads, int steps, const std::string& only, const py::object& note) {
  const py::gil_scoped_release others_may_run;
  const ThreadBudget budget(threads);
  bench({.threads = threads, .steps = steps, .only = only}, told_to(note));
}

/// How far a study or map is: counts, the pace, a line for each run that goes on or failed, and all on one.
py::dict status(const std::string& directory) {
  const TaskStore store = TaskStore::open(directory);
  const StudyStatus s = study_status(store);
  return py::dict(
      py::arg("runs") = s.tasks, py::arg("done") = s.done, py::arg("running") = s.running,
      py::arg("waiting") = s.waiting, py::arg("failed") = s.failed,
      py::arg("seconds_left") = s.seconds_left < 0.0 ? py::object(py::none()) : py::cast(s.seconds_left),
      py::arg("lines") = s.lines, py::arg("summary") = status_line(s));
}

}  // namespace

void bind_tools(py::module_& m) {
  m.def("plan", &plan, py::arg("case"));
  m.def("explain", &help_on, py::arg("topic"));
  m.def("new", &case_template, py::arg("kind"));
  m.def("new_kinds", [] {
    py::dict kinds;
    for (const Word& w : template_kinds()) kinds[py::str(w.name)] = w.help;
    return kinds;
  });
  m.def("validate", &validate, py::arg("names"), py::arg("out"), py::arg("threads"), py::arg("note"));
  m.def("validation_cases", &validation_files, py::arg("names"));
  m.def("bench", &measure, py::arg("threads"), py::arg("steps"), py::arg("only"), py::arg("note"));
  m.def("cache_directory", [] { return cache_directory().string(); });
  m.def("clear_cache", [] { return clear_cache(cache_directory()); });
  m.def("study_status", &status, py::arg("directory"));
  m.def(
      "study_stop", [](const std::string& directory) { TaskStore::open(directory).ask_to_stop(true); },
      py::arg("directory"));
  m.def(
      "study_collect", [](const std::string& directory) { collect_study(TaskStore::open(directory)); },
      py::arg("directory"));
}

}  // namespace ejecta::python
