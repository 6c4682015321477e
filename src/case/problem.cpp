#include "case/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.hpp"

namespace ejecta {
namespace {

/// What may be printed: control characters would garble the terminal.
std::string printable(std::string_view text) {
  std::string out;
  for (char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '\t') out += ' ';
    else if (u < 0x20 || u == 0x7f) out += '?';
    else out += c;
  }
  return out;
}

/// The line, shortened around the caret if it is very long.
std::string excerpt(const Place& place) {
  constexpr std::size_t widest = 120;
  std::string_view line = place.line();
  std::size_t column = std::min(place.column(), line.size());
  if (line.size() > widest) {
    const std::size_t start = column > widest / 2 ? column - widest / 2 : 0;
    line = line.substr(start, widest);
    column -= start;
  }
  const std::size_t length = std::clamp<std::size_t>(place.text().substr(0, place.text().find('\n')).size(),
                                                     1, std::max<std::size_t>(1, line.size() - column));
  const std::string number = fmt::format("{:>5}", place.line_number());
  return fmt::format("{} | {}\n{:>5} | {}^{}\n", number, printable(line), "", std::string(column, ' '),
                     std::string(length - 1, '~'));
}

}  // namespace

std::string place_text(const Vec3& place) {
  const auto length = [&](int d) {  // to a micrometre: it is an example
    return format_quantity(std::round(1e6 * place[d]) / 1e6, Dimension::length);
  };
  return fmt::format("[\"{}\", \"{}\", \"{}\"]", length(0), length(1), length(2));
}

std::string place_line(const std::string& key, const Vec3& place) {
  return fmt::format("{} = {}", key, place_text(place));
}

CaseError::CaseError(std::vector<Problem> list) : InputError(render(list)), problems(std::move(list)) {}

std::vector<Problem> problems_of(const InputError& refusal) {
  if (const auto* of_case = dynamic_cast<const CaseError*>(&refusal)) return of_case->problems;
  return {{.what = refusal.what(), .expected = refusal.advice.expected, .example = refusal.advice.example}};
}

std::string render(const Problem& p) {
  std::string text;
  if (p.place.source) {
    const Source& s = *p.place.source;
    const bool has_lines = !s.name.starts_with("--set ");  // else it is a word of the command line
    text += has_lines ? fmt::format("{}:{}: ", s.name, p.place.line_number()) : s.name + ": ";
  }
  text += p.severity == Severity::error ? "error: " : "warning: ";
  if (!p.key.empty()) text += printable(p.key) + ": ";
  text += printable(p.what) + "\n";
  if (p.place.source) text += excerpt(p.place);
  if (!p.expected.empty()) text += "  expected: " + printable(p.expected) + "\n";
  if (!p.nearest.empty()) text += "  nearest:  " + printable(p.nearest) + "\n";
  if (!p.example.empty()) text += "  example:  " + printable(p.example) + "\n";
  return text;
}

std::string render(std::vector<Problem> problems) {
  constexpr std::size_t shown = 50;
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    const auto file = [](const Problem& p) {
      return p.place.source ? std::string_view(p.place.source->name) : std::string_view();
    };
    return file(a) != file(b) ? file(a) < file(b) : a.place.offset < b.place.offset;
  });
  std::string text;
  for (std::size_t n = 0; n < std::min(shown, problems.size()); ++n) text += render(problems[n]) + "\n";
  if (problems.size() > shown) text += fmt::format("... and {} more\n\n", problems.size() - shown);
  const auto errors = std::count_if(problems.begin(), problems.end(),
                                    [](const Problem& p) { return p.severity == Severity::error; });
  return text + fmt::format("{} error{}", errors, errors == 1 ? "" : "s");
}

}  // namespace ejecta
