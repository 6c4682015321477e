#include "case/schema.hpp"

/// What the air does: run, environment, fluid, flow, grid, boundaries, initial state.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(RunSpec& s) {
  return {{.name = "title",
           .slot = &s.title,
           .help = "What this run is, in a line",
           .unset = "none",
           .example = "\"10 mm cube over one jet\""},
          {"until", choice(s.until), none, anything, "What ends the run", ""},
          {.name = "end_time",
           .slot = &s.end_time,
           .dimension = time,
           .bounds = positive,
           .help = "Simulated time, or the limit to it",
           .required = true,
           .example = "\"20 ms\""},
          {"courant", &s.courant, none, positive, "Largest sum over the directions of |u| dt / h",
           "paper, Eq. 6 and 2.2.4.3: 1 to 1.5"},
          {"time_step", &s.time_step, time, positive,
           "Fixed flow step; otherwise it follows the Courant number", "", "adaptive", false, "\"10 us\""},
          {"time_step_max", &s.time_step_max, time, positive, "Upper limit of the flow step", "", "no limit",
           false, "\"0.1 ms\""}};
}

std::vector<Key> keys(EnvironmentSpec& s) {
  return {{"gravity", &s.gravity, acceleration, anything, "Acceleration of free fall", ""},
          {"pressure", &s.pressure, pressure_absolute, positive,
           "Ambient pressure; \"gauge\" is relative to it", "standard atmosphere"},
          {"temperature", &s.temperature, temperature, positive, "Ambient temperature", "25 C"}};
}

std::vector<Key> keys(FluidSpec& s) {
  return {
      {"ideal_gas", &s.ideal_gas, none, anything,
       "true: a gas, density from p/(R T); false: a liquid or gas of constant density", ""},
      {"density", &s.density, density, not_negative,
       "Density; of an ideal gas it follows from the environment", "", "p/(R T) of the environment"},
      {"viscosity", &s.viscosity, viscosity, not_negative, "Dynamic viscosity; 0 is inviscid", "air at 25 C"},
      {"gamma", &s.gamma, none, {1.0, 2.0, true}, "Ratio of specific heats", "air"},
      {"gas_constant", &s.gas_constant, specific_heat, positive, "Specific gas constant", "air"},
      {"prandtl", &s.prandtl, none, positive, "Prandtl number", "air"},
      {"prandtl_turbulent", &s.prandtl_turbulent, none, positive, "Turbulent Prandtl number",
       "usual value for jets and boundary layers"}};
}

std::vector<Key> keys(FlowSpec& s) {
  return {{"solver", choice(s.solver), none, anything, "How the fluid is computed", ""},
          decisive(Key{"turbulence", choice(s.turbulence), none, anything, "Turbulence model", ""}),
          {"round_jet_correction", &s.round_jet_correction, none, anything,
           "Vortex-stretching term that cures the round-jet anomaly of k-epsilon", "Pope 1978"},
          {"compressibility_correction", &s.compressibility_correction, none, anything,
           "Dilatation dissipation in compressible solvers", "Sarkar 1991"},
          {"corrections", &s.corrections, none, {2, 20}, "Pressure corrections a step", "Issa 1986"},
          {"body_force", &s.body_force, acceleration, anything,
           "Uniform acceleration of the fluid besides gravity (drives a channel)", ""}};
}

std::vector<Key> keys(GridSpec& s) {
  return {
      {"geometry", choice(s.geometry), none, anything, "Coordinates of the grid", ""},
      {.name = "refinement",
       .slot = &s.refinement,
       .bounds = {0.05, 20},
       .help =
           "Cells of each block times this number (directions of one cell stay): 2 for twice the resolution",
       .example = "2"}};
}

std::vector<Key> keys(AxisSpec& s) {
  return {{.name = "points",
           .slot = &s.points,
           .dimension = length,
           .help = "Ends of the blocks along this axis, ascending; one more than blocks",
           .unset = "needed with a flow",
           .example = R"(["-50 mm", "0 mm", "50 mm"])"},
          {.name = "cells",
           .slot = &s.cells,
           .bounds = {1, 100000},
           .help = "Cells of each block (a bare number for one block)",
           .unset = "needed with a flow",
           .example = "[40, 40]"},
          {.name = "grading",
           .slot = &s.grading,
           .bounds = {1e-3, 1e3},
           .help = "Last cell / first cell of each block, geometric in between",
           .unset = "1 everywhere",
           .example = "[0.25, 4]"}};
}

