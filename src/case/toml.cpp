#include "case/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <toml.hpp>

#include "base/units.hpp"

// The only file that includes toml11: it is slow to compile.
namespace ejecta {
namespace {

constexpr int kMaxSyntaxErrors = 20;
constexpr int kMaxBrackets = 32, kMaxDots = 200;  // toml11 recurses

Place place_of(const toml::value& v, const std::shared_ptr<const Source>& source) {
  Place place{source, 0, 0};
  if (const auto* region = dynamic_cast<const toml::detail::region*>(toml::detail::get_region(v))) {
    place.offset = static_cast<std::size_t>(std::distance(region->begin(), region->first()));
    place.length = region->size();
  }
  return place;
}

Node convert(const toml::value& v, const std::shared_ptr<const Source>& source) {
  Node node;
  node.place = place_of(v, source);
  switch (v.type()) {
    case toml::value_t::boolean:
      node.value = v.as_boolean();
      break;
    case toml::value_t::integer:
      node.value = std::int64_t{v.as_integer()};
      break;
    case toml::value_t::floating:
      node.value = v.as_floating();
      break;
    case toml::value_t::string:
      node.value = v.as_string().str;
      break;
    case toml::value_t::array:
      node.value = Node::List{};
      for (const toml::value& element : v.as_array()) node.children.push_back(convert(element, source));
      break;
    case toml::value_t::table:
      node.value = Node::Table{};
      for (const auto& [key, child] : v.as_table()) {
        node.children.push_back(convert(child, source));
        node.children.back().key = key;
      }
      std::sort(node.children.begin(), node.children.end(), [](const Node& a, const Node& b) {
        return a.place.offset != b.place.offset ? a.place.offset < b.place.offset : a.key < b.key;
      });
      break;
    default:
      node.value = std::string(node.place.text());
      break;  // dates: no key takes one, the reader says so
  }
  return node;
}

/// Nesting that would exhaust the stack: unclosed '[' or '{' (strings not excepted), or a key of very many
/// dotted parts.
bool nested_too_deeply(const std::string& text, std::size_t& where) {
  int brackets = 0, dots = 0;
  for (where = 0; where < text.size(); ++where) {
    const char c = text[where];
    if (c == '[' || c == '{') ++brackets;
    else if ((c == ']' || c == '}') && brackets > 0) --brackets;
    if (c == '.') ++dots;
    else if (c == ',' || c == '=' || c == '\n' || c == ']') dots = 0;
    if (brackets > kMaxBrackets || dots > kMaxDots) return true;
  }
  return false;
}

/// toml11's message without its prefix and drawing.
std::string plain_message(const std::string& what) {
  std::string line = what.substr(0, what.find('\n'));
  if (line.starts_with("[error] ")) line.erase(0, 8);
  if (const auto colon = line.find(": "); line.starts_with("toml::") && colon != std::string::npos)
    line.erase(0, colon + 2);
  return line;
}

bool is_toml(const std::string& text) {
  try {
    std::istringstream stream(text + "\n");
    toml::parse(stream, "");
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

std::string replaced(std::string text,
                     std::initializer_list<std::pair<std::string_view, std::string_view>> signs) {
  for (const auto& [from, to] : signs)
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  return text;
}

/// The quotes of word processors made plain.
std::string with_plain_quotes(const std::string& text) {
  return replaced(text, {{"\u201c", "\""},
                         {"\u201d", "\""},
                         {"\u201e", "\""},
                         {"\u201f", "\""},
                         {"\u00ab", "\""},
                         {"\u00bb", "\""},
                         {"\u2018", "'"},
                         {"\u2019", "'"},
                         {"\u201a", "'"}});
}

/// What a value is most often meant to be that is no TOML, and in which words to say so. An advice is given
/// only if it is TOML itself.
void advise_value(Problem& p, const std::string& key, const std::string& written) {
  const auto offer = [&](const std::string& value, const char* expected) {
    if (value.empty() || !is_toml(key + "= " + value)) return false;
    p.expected = expected;
    p.example = key + "= " + value;
    return true;
  };
  const std::string plain = with_plain_quotes(written);
  if (plain != written && offer(plain, "straight quotes, \"...\"")) return;
  if (written.find('\\') != std::string::npos &&
      offer(replaced(written, {{"\\\\", "/"}, {"\\", "/"}}),
            "/ for \\ in the name of a file, or the name in 'single quotes'"))
    return;
  const bool bare = written.find_first_of("\"'[]{}") == std::string::npos && !written.empty();
  if (const std::string point = with_decimal_point(written); bare && !point.empty()) {
    if (parse_number(point) ? offer(point, "a decimal point")
                            : offer("\"" + point + "\"", "quotes around quantities, and a decimal point"))
      return;
  }
  if (bare && written.find(',') == std::string::npos &&
      offer("\"" + written + "\"", "quotes around words and quantities"))
    return;
  p.expected =
      "a \"text\", a \"quantity with unit\", a number with a decimal point, true, false or a [list], with "
      "matching "
      "quotes and brackets";
  p.example = "position = [\"0 mm\", \"0 mm\", \"75 mm\"]";
}

/// Says what is most often meant by a line that is no TOML.
void advise(Problem& p, std::string_view line) {
  const auto equals = line.find('=');
  const auto value =
      equals == std::string_view::npos ? std::string_view::npos : line.find_first_not_of(" \t", equals + 1);
  if (value == std::string_view::npos) {
    p.expected = "[section], [[list]] or key = value";
    p.example = "end_time = \"8 ms\"";
    return;
  }
  std::string rest(line.substr(value, line.find('#', value) - value));
  rest.erase(rest.find_last_not_of(" \t\r") + 1);
  advise_value(p, std::string(line.substr(0, equals)), rest);
}

std::size_t line_start(const std::string& text, std::size_t line_number) {
  std::size_t at = 0;
  for (std::size_t n = 1; n < line_number; ++n) {
    const auto end = text.find('\n', at);
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return at;
}

Problem syntax_problem(const toml::exception& e, const std::shared_ptr<const Source>& source,
                       std::size_t start, bool at_end) {
  Problem p{.what = "not TOML: " + plain_message(e.what())};
  p.place = {source, start, 1};
  const std::string_view line = p.place.line();
  const std::size_t column =
      at_end ? line.size() : std::min<std::size_t>(e.location().column() - 1, line.size());
  p.place.offset += column;
  p.place.length = std::max<std::size_t>(1, line.size() - column);
  advise(p, line);
  return p;
}

/// Blanks the line that starts at `start`; true if it was not blank already.
bool blank_line(std::string& text, std::size_t start) {
  bool changed = false;
  for (std::size_t i = start; i < text.size() && text[i] != '\n'; ++i) {
    changed = changed || text[i] != ' ';
    text[i] = ' ';
  }
  return changed;
}

}  // namespace

Node parse_toml(std::shared_ptr<const Source> source, std::vector<Problem>& problems) {
  Node empty;
  empty.place = {source, 0, 0};
  if (std::size_t where = 0; nested_too_deeply(source->text, where)) {
    problems.push_back(
        {.what = "nested too deeply",
         .expected = fmt::format("at most {} brackets and {} points in each other", kMaxBrackets, kMaxDots),
         .example = R"(position = ["0 mm", "0 mm", "5 mm"])",
         .place = {source, where, 1}});
    return empty;
  }
  std::string text = source->text;
  if (!text.ends_with('\n')) text += '\n';
  for (int n = 0; n < kMaxSyntaxErrors; ++n) {
    std::istringstream stream(text);
    try {
      return convert(toml::parse(stream, source->name), source);
    } catch (const toml::exception& e) {
      std::size_t start = line_start(text, e.location().line());
      // What is missed at the end of the text is missed by its last words.
      const std::size_t last = text.find_last_not_of(" \t\r\n");
      const bool at_end = last != std::string::npos && start > last;
      if (at_end) start = text.rfind('\n', last) + 1;
      problems.push_back(syntax_problem(e, source, start, at_end));
      if (!blank_line(text, start)) break;
    } catch (const std::exception& e) {  // out of range numbers and the like
      problems.push_back({.what = fmt::format("not TOML: {}", e.what()), .place = {source, 0, 1}});
      break;
    }
  }
  return empty;
}

}  // namespace ejecta
