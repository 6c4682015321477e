#include "case/schema.hpp"
#include "case/size_law.hpp"

/// A whole sorter: feed, camera, controller, manifold.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(SorterSpec& s) {
  return {{.name = "throughput",
           .slot = &s.throughput,
           .dimension = mass_flow,
           .bounds = positive,
           .help = "Mass that the belt brings",
           .unset = "needed",
           .example = "\"10 t/h\""},
          {"particles",
           &s.particles,
           none,
           {1, 1e9},
           "How many pass, about: whole lengths of belt are computed",
           ""},
          decisive(Key{"belt_width", &s.belt_width, length, positive, "Width of the belt", "paper 2.1"}),
          {"seed", &s.seed, none, not_negative, "Another number gives another feed", ""},
          {"shown", &s.shown, none, {0, 5000}, "Particles that the report shows moving", ""},
          {"encounters", &s.encounters, none, anything,
           "In the air particles push each other and take each other's air; not where they may lie in each "
           "other (presentation = \"independent\")",
           ""}};
}

std::vector<Key> keys(FeedSpec& s) {
  return {
      decisive(Key{"presentation", choice(s.presentation), none, anything,
                   "How particles are laid on the belt",
                   "assumption: the paper stabilises the feed in a monolayer"}),
      decisive(Key{"arrival_scatter", &s.arrival_scatter, time, not_negative,
                   "Standard deviation of a particle's time at the jet: slip and roll since the camera",
                   "assumption: not in the paper"}),
      decisive(Key{"place_scatter", &s.place_scatter, length, not_negative,
                   "The same of its place across the belt", "assumption: not in the paper"}),
      {.name = "file",
       .slot = &s.file,
       .help = "CSV file with the columns x [m], y [m] (along, and across from the middle), kind (number of "
               "the class, from 0), size [mm] and yaw [deg]; x does not fall",
       .unset = "none",
       .example = "\"log.csv\"",
       .file = true},
      decisive(Key{"lip_speed", &s.lip_speed, velocity, positive,
                   "Feeder: speed of the particles on its tray, along the belt",
                   "assumption: the paper does not describe its feeder"}),
      decisive(Key{"lip_height", &s.lip_height, length, positive, "Feeder: its tray above the belt",
                   "assumption: the paper does not describe its feeder"}),
      decisive(Key{"lip_distance", &s.lip_distance, length, positive,
                   "Feeder: along the belt from its lip to the camera's line",
                   "assumption: the paper does not give the length of its belt"})};
}

std::vector<Key> keys(ParticleClassSpec& s) {
  std::vector<Key> list{
      {.name = "name", .slot = &s.name, .help = "Name", .required = true, .example = "\"ore\""},
      {.name = "share",
       .slot = &s.share,
       .bounds = fraction,
       .help = "Of the mass of the feed; those of all classes add up to 1",
       .required = true,
       .example = "0.3"},
      {"eject", &s.eject, none, anything, "It belongs in the ejected product", ""},
      decisive(Key{"density", &s.density, density, positive, "Density", "paper, Table 2"}),
      {"form", choice(s.form), none, anything, "What its particles look like", ""}};
  append_size_keys(list, s, "The middle one of a particle's three dimensions, what a sieve tells",
                   {"\"10 mm\"", "\"20 mm\""});
  list.insert(
      list.end(),
      {{"elongation", &s.elongation, none, {0.1, 1.0}, "Middle over longest dimension", "Zingg 1935"},
       {"flatness", &s.flatness, none, {0.05, 1.0}, "Shortest over middle dimension", "Zingg 1935"},
       {.name = "file",
        .slot = &s.file,
        .help = "STL of a particle, for the form \"mesh\"",
        .unset = "none",
        .example = "\"rock.stl\"",
        .file = true},
       {"signal", &s.signal, none, anything, "What the sensors read of it, on a scale of one's own", ""},
       {"signal_spread", &s.signal_spread, none, not_negative,
        "Standard deviation of that from particle to particle", ""},
       {.name = "read_as_eject",
        .slot = &s.read_as_eject,
        .bounds = fraction,
        .help = "Share of its particles that is read as to be ejected: a given confusion instead of signals",
        .unset = "by signals",
        .example = "0.02"}});
  return list;
}

