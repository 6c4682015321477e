#include "case/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/shell_word.hpp"
#include "case/case_text.hpp"
#include "case/extends.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/node_path.hpp"
#include "case/override.hpp"
#include "case/reader.hpp"
#include "case/sense.hpp"

namespace ejecta {
namespace {

void throw_if_any(const std::vector<Problem>& problems) {
  if (!problems.empty()) throw CaseError(problems);
}

/// Nobody knows what a whole section that could not be read was meant to say.
bool concerns_a_section(const Problem& p) { return p.key.find('.') == std::string::npos; }

std::set<std::string> sections_of(const std::vector<Problem>& problems) {
  std::set<std::string> names;
  for (const Problem& p : problems)
    for (const std::string& key : {p.key, p.nearest}) names.insert(section_of(key));
  return names;
}

/// Grains that leave through a periodic side of the box come back on the other, as the fluid does.
void join_periodic_sides(Case& c) {
  const auto box = grid_box(c);
  if (c.grains.empty() || !c.bodies.empty() || c.flow.solver == FlowSolver::none || !box) return;
  std::vector<double>* extents[] = {&c.domain.x, &c.domain.y, &c.domain.z};
  for (int a = 0; a < 3; ++a) {
    const std::string name(1, "xyz"[a]);
    std::vector<double>& extent = *extents[a];
    if (c.boundary[2 * static_cast<std::size_t>(a)].type != BoundaryType::periodic || !extent.empty())
      continue;
    extent = {box->low[a], box->high[a]};
    c.domain.periodic.push_back(name);
  }
}

/// What follows from other keys.
void fill_in(Case& c) {
  join_periodic_sides(c);
  c.grid.refined = std::exchange(c.grid.refinement, 1.0);
  refine(c.grid, c.grid.refined);
  if (c.fluid.ideal_gas && c.fluid.density == 0.0)
    c.fluid.density = c.environment.pressure / (c.fluid.gas_constant * c.environment.temperature);
  if (c.materials.empty() && !(c.bodies.empty() && c.walls.empty() && c.grains.empty())) {
    c.materials.emplace_back();  // the paper's
    c.materials.back().name = "ore";
  }
  for (BodySpec& b : c.bodies)
    if (b.material.empty()) b.material = c.materials.front().name;
  for (WallSpec& w : c.walls)
    if (w.material.empty()) w.material = c.materials.front().name;
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    GrainsSpec& g = c.grains[n];
    if (g.material.empty()) g.material = c.materials.front().name;
    if (g.name.empty()) g.name = fmt::format("grains-{}", n + 1);
    const auto box = grid_box(c);
    if (!g.region && box) g.region = {box->low, box->high};
  }
  for (std::size_t n = 0; n < c.bodies.size(); ++n)
    if (c.bodies[n].name.empty()) c.bodies[n].name = fmt::format("body-{}", n + 1);
  for (std::size_t n = 0; n < c.walls.size(); ++n)
    if (c.walls[n].name.empty()) c.walls[n].name = fmt::format("wall-{}", n + 1);
}

}  // namespace

namespace {

/// Reads the case out of its tree; `problems` gets what is wrong.
Case resolve(const Node& root, const std::string& name, bool syntax_errors, std::vector<Problem>& problems,
             std::vector<Problem>* warnings, const FurtherChecks& further) {
  Case c;
  c.path = name;
  read_case(root, c, problems);
  if (syntax_errors) std::erase_if(problems, [](const Problem& p) { return p.what == "missing"; });

  if (c.campaign.enabled)  // which computes nothing itself
    std::erase_if(problems,
                  [](const Problem& p) { return p.what == "missing" && section_of(p.key) == "run"; });

  fill_in(c);
  const auto add = [&](std::vector<Problem> more) {
    for (Problem& p : more) {
      if (!p.place.source) p.place = locate(root, p.key);  // else it is in another file
      if (p.severity == Severity::error) problems.push_back(std::move(p));
      else if (warnings) warnings->push_back(std::move(p));
    }
  };
  if (!syntax_errors && std::none_of(problems.begin(), problems.end(), concerns_a_section))
    add(check_sense(c, sections_of(problems)));
  if (problems.empty() && further) add(further(c));
  return c;
}

}  // namespace

