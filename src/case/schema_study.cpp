#include "case/schema.hpp"

/// Many runs of one case.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(StudySpec& s) {
  return {{"design", choice(s.design), none, anything, "How the values of the keys are put together", ""},
          {.name = "samples",
           .slot = &s.samples,
           .bounds = {0, 1000000},
           .help = "Runs of a \"latin-hypercube\" or \"sobol\" design",
           .unset = "needed for these",
           .example = "32"},
          {"seed", &s.seed, none, not_negative, "Another number gives other samples", ""},
          {.name = "quantities",
           .slot = &s.quantities,
           .help = "JSON pointers into result.json of a run: the columns of the table of results (SI units)",
           .unset = "outcome, clearance and gain of velocity of the first body; of a sorter recovery, "
                    "purity, loss and air",
           .example = R"(["/outcome", "/bodies/0/velocity_change_z_m_s"])"},
          {"keep_runs", &s.keep_runs, none, anything,
           "Keep the directory of each run, with its report; else only its result.json", ""}};
}

std::vector<Key> keys(VarySpec& s) {
  return {
      {.name = "key",
       .slot = &s.key,
       .help = "Key of the case file, as for --set",
       .required = true,
       .example = "\"valve.supply_pressure\""},
      {.name = "values",
       .slot = &s.values,
       .help = "Its values, for \"grid\" and \"list\"",
       .unset = "from `from`, `to` and `steps`",
       .example = R"(["400 kPa gauge", "700 kPa gauge"])"},
      {.name = "from",
       .slot = &s.from,
       .help = "One end of its range; of a key with numbers",
       .unset = "none",
       .example = "\"400 kPa gauge\""},
      {.name = "to", .slot = &s.to, .help = "The other end", .unset = "none", .example = "\"900 kPa gauge\""},
      {.name = "steps",
       .slot = &s.steps,
       .bounds = {0, 1000000},
       .help = "Values of the range in a \"grid\" or \"list\", evenly spaced with both ends",
       .unset = "needed for a range there",
       .example = "6"}};
}

std::vector<Key> keys(MapSpec& s) {
  return {
      {.name = "body",
       .slot = &s.body,
       .help = "Name of the body that is mapped",
       .unset = "the first on the belt",
       .example = "\"particle\""},
      {.name = "along",
       .slot = &s.along,
       .dimension = length,
       .help = "Window along the belt: where, relative to the jet's axis, the body would be at "
               "launch.arrives_at if no air blew",
       .unset = "needed",
       .example = R"(["-30 mm", "20 mm"])"},
      {.name = "across",
       .slot = &s.across,
       .dimension = length,
       .help = "Window across the belt, relative to the jet's axis",
       .unset = "needed",
       .example = R"(["-18 mm", "18 mm"])"},
      {.name = "symmetric",
       .slot = &s.symmetric,
       .help = "The map is even in y: runs only at y >= 0. Claimed of a case that is not, it is refused",
       .unset = "where body, jet and walls are",
       .example = "true"},
      {.name = "grid",
       .slot = &s.grid,
       .dimension = length,
       .bounds = not_negative,
       .help = "Steps along and across of a regular grid around the jet's axis: a fine run at each of its "
               "places in the window, the margin linear between them, nothing chosen; as many as max_runs at "
               "most",
       .source = "the paper: 3 mm, 0.5 mm",
       .unset = "places are chosen where they tell most",
       .example = R"(["3 mm", "2.5 mm"])"},
      {"coarse_refinement",
       &s.coarse_refinement,
       none,
       {0.1, 1.0},
       "grid.refinement of the coarse runs, which find the shape, over that of the fine ones, which correct "
       "the edge; 1: only fine runs",
       "Kennedy & O'Hagan 2000"},
      {"max_runs", &s.max_runs, none, {5, 10000}, "Runs at most, coarse and fine together", ""},
      {"max_fine_runs",
       &s.max_fine_runs,
       none,
       {5, 10000},
       "Fine runs at most, where there are coarse ones",
       ""},
      {"runs_at_once",
       &s.runs_at_once,
       none,
       {1, 10000},
       "Runs that are decided upon together. The map depends on it, but not on how many cores run them",
       ""},
      {"area_error",
       &s.area_error,
       none,
       {0.0, 1.0},
       "Stated error of the area at which the map is finished",
       ""},
      {"plate_error", &s.plate_error, length, not_negative,
       "Along x and z: the plate's edge is known to within this, and the map is averaged over it",
       "assumption: the paper averages, and does not say over what"},
      {"lying", choice(s.lying), none, anything,
       "How the bodies of the class lie that is mapped. Of a class the map is the chance of ejection", ""},
      {"size_factor",
       &s.size_factor,
       none,
       {0.01, 100.0},
       "Sizes of the class over the body's, evenly distributed between these two",
       ""},
      {"arrival_error", &s.arrival_error, length, not_negative,
       "Along and across: standard deviation (normal) of where a body comes beside where it was expected",
       ""},
      {"seed", &s.seed, none, not_negative, "Of the random draws behind the errors, and of a class", ""},
      {.name = "measured",
       .slot = &s.measured,
       .help = "CSV of a measured outline, x and y with their units: drawn into the map, with the ratio of "
               "areas",
       .unset = "none",
       .example = "\"outline.csv\"",
       .file = true}};
}

std::vector<Key> keys(CampaignSpec& s) {
  return {{.name = "title",
           .slot = &s.title,
           .help = "Title of the report",
           .unset = "the name of the file",
           .example = "\"Four particles, three maps\""}};
}

std::vector<Key> keys(CampaignPartSpec& s) {
  return {{"kind", choice(s.kind), none, anything, "What is done with the case", ""},
          {.name = "case",
           .slot = &s.file,
           .help = "Case file (.toml)",
           .required = true,
           .example = "\"10mm-cubic.toml\"",
           .file = true},
          {.name = "title",
           .slot = &s.title,
           .help = "Heading of the part",
           .unset = "the title of the case",
           .example = "\"20 mm flat particle\""},
          {.name = "figures",
           .slot = &s.figures,
           .help = "What the part remakes, for its heading",
           .unset = "nothing",
           .example = "\"Figure 10\""},
          {.name = "set",
           .slot = &s.set,
           .help = "Keys of the case that are changed, as for --set",
           .unset = "none",
           .example = R"(["valve.supply_pressure=600 kPa gauge"])"}};
}

}  // namespace ejecta
