#include "case/schema.hpp"

/// What the machine does: valve, jet, launch, splitter.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(ValveSpec& s) {
  return {
      decisive(Key{"supply_pressure", &s.supply_pressure, pressure_absolute, positive,
                   "Pressure upstream of the nozzle", "paper 2.1: 700 kPa gauge", "", false,
                   "\"700 kPa gauge\""}),
      {"supply_temperature", &s.supply_temperature, temperature, not_negative,
       "Temperature upstream of the nozzle", "", "ambient"},
      decisive(Key{"orifice_diameter", &s.orifice_diameter, length, positive,
                   "Effective diameter of the orifice",
                   "assumption: not in the paper; 880 m/s, Mach 0.35 at 75 mm imply 1.55 to 1.9 mm"}),
      decisive(Key{"discharge_coefficient",
                   &s.discharge_coefficient,
                   none,
                   {0.0, 1.0, true},
                   "Mass flow relative to the ideal choked nozzle",
                   "assumption: ideal"}),
      {"opens_at", &s.opens_at, time, not_negative, "Time of the command to open", ""},
      decisive(
          Key{"duration", &s.duration, time, not_negative, "Length of the command", "paper: 8 ms blasts"}),
      {"delay", &s.delay, time, not_negative, "From the command to the first movement", ""},
      decisive(Key{"rise_time", &s.rise_time, time, not_negative, "From closed to fully open",
                   "paper, Fig. 9: maximum after 6 to 7 ms"}),
      decisive(Key{"fall_time", &s.fall_time, time, not_negative, "From fully open to closed", "assumption"}),
      {"shape", choice(s.shape), none, anything, "How the opening changes during rise and fall", ""},
      {.name = "trace",
       .slot = &s.trace,
       .help = "CSV file with the columns time [s] and opening [1] (0 to 1), for shape \"trace\"",
       .unset = "none",
       .example = "\"opening.csv\"",
       .file = true},
      {.name = "more_pulses",
       .slot = &s.more_pulses,
       .dimension = time,
       .bounds = not_negative,
       .help = "Further times at which the same command is given",
       .unset = "none",
       .example = R"(["20 ms", "40 ms"])"}};
}

std::vector<Key> keys(JetSpec& s) {
  return {
      {"kind", choice(s.kind), none, anything,
       "Where the jet that enters through a \"jet\" boundary comes from", ""},
      {"nozzle", &s.nozzle, length, anything, "Centre of the orifice", ""},
      {"direction", &s.direction, none, anything,
       "Along which the jet blows: into the box, up to 60 degrees aslant", ""},
      {.name = "more_nozzles",
       .slot = &s.more_nozzles,
       .dimension = length,
       .help = "Further orifices that blow with the same valve; where jets meet, their momentum adds up",
       .source = "Reichardt 1942",
       .unset = "none",
       .example = R"([["0 mm", "10 mm", "0 mm"]])"},
      {"velocity_decay", &s.velocity_decay, none, not_negative, "B in U_c/U_0 = B d/(z - z0)",
       "measured: 5.8 to 6.1 (Hussein et al. 1994, Panchapakesan & Lumley 1993)",
       "what keeps the momentum of the valve: 5.93 for the default spreading", false, "5.9"},
      decisive(Key{"spreading", &s.spreading, none, positive, "S = r_half/(z - z0)", "Hussein et al. 1994"}),
      decisive(
          Key{"virtual_origin", &s.virtual_origin, none, anything, "z0/d", "Panchapakesan & Lumley 1993"}),
      {"inlet_velocity", &s.inlet_velocity, velocity, not_negative,
       "Uniform exit velocity, for \"velocity-inlet\"", "", "momentum-equivalent of the choked nozzle", false,
       "\"880 m/s\""},
      {"turbulence_intensity", &s.turbulence_intensity, none, fraction, "Of a \"velocity-inlet\"",
       "usual for a short nozzle"},
      {.name = "source_case",
       .slot = &s.source_case,
       .help = "Case that computes the jet, for \"computed\"",
       .unset = "none",
       .example = "\"jet.toml\"",
       .file = true},
      {"compare_incompressible", &s.compare_incompressible, none, anything,
       "`ejecta jet` also computes the incompressible jet of the momentum-equivalent velocity",
       "paper, Figure 7"},
      {"far_field_from", &s.far_field_from, length, not_negative,
       "Height from which `ejecta jet` fits decay and spreading, up to nine tenths of the box", "",
       "25 orifices", false, "\"200 mm\""},
      {.name = "sweep_pressures",
       .slot = &s.sweep_pressures,
       .dimension = pressure_absolute,
       .bounds = positive,
       .help = "Supplies that `ejecta jet --sweep` computes, compressible",
       .source = "paper 3.1: 400 to 900 kPa",
       .unset = "none",
       .example = R"(["400 kPa gauge", "700 kPa gauge"])"},
      {.name = "sweep_velocities",
       .slot = &s.sweep_velocities,
       .dimension = velocity,
       .bounds = positive,
       .help = "Inlet velocities that `ejecta jet --sweep` computes, incompressible",
       .source = "paper 3.1: 600 to 900 m/s",
       .unset = "none",
       .example = R"(["600 m/s", "900 m/s"])"}};
}

std::vector<Key> keys(LaunchSpec& s) {
  return {
      decisive(Key{"belt_speed", &s.belt_speed, velocity, not_negative,
                   "Speed along +x with which the body leaves the belt", "paper 2.1"}),
      decisive(Key{"drop_distance", &s.drop_distance, length, not_negative,
                   "Horizontal distance flown from the end of the belt to the jet", "assumption"}),
      decisive(Key{"stand_off", &s.stand_off, length, anything,
                   "Height of the body's centre above the nozzle as it crosses the jet's axis", "paper 3.1"}),
      {"arrives_at", &s.arrives_at, time, not_negative, "When the undisturbed body crosses the jet's axis",
       ""},
      {"offset_along", &s.offset_along, length, anything,
       "Where along x the body is at arrives_at; positive: past the jet", "paper 3.2"},
      {"offset_across", &s.offset_across, length, anything, "Moves the path across the belt", "paper 3.2"}};
}

std::vector<Key> keys(SplitterSpec& s) {
  return {
      {.name = "edge",
       .slot = &s.edge,
       .dimension = length,
       .help = "Edge of a plate that is fixed to the machine: x and z from jet.nozzle, instead of "
               "`distance` and `height`; a centre that passes above it is ejected",
       .unset = "by distance and height",
       .example = R"(["250 mm", "60 mm"])"},
      decisive(Key{"distance", &s.distance, length, positive,
                   "From the jet's axis to the edge of the plate, along +x", "assumption: not in the paper"}),
      decisive(Key{
          "height", &s.height, length, anything,
          "Edge above the undisturbed path there, with which it moves: belt speed, drop and stand-off change "
          "the path. A centre that passes above it is ejected",
          "assumption: not in the paper"}),
      {"thickness", &s.thickness, length, positive, "Thickness of the plate", "assumption"},
      {"length", &s.length, length, positive, "Extent of the plate downstream", "assumption"},
      {"solid", &s.solid, none, {}, "Bodies hit the plate; else it is only the line that decides", ""},
      {.name = "material",
       .slot = &s.material,
       .help = "Material of the plate",
       .unset = "that of the first body",
       .example = "\"steel\""}};
}

}  // namespace ejecta
