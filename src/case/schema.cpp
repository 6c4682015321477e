#include "case/schema.hpp"

#include <set>

namespace ejecta {
namespace {

template <class Spec>
Section table(std::string name, std::string help, Spec& spec, bool* enabled = nullptr) {
  return {.name = std::move(name),
          .help = std::move(help),
          .repeated = false,
          .count = [] { return std::size_t{1}; },
          .append = {},
          .keys = [&spec](std::size_t) { return keys(spec); },
          .enabled = enabled};
}

template <class Spec, class... More>
Section list(std::string name, std::string help, std::vector<Spec>& specs, More... more) {
  return {.name = std::move(name),
          .help = std::move(help),
          .repeated = true,
          .count = [&specs] { return specs.size(); },
          .append = [&specs] { specs.emplace_back(); },
          .keys = [&specs, more...](std::size_t n) { return keys(specs.at(n), more()...); }};
}

}  // namespace

bool changes_no_result(const std::string& section) {
  static const std::set<std::string> names{"study",  "map",        "expect", "convergence",
                                           "output", "checkpoint", "exact",  "measured"};
  return names.contains(section);
}

std::vector<Section> sections(Case& c) {
  // Read when the keys are asked for: by then the solver is known.
  const auto pressure = [&c] {
    return c.flow.solver == FlowSolver::incompressible ? Dimension::pressure_gauge
                                                       : Dimension::pressure_absolute;
  };
  std::vector<Section> all{table("run", "How long and how finely in time", c.run),
                           table("environment", "The still surroundings", c.environment),
                           table("fluid", "What the fluid is; air by default", c.fluid),
                           table("flow", "How the fluid is computed", c.flow),
                           table("grid", "The box that is computed", c.grid)};
  for (std::size_t a = 0; a < 3; ++a)
    all.push_back(table(std::string("grid.") + axis_names[a], std::string("Cells along ") + axis_names[a],
                        c.grid.axis[a]));
  for (std::size_t f = 0; f < 6; ++f) {
    const std::string name = std::string("boundary.") + face_names[f];
    BoundarySpec& face = c.boundary[f];
    Section section = table(name, std::string("The face of the box at ") + face_names[f], c.run);
    section.keys = [&face, pressure](std::size_t) { return keys(face, pressure()); };
    all.push_back(section);
    all.push_back(
        list(name + ".patch", "A disc on that face with a type of its own", face.patches, pressure));
  }
  Section exact = table("exact", "Exact solution, for error norms", c.run);
  exact.keys = [&c, pressure](std::size_t) { return keys(c.exact, pressure()); };

  for (Section& s : std::vector<Section>{
           list("initial", "State at the start, region by region; later ones win", c.initial, pressure),
           table("valve", "The valve and its nozzle", c.valve),
           table("jet", "The jet that enters through a boundary of type \"jet\"", c.jet),
           list("material", "Solid materials", c.materials),
           list("material_pair", "Overrides for the contact of two materials", c.material_pairs),
           table("contact", "How bodies touch", c.contact),
           list("body", "Bodies", c.bodies),
           list("grains", "Many spheres far smaller than a cell, that the fluid drags along", c.grains),
           table("coupling", "How grains and fluid act on each other", c.coupling),
           table("domain", "Where bodies live: they go when they leave it", c.domain),
           table("launch", "Flight from the belt to the jet", c.launch, &c.launch.enabled),
           list("wall", "Walls that bodies meet", c.walls),
           table("splitter", "The dividing plate", c.splitter, &c.splitter.enabled),
           table("stream", "Free stream for drag coefficients", c.stream, &c.stream.enabled),
           list("probe", "Points recorded in history/", c.probes),
           list("line", "Lines recorded in history/", c.lines),
           list("slice", "Planes recorded in fields/", c.slices),
           list("measured", "Measurements that `ejecta jet` compares with", c.measured),
           table("output", "What is written, and how often", c.output),
           table("checkpoint", "When the state is saved for --resume", c.checkpoint),
           exact,
           list("expect", "What `ejecta validate` compares with result.json", c.expects),
           table("convergence", "Repetition on finer grids", c.convergence),
           table("study", "Many runs that differ in some keys: `ejecta study`", c.study, &c.study.enabled),
           list("study.vary", "A key that the study varies", c.study.vary),
           table("map", "The places around the jet from which a body is ejected: `ejecta map`", c.map,
                 &c.map.enabled),
           table("campaign", "A programme of runs with one report: `ejecta campaign`", c.campaign,
                 &c.campaign.enabled),
           list("campaign.part", "One command of the programme", c.campaign.parts),
           table("sorter", "A whole sorter, feed to products: `ejecta sort`", c.sorter, &c.sorter.enabled),
           table("sorter.feed", "How particles lie on the belt", c.feed, &c.sorter.enabled),
           list("sorter.class", "Particles of one kind", c.classes),
           table("sorter.camera", "What looks at the belt, and what it makes of it", c.camera,
                 &c.sorter.enabled),
           table("sorter.controller", "When and how long valves are told to open", c.controller,
                 &c.sorter.enabled),
           table("sorter.manifold", "The row of valves across the belt", c.manifold, &c.sorter.enabled)})
    all.push_back(std::move(s));
  return all;
}

}  // namespace ejecta