namespace {
void append_state(std::vector<Key>& list, StateSpec& s, Dimension pressure) {
  const std::string formula = "a formula in x, y, z, t in SI units starts with \"=\"";
  list.insert(list.end(),
              {{.name = "velocity",
                .slot = Formulas{.optional = &s.velocity},
                .dimension = velocity,
                .help = "Velocity; " + formula,
                .unset = "at rest",
                .example = R"x(["0 m/s", "0 m/s", "= 10 * (1 - x^2)"])x"},
               {.name = "pressure",
                .slot = Formula{.optional = &s.pressure},
                .dimension = pressure,
                .help = "Static pressure; " + formula + " (gauge in incompressible flow, else absolute)",
                .unset = "ambient",
                .example = "\"0 Pa gauge\""},
               {.name = "density",
                .slot = Formula{.optional = &s.density},
                .dimension = density,
                .bounds = positive,
                .help = "Density (compressible); " + formula,
                .unset = "from pressure and temperature",
                .example = "\"1.2 kg/m3\""},
               {.name = "temperature",
                .slot = Formula{.optional = &s.temperature},
                .dimension = temperature,
                .bounds = positive,
                .help = "Temperature (compressible); " + formula,
                .unset = "ambient",
                .example = "\"300 K\""},
               {.name = "k",
                .slot = Formula{.optional = &s.k},
                .dimension = specific_energy,
                .bounds = not_negative,
                .help = "Turbulent kinetic energy; " + formula,
                .unset = "nearly none",
                .example = "\"0.1 m2/s2\""},
               {.name = "epsilon",
                .slot = Formula{.optional = &s.epsilon},
                .dimension = dissipation_rate,
                .bounds = not_negative,
                .help = "Dissipation rate of k; " + formula,
                .unset = "from k and the size of the boundary",
                .example = "\"10 m2/s3\""}});
}
}  // namespace

std::vector<Key> keys(BoundarySpec& s, Dimension pressure) {
  std::vector<Key> list{
      {"type", choice(s.type), none, anything, "What the fluid meets on this face", "paper, Table 3"}};
  append_state(list, s.state, pressure);
  list.push_back({"total_pressure", &s.total_pressure, pressure_absolute, not_negative,
                  "Of the reservoir, for \"total-pressure\"", "", "ambient"});
  list.push_back({"total_temperature", &s.total_temperature, temperature, not_negative,
                  "Of the reservoir, for \"total-pressure\"", "", "ambient"});
  return list;
}

std::vector<Key> keys(PatchSpec& s, Dimension pressure) {
  std::vector<Key> list{
      {"type", choice(s.type), none, anything, "What the fluid meets inside the disc", ""},
      {.name = "centre", .slot = &s.centre, .dimension = length, .help = "Centre of the disc", .source = ""},
      {.name = "radius",
       .slot = &s.radius,
       .dimension = length,
       .bounds = positive,
       .help = "Radius of the disc",
       .required = true,
       .example = "\"1 mm\""}};
  append_state(list, s.state, pressure);
  list.push_back({"total_pressure", &s.total_pressure, pressure_absolute, not_negative,
                  "Of the reservoir, for \"total-pressure\"", "", "ambient"});
  list.push_back({"total_temperature", &s.total_temperature, temperature, not_negative,
                  "Of the reservoir, for \"total-pressure\"", "", "ambient"});
  return list;
}

std::vector<Key> keys(InitialSpec& s, Dimension pressure) {
  std::vector<Key> list{{.name = "box",
                         .slot = &s.box,
                         .dimension = length,
                         .help = "Region: two opposite corners",
                         .unset = "everywhere",
                         .example = R"([["0 m", "0 m", "0 m"], ["0.5 m", "1 m", "1 m"]])"}};
  append_state(list, s.state, pressure);
  return list;
}

}  // namespace ejecta
