#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/text.hpp"

namespace ejecta {
namespace {

/// SI value = value * times / over + offset. Decimal fractions divide, because that rounds once, not twice.
struct Unit {
  std::string_view name;
  double times = 1.0, over = 1.0, offset = 0.0;
  bool shown = false;  ///< format_quantity may choose it
};

struct Entry {
  Dimension dimension;
  Magnitudes magnitudes;
  std::string_view words, example;
  std::vector<Unit> units;  ///< SI first
};

constexpr double inch = 0.0254, psi = 6894.757293168, minute = 60.0;

std::vector<Unit> pressure_units() {
  return {{"Pa", 1, 1, 0, true},
          {"kPa", 1e3, 1, 0, true},
          {"MPa", 1e6, 1, 0, true},
          {"GPa", 1e9, 1, 0, true},
          {"hPa", 1e2},
          {"mbar", 1e2},
          {"bar", 1e5},
          {"atm", 101325.0},
          {"psi", psi},
          {"N/m2", 1},
          {"N/mm2", 1e6},
          {"mmHg", 133.322387415},
          {"Torr", 101325.0, 760.0}};
}

const std::vector<Entry>& table() {
  using enum Dimension;
  static const std::vector<Entry> entries{
      {none, {0, 1e300}, "a number without unit", "0.5", {}},
      {length,
       {1e-10, 1e6},
       "a length",
       "10 mm",
       {{"m", 1, 1, 0, true},
        {"mm", 1, 1e3, 0, true},
        {"um", 1, 1e6, 0, true},
        {"cm", 1, 1e2},
        {"km", 1e3},
        {"nm", 1, 1e9},
        {"in", inch}}},
      {area,
       {1e-20, 1e12},
       "an area",
       "100 mm2",
       {{"m2", 1, 1, 0, true}, {"mm2", 1, 1e6, 0, true}, {"cm2", 1, 1e4}}},
      {volume,
       {1e-30, 1e18},
       "a volume",
       "1 cm3",
       {{"m3", 1, 1, 0, true}, {"mm3", 1, 1e9, 0, true}, {"cm3", 1, 1e6}, {"L", 1, 1e3}, {"mL", 1, 1e6}}},
      {time,
       {1e-12, 1e10},
       "a time",
       "8 ms",
       {{"s", 1, 1, 0, true},
        {"ms", 1, 1e3, 0, true},
        {"us", 1, 1e6, 0, true},
        {"ns", 1, 1e9},
        {"min", minute},
        {"h", 3600.0}}},
      {velocity,
       {1e-9, 1e5},
       "a velocity",
       "3 m/s",
       {{"m/s", 1, 1, 0, true},
        {"mm/s", 1, 1e3},
        {"cm/s", 1, 1e2},
        {"km/h", 1, 3.6},
        {"m/min", 1, minute},
        {"ft/s", 0.3048}}},
      {acceleration,
       {1e-9, 1e9},
       "an acceleration",
       "9.81 m/s2",
       {{"m/s2", 1, 1, 0, true}, {"mm/s2", 1, 1e3}, {"g", 9.80665}}},
      {angle,
       {1e-12, 1e6},
       "an angle",
       "45 deg",
       {{"rad", 1, 1, 0, true}, {"deg", std::numbers::pi, 180.0, 0, true}}},
      {angular_velocity,
       {1e-9, 1e9},
       "an angular velocity",
       "10 rad/s",
       {{"rad/s", 1, 1, 0, true}, {"deg/s", std::numbers::pi, 180.0}, {"rpm", 2 * std::numbers::pi, minute}}},
      {mass,
       {1e-21, 1e12},
       "a mass",
       "2.7 g",
       {{"kg", 1, 1, 0, true},
        {"g", 1, 1e3, 0, true},
        {"mg", 1, 1e6, 0, true},
        {"t", 1e3},
        {"lb", 0.45359237}}},
      {density,
       {1e-6, 1e8},
       "a density",
       "2700 kg/m3",
       {{"kg/m3", 1, 1, 0, true}, {"g/cm3", 1e3}, {"t/m3", 1e3}, {"kg/L", 1e3}}},
      {force,
       {1e-15, 1e12},
       "a force",
       "0.5 N",
       {{"N", 1, 1, 0, true}, {"mN", 1, 1e3, 0, true}, {"kN", 1e3, 1, 0, true}}},
      {pressure_gauge, {1e-6, 1e21}, "a pressure", "0 Pa gauge", pressure_units()},
      {pressure_absolute, {1e-6, 1e21}, "a pressure", "700 kPa gauge", pressure_units()},
      {pressure, {1e-6, 1e21}, "a pressure difference or modulus", "5 MPa", pressure_units()},
      {temperature,
       {1e-3, 1e5},
       "a temperature",
       "298.15 K",
       {{"K", 1, 1, 0, true},
        {"C", 1, 1, 273.15},
        {"degC", 1, 1, 273.15},
        {"F", 5, 9, 273.15 - 32 * 5 / 9.0}}},
      {viscosity,
       {1e-12, 1e6},
       "a dynamic viscosity",
       "1.85e-5 Pa s",
       {{"Pa s", 1, 1, 0, true},
        {"Pa.s", 1},
        {"mPa s", 1, 1e3},
        {"uPa s", 1, 1e6},
        {"kg/m/s", 1},
        {"cP", 1, 1e3},
        {"P", 1, 10}}},
      {frequency,
       {1e-9, 1e9},
       "a frequency",
       "50 Hz",
       {{"Hz", 1, 1, 0, true}, {"kHz", 1e3, 1, 0, true}, {"1/s", 1}}},
      {stiffness,
       {1e-9, 1e15},
       "a stiffness",
       "1000 N/m",
       {{"N/m", 1, 1, 0, true}, {"kN/m", 1e3}, {"N/mm", 1e3}}},
      {specific_energy,
       {1e-15, 1e10},
       "a turbulent kinetic energy",
       "0.5 m2/s2",
       {{"m2/s2", 1, 1, 0, true}, {"J/kg", 1}}},
      {dissipation_rate,
       {1e-15, 1e18},
       "a dissipation rate",
       "10 m2/s3",
       {{"m2/s3", 1, 1, 0, true}, {"W/kg", 1}}},
      {mass_flow,
       {1e-15, 1e9},
       "a mass flow",
       "10 t/h",
       {{"kg/s", 1, 1, 0, true}, {"t/h", 1, 3.6, 0, true}, {"kg/h", 1, 3600}, {"g/s", 1, 1e3}}},
      {specific_heat,
       {1e-3, 1e8},
       "a specific heat or gas constant",
       "287.05 J/kg/K",
       {{"J/kg/K", 1, 1, 0, true}, {"kJ/kg/K", 1e3}, {"m2/s2/K", 1}}},
  };
  return entries;
}

const Entry& entry(Dimension d) {
  for (const Entry& e : table())
    if (e.dimension == d) return e;
  throw Error("units: a dimension is missing in the table");
}

std::string_view trim(std::string_view s) {
  const auto first = s.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t") - first + 1);
}

bool is_referred(Dimension d) { return d == Dimension::pressure_gauge || d == Dimension::pressure_absolute; }

constexpr std::string_view gauge = "gauge", absolute = "absolute";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// A unit as the table has it, of one as instruments and people write it: "µm", "kg/m³", "N/mm^2", "°C",
/// "barg", "psia", "kPa(g)".
std::string plain_unit(std::string_view written) {
  static constexpr std::pair<std::string_view, std::string_view> signs[] = {
      {"\u00b5", "u"}, {"\u03bc", "u"}, {"\u00b2", "2"},        {"\u00b3", "3"},  {"\u207b\u00b9", "-1"},
      {"^", ""},       {"\u00b7", " "}, {"\u22c5", " "},        {"*", " "},       {"\u00a0", " "},
      {"\u202f", " "}, {"\u2009", " "}, {"\u2032\u2032", "in"}, {"\u2033", "in"}, {"\"", "in"},
      {"\u2103", "C"}, {"\u2109", "F"}};
  std::string unit(trim(written));
  for (const auto& [from, to] : signs) replace_all(unit, from, to);
  if (unit == "\u00b0" || unit == "\u00ba") return "deg";
  replace_all(unit, "\u00b0 ", "");
  replace_all(unit, "\u00b0", unit.starts_with("\u00b0/") ? "deg" : "");
  for (const Unit& u : pressure_units())
    for (const auto& [word, shorts] :
         {std::pair{gauge, std::array<std::string_view, 5>{"g", " g", "(g)", " (g)", "_g"}},
          std::pair{absolute, std::array<std::string_view, 5>{"a", " a", "(a)", " (a)", "_a"}}})
      for (const std::string_view end : shorts)
        if (unit == std::string(u.name).append(end)) return fmt::format("{} {}", u.name, word);
  for (const auto& [from, to] : {std::pair{" abs", absolute},
                                 {" (abs)", absolute},
                                 {"(abs)", absolute},
                                 {" abs.", absolute},
                                 {" (gauge)", gauge},
                                 {"(gauge)", gauge},
                                 {" (absolute)", absolute}})
    if (unit.ends_with(from) && unit.size() > std::string_view(from).size())
      return fmt::format("{} {}", trim(unit.substr(0, unit.size() - std::string_view(from).size())), to);
  return std::string(trim(unit));
}

/// Takes the word "gauge" or "absolute" off the end of a unit.
std::string_view take_reference(std::string_view& unit) {
  for (std::string_view word : {gauge, absolute})
    if (unit.ends_with(word) && unit.size() > word.size() && unit[unit.size() - word.size() - 1] == ' ') {
      unit = trim(unit.substr(0, unit.size() - word.size()));
      return word;
    }
  return {};
}

const Unit* find_unit(std::string_view name, Dimension d) {
  for (const Unit& u : entry(d).units)
    if (u.name == name) return &u;
  return nullptr;
}

double apply(const Unit& u, double value) { return value * u.times / u.over + u.offset; }

/// Splits "8 ms" or "8ms" after the longest number it starts with.
std::pair<std::optional<double>, std::string_view> split(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {std::nullopt, text};
  return {value, trim(text.substr(static_cast<std::size_t>(end - text.data())))};
}

}  // namespace

std::string_view si_unit(Dimension d) { return entry(d).units.empty() ? "" : entry(d).units.front().name; }

std::vector<std::string> known_units(Dimension d) {
  std::vector<std::string> names;
  for (const Unit& u : entry(d).units) {
    if (!is_referred(d)) names.emplace_back(u.name);
    else
      for (std::string_view word : {gauge, absolute}) names.push_back(fmt::format("{} {}", u.name, word));
  }
  return names;
}

std::string unit_words(Dimension d) {
  std::vector<std::string> names;
  for (const Unit& u : entry(d).units) names.emplace_back(u.name);
  return joined(names) + (is_referred(d) ? ", each gauge or absolute" : "");
}

Magnitudes magnitudes(Dimension d) { return entry(d).magnitudes; }

std::string_view describe(Dimension d) { return entry(d).words; }
std::string_view example(Dimension d) { return entry(d).example; }

std::optional<double> to_si(double value, std::string_view written, Dimension d) {
  const std::string plain = plain_unit(written);
  std::string_view unit = plain;
  if (is_referred(d) && take_reference(unit) != (d == Dimension::pressure_gauge ? gauge : absolute))
    return std::nullopt;
  const Unit* u = find_unit(unit, d);
  if (!u) return std::nullopt;
  return apply(*u, value);
}

std::string with_decimal_point(std::string_view text) {
  const auto digit = [&](std::size_t n) { return n < text.size() && text[n] >= '0' && text[n] <= '9'; };
  const auto comma = text.find(',');
  if (comma == std::string_view::npos || comma == 0 || !digit(comma - 1) || !digit(comma + 1) ||
      text.find(',', comma + 1) != std::string_view::npos)
    return "";
  // "1,500" may be a thousand and a half as well: that is not for us to say. "0,500" is not.
  const bool thousands = digit(comma + 2) && digit(comma + 3) && !digit(comma + 4);
  const bool from_zero = text[comma - 1] == '0' && (comma < 2 || !digit(comma - 2));
  if (thousands && !from_zero) return "";
  std::string point(text);
  point[comma] = '.';
  return point;
}

double parse_quantity(std::string_view text, Dimension d, double ambient) {
  const auto [value, rest] = split(text);
  if (!value) throw InputError(fmt::format("\"{}\" does not start with a finite number", text));
  if (rest.empty())
    throw InputError(fmt::format("\"{}\" has no unit (known units: {})", text, unit_words(d)));
  if (rest.starts_with(','))
    throw InputError(fmt::format(
        "\"{}\" has a comma in its number; a number has a decimal point{} and no sign "
        "between thousands",
        text, with_decimal_point(text).empty() ? "" : fmt::format(" (\"{}\")", with_decimal_point(text))));
  const std::string plain = plain_unit(rest);
  std::string_view unit = plain;
  const std::string_view reference = take_reference(unit);
  const Unit* u = find_unit(unit, d);
  if (!u) {
    const std::string close = nearest(plain, known_units(d));
    throw InputError(fmt::format("unknown unit \"{}\"{} (known units: {})", rest,
                                 close.empty() ? "" : fmt::format(", nearest is \"{}\"", close),
                                 unit_words(d)));
  }
  const double si = apply(*u, *value);
  if (!std::isfinite(si)) throw InputError(fmt::format("\"{}\" is too large", text));
  if (!is_referred(d)) {
    if (!reference.empty())
      throw InputError(fmt::format("\"{}\": a modulus or difference is neither gauge nor absolute", text));
    return si;
  }
  if (reference.empty())
    throw InputError(
        fmt::format("\"{0}\" does not say gauge or absolute: \"{0} gauge\" or \"{0} absolute\"", trim(text)));
  if (d == Dimension::pressure_gauge) return reference == gauge ? si : si - ambient;
  return reference == absolute ? si : si + ambient;
}

std::string format_quantity(double si, Dimension d) {
  if (entry(d).units.empty()) return fmt::format("{}", si);
  const std::string_view word = d == Dimension::pressure_gauge      ? " gauge"
                                : d == Dimension::pressure_absolute ? " absolute"
                                                                    : "";
  std::string best = fmt::format("{} {}{}", si, si_unit(d), word);
  for (const Unit& u : entry(d).units) {
    if (!u.shown) continue;
    const double value = (si - u.offset) / u.times * u.over;
    const std::string text = fmt::format("{:.12g} {}{}", value, u.name, word);
    const bool readable = std::abs(value) >= 0.1 && std::abs(value) < 1e4;
    if (readable && text.size() <= best.size() && parse_quantity(text, d) == si) best = text;
  }
  return best;
}

std::optional<double> parse_number(std::string_view text) {
  const auto [value, rest] = split(text);
  return rest.empty() ? value : std::nullopt;
}

}  // namespace ejecta
