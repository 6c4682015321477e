#include "case/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/node_path.hpp"
#include "case/override.hpp"
#include "case/problem.hpp"
#include "case/reader.hpp"
#include "case/sense.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

constexpr std::size_t max_file_size = 1u << 20;

std::string read_file(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path file(path);
  if (!std::filesystem::exists(file, ignored))
    throw InputError(fmt::format("{}: no such file\n  a first case:  ejecta new > my-case.toml", path));
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(fmt::format("{}: is a directory; a case is a .toml file", path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read (permissions?)", path));
  std::string text(max_file_size + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw InputError(fmt::format("{}: reading failed", path));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

/// The first byte from `n` on that is no part of a sign in UTF-8; the size of the text if there is none.
std::size_t first_not_utf8(std::string_view text, std::size_t n = 0) {
  const auto byte = [&](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0u; };
  while (n < text.size()) {
    const unsigned first = byte(n);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    if (length == 0) return n;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(n + k) & 0xc0) != 0x80) return n;
    n += length;
  }
  return text.size();
}

/// Refuses what cannot be a case before the parser sees it.
void check_text(const std::string& text, const std::string& name) {
  if (text.size() > max_file_size)
    throw InputError(
        fmt::format("{}: larger than {} MiB; a case is a short text (surfaces belong in an STL file)", name,
                    max_file_size >> 20));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(fmt::format("{}: is empty\n  a first case:  ejecta new > my-case.toml", name));
  for (char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u == 0 || (u < 0x20 && c != '\t' && c != '\n' && c != '\r'))
      throw InputError(fmt::format("{}: is not a text file (byte {:#04x}); a case is TOML", name, u));
  }
  if (const std::size_t at = first_not_utf8(text); at < text.size()) {
    std::string shown = text;
    for (std::size_t n = at; n < shown.size(); n = first_not_utf8(shown, n)) shown[n] = '?';
    const Problem p{
        .what = fmt::format("the byte {:#04x} is no UTF-8: the file was saved in another encoding, such as "
                            "ANSI (Windows-1252)",
                            static_cast<unsigned char>(text[at])),
        .expected = "a file saved as UTF-8, as editors offer under \"Save as\"",
        .place = {std::make_shared<Source>(Source{name, shown}), at, 1}};
    throw InputError(render(std::vector{p}));
  }
}

void throw_if_any(const std::vector<Problem>& problems) {
  if (!problems.empty()) throw InputError(render(problems));
}

/// Nobody knows what a whole section that could not be read was meant to say.
bool concerns_a_section(const Problem& p) { return p.key.find('.') == std::string::npos; }

std::set<std::string> sections_of(const std::vector<Problem>& problems) {
  std::set<std::string> names;
  for (const Problem& p : problems)
    for (const std::string& key : {p.key, p.nearest}) names.insert(section_of(key));
  return names;
}

/// What follows from other keys.
void fill_in(Case& c) {
  refine(c.grid, std::exchange(c.grid.refinement, 1.0));
  if (c.fluid.ideal_gas && c.fluid.density == 0.0)
    c.fluid.density = c.environment.pressure / (c.fluid.gas_constant * c.environment.temperature);
  if (c.materials.empty() && !(c.bodies.empty() && c.walls.empty())) {
    c.materials.emplace_back();  // the paper's
    c.materials.back().name = "ore";
  }
  for (BodySpec& b : c.bodies)
    if (b.material.empty()) b.material = c.materials.front().name;
  for (WallSpec& w : c.walls)
    if (w.material.empty()) w.material = c.materials.front().name;
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

Case parse_case(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                std::vector<Problem>* warnings, const FurtherChecks& further) {
  check_text(text, name);
  std::vector<Problem> problems;
  Node root = parse_toml(std::make_shared<Source>(Source{name, text}), problems);
  // Keys may be missing only because their line could not be read: say what is wrong with the rest, not that.
  const bool syntax_errors = !problems.empty();
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  const Case c = resolve(root, name, syntax_errors, problems, warnings, further);
  throw_if_any(problems);
  return c;
}

Node case_tree(const std::string& path, const std::vector<std::string>& overrides) {
  const std::string text = read_file(path);
  check_text(text, path);
  std::vector<Problem> problems;
  Node root = parse_toml(std::make_shared<Source>(Source{path, text}), problems);
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  throw_if_any(problems);
  return root;
}

Case resolve_case(const Node& root, const std::string& name, std::vector<Problem>& problems,
                  const FurtherChecks& further) {
  return resolve(root, name, false, problems, nullptr, further);
}

std::string folder_of(const Case& c) { return std::filesystem::path(c.path).parent_path().string(); }

std::string beside_case(const Case& c, const std::string& file) {
  return (std::filesystem::path(c.path).parent_path() / file).string();
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
}

}  // namespace

Case with_absolute_files(Case c) {
  for_each_file(c, [&](std::string& file) {
    if (!file.empty()) file = std::filesystem::absolute(beside_case(c, file)).lexically_normal().string();
  });
  return c;
}

std::vector<std::string> files_of(const Case& c) {
  std::vector<std::string> files;
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
  return parse_case(read_file(path), path, overrides, warnings, further);
}

}  // namespace ejecta
