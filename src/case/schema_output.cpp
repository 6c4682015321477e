#include "case/schema.hpp"

/// What is recorded and what it is compared with.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(StreamSpec& s) {
  return {{"velocity", &s.velocity, velocity, anything, "Free stream that drag coefficients refer to", ""},
          {"reference_area", &s.reference_area, area, not_negative, "Area that drag coefficients refer to",
           "", "projected area of the body"},
          {"average_from", &s.average_from, time, not_negative, "Mean forces are taken from here to the end",
           ""}};
}

std::vector<Key> keys(ProbeSpec& s) {
  return {{.name = "name",
           .slot = &s.name,
           .help = "Name of the file in history/",
           .required = true,
           .example = "\"at-75mm\""},
          {.name = "position",
           .slot = &s.position,
           .dimension = length,
           .help = "Where it stands",
           .required = true,
           .example = R"(["0 mm", "0 mm", "75 mm"])"},
          {"diameter", &s.diameter, length, not_negative, "Disc it averages over",
           "transducer of the paper: 2 mm"},
          {"response_time", &s.response_time, time, not_negative, "First-order lag",
           "transducer of the paper: below 1 ms"}};
}

std::vector<Key> keys(LineSpec& s) {
  return {{.name = "name",
           .slot = &s.name,
           .help = "Name of the file in history/",
           .required = true,
           .example = "\"axis\""},
          {.name = "from",
           .slot = &s.from,
           .dimension = length,
           .help = "One end",
           .required = true,
           .example = R"(["0 m", "0 m", "40 mm"])"},
          {.name = "to",
           .slot = &s.to,
           .dimension = length,
           .help = "The other end",
           .required = true,
           .example = R"(["0 m", "0 m", "120 mm"])"},
          {"points", &s.points, none, {2, 100000}, "Points along it", ""}};
}

namespace {
const std::vector<Word> axis_words{
    {"x", "across x"}, {"y", "across y: side view"}, {"z", "across z: seen from above"}};
}

std::vector<Key> keys(SliceSpec& s) {
  return {{.name = "name",
           .slot = &s.name,
           .help = "Name of the series in fields/",
           .required = true,
           .example = "\"side\""},
          {"axis",
           Choice{&axis_words, [&s] { return static_cast<std::size_t>(s.axis); },
                  [&s](std::size_t i) { s.axis = static_cast<int>(i); }},
           none, anything, "Axis the plane is normal to", ""},
          {"position", &s.position, length, anything, "Where the plane cuts that axis", ""}};
}

std::vector<Key> keys(MeasuredSpec& s) {
  return {{.name = "of",
           .slot = &s.of,
           .help = "What was measured: \"centreline\", or the name of a line or a probe of a jet",
           .required = true,
           .example = "\"centreline\""},
          {.name = "file",
           .slot = &s.file,
           .help = "CSV with two columns and their units: position (m, mm) or time (s, ms), total gauge "
                   "pressure (Pa, kPa)",
           .required = true,
           .example = "\"pitot.csv\"",
           .file = true}};
}

std::vector<Key> keys(OutputSpec& s) {
  return {
      {"fields_interval", &s.fields_interval, time, not_negative, "Between whole fields (.vtr); 0: none", ""},
      {"history_interval", &s.history_interval, time, not_negative,
       "Between rows of history/*.csv; 0: every step", ""},
      {"slices_interval", &s.slices_interval, time, not_negative, "Between slices and between lines; 0: none",
       ""},
      {"report", &s.report, none, anything, "Write report.html", ""},
      {.name = "fields",
       .slot = &s.fields,
       .help =
           "Fields in fields/*.vtr: of velocity, pressure, density, k, epsilon, omega, eddy_viscosity those "
           "the flow has",
       .unset = "all",
       .example = R"(["velocity", "pressure"])"}};
}

std::vector<Key> keys(CheckpointSpec& s) {
  return {
      {"every_steps", &s.every_steps, none, not_negative, "Steps between checkpoints; 0: none", ""},
      {"every_time", &s.every_time, time, not_negative, "Simulated time between checkpoints; 0: none", ""},
      {"every_wall_time", &s.every_wall_time, time, not_negative, "Wall time between checkpoints; 0: none",
       ""}};
}

std::vector<Key> keys(ExactSpec& s, Dimension pressure) {
  return {
      {.name = "velocity",
       .slot = Formulas{.optional = &s.velocity},
       .dimension = velocity,
       .help = "Exact velocity; result.json then has error norms",
       .unset = "none",
       .example = R"x(["= -cos(x) * sin(y) * exp(-2 * t)", "= sin(x) * cos(y) * exp(-2 * t)", "0 m/s"])x"},
      {.name = "pressure",
       .slot = Formula{.optional = &s.pressure},
       .dimension = pressure,
       .help = "Exact pressure (gauge in incompressible flow, else absolute)",
       .unset = "none",
       .example = "\"= -0.25 * (cos(2 * x) + cos(2 * y)) * exp(-4 * t)\""},
      {.name = "k",
       .slot = Formula{.optional = &s.k},
       .dimension = specific_energy,
       .help = "Exact turbulent kinetic energy",
       .unset = "none",
       .example = "\"= (1 + 1.84 * t)^(-1.087)\""},
      {.name = "density",
       .slot = Formula{.optional = &s.density},
       .dimension = density,
       .help = "Exact density",
       .unset = "none",
       .example = "\"= 1 + 0.2 * sin(x - t)\""},
      {.name = "source",
       .slot = Formulas{.text = &s.source},
       .dimension = acceleration,
       .help = "Manufactured source of momentum",
       .example = R"x(["= sin(x)", "0 m/s2", "0 m/s2"])x"}};
}

std::vector<Key> keys(ExpectSpec& s) {
  return {{.name = "quantity",
           .slot = &s.quantity,
           .help = "JSON pointer into result.json (SI units)",
           .required = true,
           .example = "\"/bodies/0/drag_coefficient\""},
          {"reference", &s.reference, none, anything, "Reference value", ""},
          {"tolerance", &s.tolerance, none, not_negative, "Largest absolute difference", "", "none"},
          {"relative_tolerance", &s.relative_tolerance, none, not_negative, "Largest relative difference", "",
           "none"},
          {"at_least", &s.at_least, none, anything, "Lower limit", "", "none"},
          {"at_most", &s.at_most, none, anything, "Upper limit", "", "none"},
          {"converging", &s.converging, none, anything,
           "With [convergence]: from grid to grid the value must change less", ""},
          {.name = "text",
           .slot = &s.text,
           .help = "Expected words, e.g. an outcome, instead of a number",
           .unset = "none",
           .example = "\"ejected\""},
          {.name = "source",
           .slot = &s.source,
           .help = "Where the reference comes from",
           .unset = "none",
           .example = "\"Ghia et al. 1982\""}};
}

std::vector<Key> keys(ConvergenceSpec& s) {
  return {
      {.name = "factors",
       .slot = &s.factors,
       .bounds = positive,
       .help = "`ejecta validate` repeats the case with the cells times each of these; result.json gets "
               "observed orders",
       .unset = "none",
       .example = "[1, 2, 4]"},
      {"scale_time_step", &s.scale_time_step, none, anything, "Divide time_step by the same factors", ""}};
}

}  // namespace ejecta
