#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "case/find_key.hpp"
#include "case/node_path.hpp"
#include "case/override.hpp"
#include "case/problem.hpp"
#include "case/read_value.hpp"
#include "case/schema.hpp"
#include "case/write.hpp"
#include "output/build_info.hpp"
#include "output/progress.hpp"
#include "output/run_directory.hpp"
#include "study/design.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTasks = 100'000;

/// The numbers of a key that has some: where they are read from, and how they are put back.
class Range {
 public:
  Range(const Key& key, const std::string& path, double ambient)
      : key_(key), path_(path), ambient_(ambient) {}

  bool has_numbers() const { return is_whole() || is_real() || is_vector(); }

  std::vector<double> read(const Node& node, std::vector<Problem>& problems) const {
    double number = 0.0;
    std::int64_t whole = 0;
    Vec3 vector{0, 0, 0};
    Key key = key_;
    if (is_whole()) key.slot = &whole;
    else if (is_vector()) key.slot = &vector;
    else key.slot = &number;
    read_value(node, key, path_, ambient_, problems);
    if (is_vector()) return {vector.x(), vector.y(), vector.z()};
    return {is_whole() ? double(whole) : number};
  }

  /// The value at the share u of the way, in the file's own terms, as if it were written at `place`.
  Node at(const std::vector<double>& from, const std::vector<double>& to, double u,
          const Place& place) const {
    if (is_vector()) {
      Node list;
      list.value = Node::List{};
      list.place = place;
      for (std::size_t d = 0; d < from.size(); ++d)
        list.children.push_back(one(from[d] + u * (to[d] - from[d]), place));
      return list;
    }
    return one(from[0] + u * (to[0] - from[0]), place);
  }

  bool is_whole() const {
    return std::holds_alternative<int*>(key_.slot) || std::holds_alternative<std::int64_t*>(key_.slot);
  }

 private:
  bool is_real() const {
    return std::holds_alternative<double*>(key_.slot) ||
           std::holds_alternative<std::optional<double>*>(key_.slot);
  }
  bool is_vector() const {
    return std::holds_alternative<Vec3*>(key_.slot) || std::holds_alternative<VectorOrFormulas>(key_.slot);
  }
  Node one(double v, const Place& place) const {
    Node node;
    node.place = place;
    if (is_whole()) node.value = static_cast<std::int64_t>(std::llround(v));
    else if (key_.dimension == Dimension::none) node.value = v;
    else node.value = format_quantity(v, key_.dimension);
    return node;
  }

  Key key_;
  std::string path_;
  double ambient_;
};

/// One key that varies, with its values, or its range where samples are drawn.
struct Variable {
  std::string key;
  std::vector<Node> values;
  std::optional<Range> range;
  std::vector<double> from, to;
  Place place;

  Node value(double u) const {
    if (!values.empty())
      return values[std::min(values.size() - 1, static_cast<std::size_t>(u * double(values.size())))];
    if (!range->is_whole()) return range->at(from, to, u, place);
    // Whole numbers have equal chances, the ends included.
    const double n = std::abs(to[0] - from[0]) + 1.0, step = to[0] < from[0] ? -1.0 : 1.0;
    const double whole = from[0] + step * std::min(n - 1.0, std::floor(u * n));
    return range->at({whole}, {whole}, 0.0, place);
  }
};

/// Digits of the longest part of a JSON pointer that is a number.
std::size_t longest_number(const std::string& pointer) {
  std::size_t longest = 0;
  for (std::size_t at = 0; at < pointer.size(); ++at) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const std::string part = pointer.substr(at, end - at);
    if (part.find_first_not_of("0123456789") == std::string::npos) longest = std::max(longest, part.size());
    at = end;
  }
  return longest;
}

class Setup {
 public:
  Setup(const Node& root, const Case& base, const FurtherChecks& further)
      : root_(root), base_(base), spec_(base.study), further_(further) {}