Case examine_case(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                  std::vector<Problem>& problems, std::vector<Problem>* warnings,
                  const FurtherChecks& further) {
  check_text(text, name);
  std::vector<std::string> bases;
  Node root = parse_extended(std::make_shared<Source>(Source{name, text}), problems, bases);
  // Keys may be missing only because their line could not be read: say what is wrong with the rest, not that.
  const bool syntax_errors = !problems.empty();
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  Case c = resolve(root, name, syntax_errors, problems, warnings, further);
  c.bases = std::move(bases);
  return c;
}

Case parse_case(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                std::vector<Problem>* warnings, const FurtherChecks& further) {
  std::vector<Problem> problems;
  Case c = examine_case(text, name, overrides, problems, warnings, further);
  throw_if_any(problems);
  return c;
}

Node case_tree(const std::string& path, const std::vector<std::string>& overrides) {
  const std::string text = read_case_text(path);
  check_text(text, path);
  std::vector<Problem> problems;
  std::vector<std::string> bases;
  Node root = parse_extended(std::make_shared<Source>(Source{path, text}), problems, bases);
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  throw_if_any(problems);
  return root;
}

Case resolve_case(const Node& root, const std::string& name, std::vector<Problem>& problems,
                  const FurtherChecks& further, std::vector<Problem>* warnings) {
  return resolve(root, name, false, problems, warnings, further);
}

std::string folder_of(const Case& c) { return std::filesystem::path(c.path).parent_path().string(); }

std::string beside_case(const Case& c, const std::string& file) {
  return path_word((std::filesystem::path(c.path).parent_path() / file).string());
}

namespace {

/// visit(file) for every file that a case names, as it names it.
template <class C, class Visit>
void for_each_file(C& c, const Visit& visit) {
  visit(c.valve.trace);
  visit(c.jet.source_case);
  for (auto& b : c.bodies) {
    visit(b.file);
    visit(b.path);
    for (auto& file : b.files) visit(file);
  }
  for (auto& w : c.walls) visit(w.file);
  for (auto& m : c.measured) visit(m.file);
  visit(c.map.measured);
  for (auto& part : c.campaign.parts) visit(part.file);
  visit(c.feed.file);
  for (auto& g : c.grains) visit(g.sieves);
  for (auto& one : c.classes) {
    visit(one.file);
    visit(one.sieves);
  }
}

}  // namespace

Case with_absolute_files(Case c) {
  for_each_file(c, [&](std::string& file) {
    if (!file.empty()) file = std::filesystem::absolute(beside_case(c, file)).lexically_normal().string();
  });
  return c;
}

namespace {

/// What else the case of a computed jet is made of.
std::vector<std::string> files_of_jet(const Case& c) {
  try {
    const Case jet = load_case(beside_case(c, c.jet.source_case));
    std::vector<std::string> files = files_of(jet);
    for (const std::string& base : jet.bases)
      files.push_back(std::filesystem::absolute(base).lexically_normal().string());
    return files;
  } catch (const Error&) {
    return {};  // the run says what is wrong with it
  }
}

}  // namespace

std::vector<std::string> files_of(const Case& c) {
  std::vector<std::string> files;
  if (!c.jet.source_case.empty()) files = files_of_jet(c);
  const Case absolute = with_absolute_files(c);
  for_each_file(absolute, [&](const std::string& file) {
    if (!file.empty()) files.push_back(file);
  });
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

Case load_case(const std::string& path, const std::vector<std::string>& overrides,
               std::vector<Problem>* warnings, const FurtherChecks& further) {
  return parse_case(read_case_text(path), path_word(path), overrides, warnings, further);
}

}  // namespace ejecta
