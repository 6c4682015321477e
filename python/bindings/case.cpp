#include <fmt/format.h>

#include "base/thread_budget.hpp"
#include "base/units.hpp"
#include "bindings.hpp"
#include "case/documented.hpp"
#include "case/find_key.hpp"
#include "case/load.hpp"
#include "case/schema.hpp"
#include "case/write.hpp"
#include "case_tree.hpp"
#include "simulation/archive.hpp"
#include "simulation/forecast.hpp"
#include "workflow/studies.hpp"

namespace ejecta::python {
namespace {

/// What stands in a slot, in SI units.
struct ValueOf {
  template <class T>
  py::object operator()(const T* v) const {
    return py::cast(*v);
  }
  py::object operator()(const Vec3* v) const { return py::cast(std::array{v->x(), v->y(), v->z()}); }
  py::object operator()(const std::vector<Vec3>* v) const {
    py::list list;
    for (const Vec3& x : *v) list.append((*this)(&x));
    return std::move(list);
  }
  py::object operator()(const std::optional<std::array<Vec3, 2>>* v) const {
    if (!*v) return py::none();
    return py::make_tuple((*this)(&(**v)[0]), (*this)(&(**v)[1]));
  }
  /// Values of another key, as they were written.
  py::object operator()(const std::vector<Node>* v) const {
    py::list list;
    for (const Node& n : *v) list.append(py::str(std::string(n.place.text())));
    return std::move(list);
  }
  py::object operator()(const std::optional<Node>* v) const {
    return *v ? py::object(py::str(std::string((*v)->place.text()))) : py::none();
  }
  py::object operator()(const Choice& c) const { return py::cast(c.words->at(c.get()).name); }
  py::object operator()(const Formula& f) const { return f.text ? py::cast(*f.text) : py::cast(*f.optional); }
  py::object operator()(const Formulas& f) const {
    return f.text ? py::cast(*f.text) : py::cast(*f.optional);
  }
  py::object operator()(const VectorOrFormulas& v) const {
    return *v.formulas ? py::cast(**v.formulas) : (*this)(v.value);
  }
};

/// As a number of that key would be written.
std::string unit_of(const Key& key) {
  const std::string unit(si_unit(key.dimension));
  if (key.dimension == Dimension::pressure_absolute) return unit + " absolute";
  return key.dimension == Dimension::pressure_gauge ? unit + " gauge" : unit;
}

py::tuple get(const CaseTree& tree, const std::string& path) {
  Case c = tree.as_it_stands();
  const auto key = find_key(c, path);
  if (!key)
    throw CaseError({{.key = path,
                      .what = "there is no such key in the case",
                      .nearest = nearest_key(c, path),
                      .example = "case[\"valve.supply_pressure\"]"}});
  return py::make_tuple(std::visit(ValueOf{}, key->slot), unit_of(*key));
}

/// Every key with all that is known of it; pressures of boundaries as that solver has them.
py::list schema(const std::string& solver) {
  Case c = documented_case();
  for (std::size_t n = 0; n < words(c.flow.solver).size(); ++n)
    if (words(c.flow.solver)[n].name == solver) c.flow.solver = static_cast<FlowSolver>(n);
  py::list all;
  for (const Section& s : sections(c)) {
    py::list keys;
    for (const Key& key : s.keys(0)) {
      py::dict entry;
      entry["name"] = key.name;
      entry["help"] = key.help;
      entry["takes"] = expectation(key);
      entry["default"] = default_words(key);
      entry["unit"] = unit_of(key);
      entry["source"] = key.source;
      entry["example"] = example(key);
      py::dict choices;
      if (const auto* choice = std::get_if<Choice>(&key.slot))
        for (const Word& w : *choice->words) choices[py::str(w.name)] = w.help;
      entry["words"] = choices;
      keys.append(entry);
    }
    py::dict section;
    section["name"] = s.name;
    section["help"] = s.help;
    section["repeated"] = s.repeated;
    section["keys"] = keys;
    all.append(section);
  }
  return all;
}

/// What `ejecta check` prints, and the same for programs.
py::tuple check(const CaseTree& tree, int threads) {
  std::string report;
  nlohmann::ordered_json json;
  {
    const py::gil_scoped_release others_may_run;
    const ThreadBudget as_before(threads);
    std::vector<Problem> warnings;
    std::optional<Scene> scene;
    const Case c = tree.checked(&warnings, &scene);
    if (c.study.enabled) check_study(tree.root(), c);
    if (c.campaign.enabled) {
      report = campaign_checked(c);
      json = {{"case", c.path}, {"problems", nlohmann::ordered_json::array()}};
    } else {
      const double bandwidth = measured_bandwidth();
      json = check_json(c, *scene, warnings, bandwidth);
      report = check_report(c, *scene, warnings, bandwidth);
    }
  }
  return py::make_tuple(report, as_object(json));
}

}  // namespace

void bind_case(py::module_& m) {
  py::class_<CaseTree>(m, "CaseTree")
      .def(py::init<std::string, std::string>(), py::arg("text"), py::arg("name"))
      .def_static("load", &CaseTree::load, py::arg("path"))
      .def(
          "set",
          [](CaseTree& tree,
             const std::vector<std::tuple<std::string, std::optional<std::string>, std::string>>& list) {
            std::vector<CaseTree::Assignment> assignments;
            for (const auto& [path, value, written] : list) assignments.push_back({path, value, written});
            tree.set(assignments);
          },
          py::arg("assignments"))
      .def("get", &get, py::arg("path"))
      .def("check", &check, py::arg("threads") = 0)
      .def("solver", [](const CaseTree& tree) { return word(tree.as_it_stands().flow.solver); })
      .def("toml", [](const CaseTree& tree) { return input_of(tree.checked()); })
      .def("copy", [](const CaseTree& tree) { return CaseTree(tree); })
      .def_property_readonly("name", &CaseTree::name);
  m.def("schema", &schema, py::arg("solver"));
}

}  // namespace ejecta::python