  StudySetup build() {
    if (!spec_.enabled)
      refuse({.key = "study",
              .what = "the case has no [study]",
              .expected = "which keys vary, and how",
              .example = "[[study.vary]] key = \"valve.supply_pressure\", values = [\"400 kPa gauge\", \"700 "
                         "kPa gauge\"]"});
    else if (spec_.vary.empty())
      refuse({.key = "study",
              .what = "nothing varies",
              .expected = "one [[study.vary]] for each key",
              .example = "[[study.vary]] key = \"valve.supply_pressure\", values = [\"400 kPa gauge\", \"700 "
                         "kPa gauge\"]",
              .place = locate(root_, "study")});
    for (std::size_t n = 0; n < spec_.vary.size(); ++n) read_variable(n);
    check_quantities();
    throw_if_any();
    StudySetup setup{study_header("study", base_), tasks()};
    throw_if_any();
    Case probe = base_;
    for (const Variable& v : variables_)
      setup.header["keys"].push_back({{"key", v.key}, {"unit", unit_of(*find_key(probe, v.key))}});
    setup.header["quantities"] = quantities();
    setup.header["keep_runs"] = spec_.keep_runs;
    return setup;
  }

 private:
  bool drawn() const {
    return spec_.design == StudyDesign::latin_hypercube || spec_.design == StudyDesign::sobol;
  }
  void refuse(Problem p) { problems_.push_back(std::move(p)); }
  void throw_if_any() const {
    if (!problems_.empty()) throw CaseError(problems_);
  }

  void read_variable(std::size_t n) {
    const VarySpec& spec = spec_.vary[n];
    const std::string path = fmt::format("study.vary.{}", n);
    const auto wrong = [&](const std::string& key, const std::string& what, const std::string& expected,
                           const std::string& closest = "", const std::string& example = "") {
      refuse({.key = path + "." + key,
              .what = what,
              .expected = expected,
              .nearest = closest,
              .example = example,
              .place = locate(root_, path + "." + key)});
    };
    Case probe = base_;
    const std::optional<Key> key = find_key(probe, spec.key);
    if (!key)
      return wrong("key", fmt::format("there is no key \"{}\"", spec.key), "a key of the case file",
                   nearest_key(probe, spec.key), "key = \"valve.supply_pressure\"");
    const std::string section = spec.key.substr(0, spec.key.find('.'));
    if (changes_no_result(section) || spec.key == "run.title" || key->name == "name")
      return wrong("key", fmt::format("{} may not vary: it changes no result", spec.key),
                   "a key that decides what happens", "", "key = \"valve.supply_pressure\"");
    for (const Variable& other : variables_)
      if (other.key == spec.key)
        return wrong("key", spec.key + " varies already", "each key once", "",
                     "key = \"valve.supply_pressure\"");
    Variable v{.key = spec.key, .values = spec.values, .range = {}, .from = {}, .to = {}, .place = {}};
    const bool range = spec.from || spec.to;
    if (range == !spec.values.empty())
      return wrong(range ? "from" : "key", range ? "values and a range" : "neither values nor a range",
                   "`values`, or `from` and `to`", "", "values = [" + example(*key) + "]");
    if (range) {
      v.range.emplace(*key, spec.key, base_.environment.pressure);
      if (!v.range->has_numbers())
        return wrong("from", spec.key + " has no range: it is not a number", "`values`", "",
                     "values = [" + example(*key) + "]");
      if (!spec.from || !spec.to)
        return wrong(spec.from ? "from" : "to", "one end of a range", "`from` and `to`");
      v.place = spec.from->place;
      v.from = v.range->read(*spec.from, problems_);
      v.to = v.range->read(*spec.to, problems_);
      if (!drawn()) {
        if (spec.steps < 2)
          return wrong("steps", "a range needs its number of values here", "a whole number, at least 2", "",
                       "steps = 6");
        if (spec.steps > static_cast<int>(kMostTasks)) return too_many(path + ".steps", spec.steps);
        for (int i = 0; i < spec.steps; ++i)
          v.values.push_back(v.range->at(v.from, v.to, double(i) / (spec.steps - 1), v.place));
      }
    }
    if (spec_.design == StudyDesign::list && !variables_.empty() &&
        v.values.size() != variables_.front().values.size())
      return wrong(range ? "steps" : "values",
                   fmt::format("{} values where {} has {}", v.values.size(), variables_.front().key,
                               variables_.front().values.size()),
                   "lists of one length: the first values go together, then the second", "",
                   range ? fmt::format("steps = {}", variables_.front().values.size()) : "design = \"grid\"");
    variables_.push_back(std::move(v));
  }

