#include "case/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "case/documented.hpp"
#include "case/extends.hpp"

namespace ejecta {
namespace {

std::string lower(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return std::tolower(c); });
  return s;
}

/// "body.0.size", "boundary.z_max.type", "[valve]" as the schema names them.
std::string plain_topic(const std::string& topic) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= topic.size();) {
    const std::size_t dot = std::min(topic.find('.', start), topic.size());
    std::string part = topic.substr(start, dot - start);
    std::erase_if(part, [](char c) { return c == '[' || c == ']' || c == ' '; });
    const bool index = !part.empty() &&
                       std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
    const bool face = part.size() == 5 && (part.ends_with("_min") || part.ends_with("_max"));
    if (!index) parts.push_back(face ? "x_min" : part);
    start = dot + 1;
  }
  return joined(parts, ".");
}

std::string line(const Key& key) {
  return fmt::format("  {:<26} {:<34} {}\n", key.name, default_words(key).substr(0, 34), key.help);
}

std::string tree(const std::vector<Section>& sections) {
  std::string text =
      "Keys of the case file: name, default, meaning. `ejecta explain valve.rise_time` tells more of one,\n"
      "`ejecta explain WORD` searches.\n";
  for (const Section& s : sections) {
    text += fmt::format("\n{}  {}\n", header(s), s.help);
    for (const Key& key : s.keys(0)) text += line(key);
  }
  return text;
}

std::string whole_section(const Section& s) {
  std::string text = fmt::format("{}  {}\n", header(s), s.help);
  for (const Key& key : s.keys(0)) text += line(key);
  return text;
}

std::string whole_key(const Section& s, const Key& key) {
  std::string text = fmt::format("{}.{}\n  {}\n\n", s.name, key.name, key.help);
  text += fmt::format("  section   {}\n  takes     {}\n  default   {}\n", header(s), expectation(key),
                      default_words(key));
  if (!key.source.empty()) text += fmt::format("  source    {}\n", key.source);
  text += fmt::format("  example   {} = {}\n", key.name, example(key));
  if (const auto* choice = std::get_if<Choice>(&key.slot)) {
    text += "\n";
    for (const Word& w : *choice->words)
      text += fmt::format("  {:<20} {}\n", fmt::format("\"{}\"", w.name), w.help);
  }
  return text;
}

/// All that is said of a key, in lower case.
std::string said_of(const Section& s, const Key& key) {
  std::string text = s.name + "." + key.name + " " + key.help + " " + key.source;
  if (const auto* choice = std::get_if<Choice>(&key.slot))
    for (const Word& w : *choice->words) text += " " + w.name + " " + w.help;
  return lower(text);
}

/// Some word of the text begins with `wanted`: "turb" is in "turbulence" and not in "undisturbed".
bool mentions(const std::string& text, const std::string& wanted) {
  for (std::size_t at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at + 1))
    if (at == 0 || !std::isalpha(static_cast<unsigned char>(text[at - 1]))) return true;
  return false;
}

/// The keys of which every word of the topic is said.
std::string search(const std::vector<Section>& sections, const std::string& topic) {
  std::istringstream stream(lower(topic));
  const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::string text;
  for (const Section& s : sections)
    for (const Key& key : s.keys(0))
      if (const std::string said = said_of(s, key);
          std::all_of(words.begin(), words.end(), [&](const std::string& w) { return mentions(said, w); }))
        text += fmt::format("  {:<34} {}\n", s.name + "." + key.name, key.help);
  return text;
}

}  // namespace

std::string explain(const std::string& topic) {
  Case c = documented_case();
  const std::vector<Section> all = documented_sections(c);
  if (topic.empty()) return tree(all);
  const std::string wanted = plain_topic(topic);
  if (wanted == "extends")
    return fmt::format("extends\n  {}.\n\n  example   extends = \"base.toml\", before the first section\n",
                       kExtendsHelp);
  std::string found;
  std::vector<std::string> known;
  for (const Section& s : all) {
    if (s.name == wanted) found += whole_section(s);
    known.push_back(s.name);
    for (const Key& key : s.keys(0)) {
      if (s.name + "." + key.name == wanted) return whole_key(s, key);
      known.push_back(s.name + "." + key.name);
    }
  }
  if (!found.empty()) return found;
  const std::string hits = search(all, topic);
  if (!hits.empty()) return fmt::format("Keys that mention \"{}\":\n{}", topic, hits);
  const std::string close = nearest(wanted, known);
  throw InputError(fmt::format("no key, section or help mentions \"{}\"{}", topic,
                               close.empty() ? "" : fmt::format("; nearest is \"{}\"", close)));
}

std::string reference_page() {
  Case c = documented_case();
  const auto cell = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
      text.replace(at, 1, "\\|");
    return text;
  };
  std::string text =
      "# Keys of the case file\n\n"
      "Written by `ejecta explain --markdown` from the schema in `src/case/`; a test compares the two.\n\n"
      "Quantities are texts with their unit (`\"8 ms\"`, `\"700 kPa gauge\"`); numbers without dimension are "
      "bare. Where a formula\n"
      "is allowed, a text that begins with `=` is one: `\"= 3 * step(t - 1e-3)\"`, in x, y, z (m) and t (s), "
      "with the result in\n"
      "SI units. Files are relative to the folder of the case that names them.\n\n"
      "`extends = \"base.toml\"`, before the first section: ";
  text += kExtendsHelp;
  text += ".\n";
  for (const Section& s : documented_sections(c)) {
    text += fmt::format(
        "\n## `{}`\n\n{}.{}\n\n| key | takes | default | meaning | source |\n|---|---|---|---|---|\n",
        header(s), s.help, s.enabled ? " Takes part as soon as the section is there." : "");
    for (const Key& key : s.keys(0))
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, cell(expectation(key)),
                          cell(default_words(key)), cell(key.help), cell(key.source));
    for (const Key& key : s.keys(0))
      if (const auto* choice = std::get_if<Choice>(&key.slot)) {
        text += fmt::format("\n`{}`:\n\n", key.name);
        for (const Word& w : *choice->words) text += fmt::format("- `\"{}\"`: {}\n", w.name, w.help);
      }
  }
  return text;
}

}  // namespace ejecta