std::vector<Key> keys(CameraSpec& s) {
  return {
      {"pixels", &s.pixels, none, {16, 100000}, "Pixels across the belt", "paper 2.1"},
      decisive(Key{"gap", &s.gap, length, not_negative,
                   "Particles nearer to each other are seen as one object", "assumption: about two pixels"}),
      {"least_pixels", &s.least_pixels, none, {1, 1000000}, "Smaller objects are not seen", ""},
      {"noise", &s.noise, none, not_negative, "Of the signal of one pixel, standard deviation", ""},
      {.name = "threshold",
       .slot = &s.threshold,
       .help = "Signal between what is kept and what is ejected",
       .unset = "midway between the mean signals of the two",
       .example = "0.5"},
      decisive(Key{"distance", &s.distance, length, positive,
                   "Along the way from the camera's line to the jets", "assumption: not in the paper"}),
      decisive(Key{"computing_time", &s.computing_time, time, not_negative,
                   "From the last line of an object to its commands", "assumption: not in the paper"})};
}

std::vector<Key> keys(ControllerSpec& s) {
  return {{"window", choice(s.window), none, anything, "How long a command lasts", ""},
          {"duration", &s.duration, time, positive, "Of every command, by the \"fixed\" rule",
           "paper: 8 ms blasts"},
          {"step", &s.step, time, not_negative, "Commands begin at whole steps; 0: at any time",
           "paper 3.2: 1 ms"},
          decisive(Key{
              "lead", &s.lead, time, not_negative,
              "The command comes before the object's centre (\"by-size\": before its front) is over the jet: "
              "what the valve and the air need",
              "assumption: the opening of the paper's valve, Fig. 9"}),
          {"quantile", &s.quantile, none, not_negative,
           "How many standard errors of time and place a shot covers", "Reith-Braun et al. 2024"},
          {"time_error", &s.time_error, time, not_negative,
           "Standard error of the time that a window \"by-size\" reckons with", ""},
          {"place_error", &s.place_error, length, not_negative, "Standard error of the place across the belt",
           ""},
          {.name = "valves",
           .slot = &s.valves,
           .bounds = {0, 1000},
           .help = "Valves of every shot",
           .unset = "as many as the object is wide",
           .example = "1"},
          {"shortest_on", &s.shortest_on, time, not_negative, "Shortest command", ""},
          {"shortest_off", &s.shortest_off, time, not_negative,
           "Breaks between commands that are shorter are not taken", ""}};
}

std::vector<Key> keys(ManifoldSpec& s) {
  return {{"valves", &s.valves, none, {1, 10000}, "Valves across the belt", "paper 2.1"},
          {.name = "pitch",
           .slot = &s.pitch,
           .dimension = length,
           .bounds = positive,
           .help = "From one valve to the next",
           .unset = "the belt's width over the valves",
           .example = "\"4.3 mm\""},
          {"dead", &s.dead, none, fraction, "Share of the valves that do not open, drawn by the seed", ""},
          {.name = "dead_valves",
           .slot = &s.dead_valves,
           .bounds = not_negative,
           .help = "Valves that do not open, counted from 0 at y = -width/2",
           .unset = "none",
           .example = "[12, 13]"},
          {"delay_spread", &s.delay_spread, time, not_negative,
           "Standard deviation of the delay from valve to valve", ""},
          {.name = "vessel",
           .slot = &s.vessel,
           .dimension = volume,
           .bounds = not_negative,
           .help = "Vessel that all valves draw from",
           .unset = "the supply never falls",
           .example = "\"20 L\""},
          {.name = "line_diameter",
           .slot = &s.line_diameter,
           .dimension = length,
           .bounds = not_negative,
           .help = "Effective diameter of the line that feeds the vessel at valve.supply_pressure",
           .unset = "needed with `vessel`",
           .example = "\"10 mm\""}};
}

}  // namespace ejecta