  void check_quantities() {
    for (std::size_t n = 0; n < spec_.quantities.size(); ++n) {
      const std::string& q = spec_.quantities[n];
      // An index that no list has is no place either: the library would throw it once a result is there.
      bool good = q.starts_with('/') && longest_number(q) < 10;
      try {
        (void)Json::json_pointer(q);
      } catch (const nlohmann::json::exception&) {
        good = false;
      }
      if (good) continue;
      const Node* list = find_section(root_, "study.quantities");
      refuse({.key = fmt::format("study.quantities.{}", n),
              .what = fmt::format("\"{}\" is no JSON pointer", q),
              .expected = "a place in result.json (docs/files.md), with slashes",
              .example = "quantities = [\"/bodies/0/velocity_change_z_m_s\"]",
              .place = list && n < list->children.size() ? list->children[n].place
                                                         : locate(root_, "study.quantities")});
    }
  }

  void too_many(const std::string& key, double count) {
    refuse({.key = key,
            .what = fmt::format("a study of {:.0f} runs", count),
            .expected = fmt::format("at most {}: fewer values, or samples", kMostTasks),
            .example = "design = \"sobol\", samples = 256",
            .place = locate(root_, key)});
  }

  /// For each run the value of each variable.
  std::vector<std::vector<Node>> combinations() {
    std::vector<std::vector<Node>> runs;
    if (drawn()) {
      const int count = spec_.samples, dimensions = static_cast<int>(variables_.size());
      if (count > static_cast<int>(kMostTasks)) too_many("study.samples", count);
      if (count < 1)
        refuse({.key = "study.samples",
                .what = "a design that is drawn needs the number of its runs",
                .expected = "a whole number, more than 0",
                .example = "samples = 32",
                .place = locate(root_, "study")});
      if (spec_.design == StudyDesign::sobol && dimensions > kSobolDimensions)
        refuse({.key = "study.design",
                .what = fmt::format("a Sobol sequence of {} keys", dimensions),
                .expected = fmt::format("at most {}, or \"latin-hypercube\"", kSobolDimensions),
                .place = locate(root_, "study.design")});
      throw_if_any();
      const Samples samples = spec_.design == StudyDesign::sobol
                                  ? sobol(count, dimensions, spec_.seed)
                                  : latin_hypercube(count, dimensions, spec_.seed);
      for (const auto& point : samples) {
        std::vector<Node>& run = runs.emplace_back();
        for (std::size_t d = 0; d < variables_.size(); ++d) run.push_back(variables_[d].value(point[d]));
      }
      return runs;
    }
    if (spec_.design == StudyDesign::list) {
      for (std::size_t n = 0; n < variables_.front().values.size(); ++n) {
        std::vector<Node>& run = runs.emplace_back();
        for (const Variable& v : variables_) run.push_back(v.values[n]);
      }
      return runs;
    }
    double count = 1.0;
    for (const Variable& v : variables_) count *= double(v.values.size());
    if (count > double(kMostTasks)) {
      too_many("study", count);
      throw_if_any();
    }
    runs.emplace_back();
    for (const Variable& v : variables_) {
      std::vector<std::vector<Node>> longer;
      for (const auto& run : runs)
        for (const Node& value : v.values) {
          longer.push_back(run);
          longer.back().push_back(value);
        }
      runs = std::move(longer);
    }
    return runs;
  }

  std::vector<NewTask> tasks() {
    Node plain = root_;  // what is studied is no part of the runs
    std::erase_if(plain.children, [](const Node& n) { return n.key == "study" || n.key == "map"; });
    std::set<std::pair<std::size_t, std::string>> told;  // a value of a grid is in many runs
    std::set<std::string> seen;
    std::vector<NewTask> tasks;
    for (const std::vector<Node>& values : combinations()) {
      Node root = plain;
      std::vector<Problem> found;
      for (std::size_t d = 0; d < values.size(); ++d)
        if (auto refusal = put_value(root, variables_[d].key, values[d])) {
          refusal->key = variables_[d].key;
          refusal->place = values[d].place;
          found.push_back(std::move(*refusal));
        }
      Case c = resolve_case(root, base_.path, found, further_);
      if (found.empty()) {
        Json labels = Json::object();
        for (const Variable& v : variables_) labels[v.key] = json_of(*find_key(c, v.key));
        if (!seen.insert(labels.dump()).second)
          found.push_back(
              {.key = variables_.back().key,
               .what = fmt::format("two runs of the study are the same: {}", labels.dump()),
               .expected = drawn() ? "fewer samples: whole numbers and words have only so many values"
                                   : "values that differ",
               .example = drawn() ? "samples = 3"
                                  : "values = [" + example(*find_key(c, variables_.back().key)) + "]",
               .place = values.back().place});
        tasks.push_back({std::move(c), std::move(labels)});
      }
      for (Problem& p : found)
        if (told.insert({p.place.offset, p.what}).second) refuse(std::move(p));
      if (problems_.size() > 50) break;
    }
    return tasks;
  }

  std::vector<std::string> quantities() const {
    if (!spec_.quantities.empty()) return spec_.quantities;
    if (base_.sorter.enabled) return {"/recovery", "/purity", "/loss", "/air_Nm3_per_t"};
    if (!base_.splitter.enabled) return {"/bodies/0/velocity_change_z_m_s"};
    return {"/outcome", "/bodies/0/clearance_at_splitter_m", "/bodies/0/velocity_change_z_m_s"};
  }

  static std::string unit_of(const Key& key) {
    const bool gauge = key.dimension == Dimension::pressure_gauge;
    if (gauge || key.dimension == Dimension::pressure_absolute) return gauge ? "Pa gauge" : "Pa absolute";
    return std::string(si_unit(key.dimension));
  }

  static Json json_of(const Key& key) {
    if (const auto* v = std::get_if<double*>(&key.slot)) return **v;
    if (const auto* o = std::get_if<std::optional<double>*>(&key.slot))
      return **o ? Json(***o) : Json(nullptr);
    if (const auto* i = std::get_if<int*>(&key.slot)) return **i;
    if (const auto* l = std::get_if<std::int64_t*>(&key.slot)) return **l;
    if (const auto* b = std::get_if<bool*>(&key.slot)) return **b;
    if (const auto* s = std::get_if<std::string*>(&key.slot)) return **s;
    if (const auto* v3 = std::get_if<Vec3*>(&key.slot)) return Json{(*v3)->x(), (*v3)->y(), (*v3)->z()};
    if (const auto* f = std::get_if<VectorOrFormulas>(&key.slot); f && !*f->formulas)
      return Json{f->value->x(), f->value->y(), f->value->z()};
    if (const auto* c = std::get_if<Choice>(&key.slot)) return c->words->at(c->get()).name;
    return value_text(key);
  }

  const Node& root_;
  const Case& base_;
  const StudySpec& spec_;
  const FurtherChecks& further_;
  std::vector<Variable> variables_;
  std::vector<Problem> problems_;
};

std::string csv_field(const Json& value) {
  std::string text = value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.find_first_of(",;\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

StudySetup set_up_study(const Node& root, const Case& base, const FurtherChecks& further) {
  return Setup(root, base, further).build();
}

Json study_header(const std::string& kind, const Case& base) {
  const Case c = with_absolute_files(base);
  return {{"kind", kind},
          {"title", c.run.title},
          {"case", base.path},
          {"version", output::version()},
          {"input_sha256", sha256_hex(write_case(c) + output::digests_of(files_of(c)).dump())}};
}

std::vector<std::string> unknown_quantities(const TaskStore& store) {
  const std::vector<TaskState> states = store.states();
  std::set<std::string> wanted;
  for (const std::string q : store.header()["quantities"]) wanted.insert(q);
  std::vector<std::string> names;
  for (std::size_t n = 0; n < states.size() && !wanted.empty(); ++n) {
    if (states[n] != TaskState::done) continue;
    const Json result = store.result(n).value("result", Json());
    std::erase_if(wanted, [&](const std::string& q) { return result.contains(Json::json_pointer(q)); });
    if (!names.empty()) continue;
    const Json single = result.flatten();
    for (const auto& [name, value] : single.items()) names.push_back(name);
  }
  std::vector<std::string> told;
  for (const std::string& q : wanted) {
    if (names.empty()) break;  // no run is done
    const std::string close = nearest(q, names);
    told.push_back(fmt::format("no run has the quantity \"{}\"{}", q,
                               close.empty() ? "" : fmt::format("; did you mean \"{}\"?", close)));
  }
  return told;
}

namespace {

/// A key that is a vector has a column for each component.
std::vector<std::string> columns_of(const std::string& key, const std::vector<Task>& tasks) {
  const bool vector = !tasks.empty() && tasks.front().labels.contains(key) &&
                      tasks.front().labels[key].is_array() && tasks.front().labels[key].size() == 3;
  return vector ? std::vector{key + ".x", key + ".y", key + ".z"} : std::vector{key};
}

}  // namespace

Json study_result(const TaskStore& store) {
  const Json& head = store.header();
  Json r{{"title", head.value("title", "")},
         {"kind", "study"},
         {"keys", Json::array()},
         {"quantities", head["quantities"]},
         {"runs", Json::array()}};
  const std::vector<TaskState> states = store.states();
  for (const Json& key : head["keys"])
    for (const std::string& name : columns_of(key["key"], store.tasks()))
      r["keys"].push_back({{"key", name}, {"unit", key["unit"]}});
  for (std::size_t n = 0; n < states.size(); ++n) {
    Json run{{"task", n}, {"state", word(states[n])}};
    for (const auto& [key, value] : store.tasks()[n].labels.items()) {
      const std::vector<std::string> names = columns_of(key, store.tasks());
      for (std::size_t k = 0; k < names.size(); ++k) run[names[k]] = names.size() == 1 ? value : value.at(k);
    }
    const Json result = states[n] == TaskState::done ? store.result(n).value("result", Json()) : Json();
    for (const std::string q : head["quantities"]) {
      const Json::json_pointer pointer(q);
      run[q] = result.contains(pointer) ? result.at(pointer) : Json();
    }
    if (states[n] == TaskState::diverged || states[n] == TaskState::refused ||
        states[n] == TaskState::crashed)
      run["reason"] = store.failure(n);
    if (head.value("keep_runs", true)) run["directory"] = "runs/" + store.tasks()[n].hash;
    r["runs"].push_back(std::move(run));
  }
  return r;
}

std::string study_table(const Json& result) {
  std::string text = "run,state";
  std::vector<std::string> columns;
  for (const Json& key : result["keys"]) {
    columns.push_back(key["key"]);
    const std::string unit = key["unit"];
    text += "," + csv_field(columns.back() + (unit.empty() || unit == "1" ? "" : " [" + unit + "]"));
  }
  for (const std::string q : result["quantities"]) {
    columns.push_back(q);
    text += "," + csv_field(q);
  }
  text += ",reason\n";
  for (const Json& run : result["runs"]) {
    text += fmt::format("{},{}", run["task"].get<std::size_t>() + 1, run["state"].get<std::string>());
    for (const std::string& column : columns) text += "," + csv_field(run[column]);
    text += "," + csv_field(run.value("reason", "")) + "\n";
  }
  return text;
}

StudyStatus study_status(const TaskStore& store) {
  StudyStatus s;
  const std::vector<TaskState> states = store.states();
  s.tasks = states.size();
  constexpr std::size_t shown = 20;
  std::vector<std::string> failures;
  for (std::size_t n = 0; n < states.size(); ++n) switch (states[n]) {
      case TaskState::done:
        ++s.done;
        break;
      case TaskState::waiting:
        ++s.waiting;
        break;
      case TaskState::running: {
        ++s.running;
        if (s.lines.size() >= shown) break;
        if (const auto life = store.life(n))
          s.lines.push_back(fmt::format("run {}: {:.0f} %, last sign of life {:.0f} s ago, process {} on {}",
                                        n + 1, 100.0 * life->fraction, std::max(0.0, life->age),
                                        life->process, life->host));
        break;
      }
      case TaskState::diverged:
      case TaskState::refused:
      case TaskState::crashed:
        ++s.failed;
        if (failures.size() < shown)
          failures.push_back(fmt::format("run {} {}: {}", n + 1, word(states[n]), store.failure(n)));
    }
  s.lines.insert(s.lines.end(), failures.begin(), failures.end());
  // The pace of late holds what is run side by side; an old pause in it does no harm for long.
  if (const std::vector<double> times = store.latest_results(50);
      times.size() > 1 && s.waiting + s.running > 0) {
    const double span =
        std::max(times.back(), s.running > 0 ? seconds_since_1970() : times.back()) - times.front();
    s.seconds_left = span / double(times.size() - 1) * double(s.waiting + s.running);
  }
  return s;
}

std::string status_line(const StudyStatus& s) {
  std::string text = fmt::format("{} of {} runs done", s.done, s.tasks);
  if (s.running > 0) text += fmt::format(", {} running", s.running);
  if (s.failed > 0) text += fmt::format(", {} failed", s.failed);
  if (s.seconds_left >= 0.0 && s.running > 0)
    text += fmt::format(", about {} left", output::duration_text(s.seconds_left));
  return text;
}

}  // namespace ejecta
