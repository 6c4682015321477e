#include "simulation/jet_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/state_reader.hpp"
#include "simulation/jet_figures.hpp"

namespace ejecta {
namespace {

constexpr double kDefaultHistory = 20e-6;  ///< s

const std::vector<output::Column> kProbe{{"total_gauge", "Pa"}, {"transducer", "Pa"}, {"velocity_z", "m/s"},
                                         {"mach", "1"},         {"pressure", "Pa"},   {"density", "kg/m3"},
                                         {"k", "m2/s2"},        {"epsilon", "m2/s3"}};
const std::vector<output::Column> kOrifice{
    {"opening", "1"}, {"total_pressure", "Pa"}, {"mass_flow", "kg/s"}, {"mass_flow_exact", "kg/s"},
    {"thrust", "N"},  {"thrust_exact", "N"},    {"mass", "kg"}};

}  // namespace

JetOutputs::JetOutputs(const RecordedJet& model, OutputPlace place)
    : model_(model),
      directory_(place.directory),
      histories_(place),
      orifice_(histories_.open("orifice", kOrifice)),
      next_history_(place.resumed.value_or(0.0)) {
  const Case& c = model.jet().scenario();
  interval_ = c.output.history_interval > 0.0 ? c.output.history_interval : kDefaultHistory;
  for (const ProbeSpec& p : c.probes) probes_.push_back(&histories_.open("probe-" + p.name, kProbe));
}

void JetOutputs::observe(double time, std::int64_t steps) {
  if (time < next_history_) return;
  next_history_ = time + interval_;
  const JetModel& jet = model_.jet();
  if (steps > 0) {
    const ValveSpec& v = jet.scenario().valve;
    const JetFlow flow = jet.orifice_flow();
    const NozzleExit ideal = jet.ideal_exit();
    orifice_.add(
        time, std::array{jet.valve().opening(time), jet.valve().total_pressure(time, jet.ambient_pressure()),
                         flow.mass, nozzle_mass_flow(ideal, v.discharge_coefficient, v.orifice_diameter),
                         flow.momentum, nozzle_thrust(ideal, v.discharge_coefficient, v.orifice_diameter),
                         model_.orifice().mass()});
  }
  for (std::size_t n = 0; n < probes_.size(); ++n) {
    const JetProbe& probe = model_.probes()[n];
    const JetSample s = jet.sample(probe.spec().position);
    probes_[n]->add(time, std::array{s.total_gauge, probe.reading(), s.velocity.z(), s.mach, s.pressure,
                                     s.density, s.k, s.epsilon});
  }
}

void JetOutputs::finish(double) {
  const Case& c = model_.jet().scenario();
  if (const JetAtFull* full = model_.at_full()) {
    write_centreline(histories_, full->time, "centreline", full->centreline);
    for (std::size_t n = 0; n < c.lines.size(); ++n)
      write_line(histories_, full->time, c.lines[n], full->lines[n]);
  }
  add_centreline_figures();
  add_line_figures();
  add_probe_figures();
  if (model_.at_full()) figures_.add(model_.at_full()->schlieren);
  if (directory_) figures_.write(directory_->figures());
}

void JetOutputs::report(nlohmann::ordered_json& result) {
  if (!compared_.empty()) result["measured"] = compared_;
}

std::vector<double> JetOutputs::state() const { return {next_history_}; }

void JetOutputs::restore(const std::vector<double>& state) {
  StateReader in(state, "outputs of the jet");
  next_history_ = in.number();
  in.end();
}

void JetOutputs::compare(const std::string& of, std::span<const double> x, std::span<const double> y,
                         output::Figure& figure) {
  const Case& c = model_.jet().scenario();
  for (std::size_t n = 0; n < c.measured.size(); ++n) {
    if (c.measured[n].of != of) continue;
    const MeasuredError error = compare_measured(model_.measured()[n], x, y);
    nlohmann::ordered_json entry{{"of", of}, {"file", c.measured[n].file}};
    entry.update(error.summary());
    compared_.push_back(entry);
    const std::string label =
        fmt::format("measured: {} ({:.2f} kPa rms apart)", c.measured[n].file, 1e-3 * error.rms);
    figure.series.push_back(measured_series(label, model_.measured()[n]));
  }
}

void JetOutputs::add_centreline_figures() {
  const JetAtFull* full = model_.at_full();
  if (!full) return;
  const Centreline& line = full->centreline;
  output::Figure f = centreline_figure("Total pressure on the axis");
  const bool compressible = model_.jet().scenario().flow.solver == FlowSolver::compressible;
  f.series.push_back(centreline_series(compressible ? "compressible" : "incompressible", line));
  std::vector<double> total, pitot, mach, z;
  for (std::size_t n = 0; n < line.z.size(); ++n) {
    z.push_back(1e3 * line.z[n]);
    total.push_back(line.samples[n].total_gauge);
    pitot.push_back(1e-3 * line.samples[n].pitot_gauge);
    mach.push_back(line.samples[n].mach);
  }
  if (compressible)
    f.series.push_back({.label = "as a Pitot tube reads it", .x = z, .y = pitot, .dashed = true});
  if (const SettledJet* slow = model_.incompressible())
    f.series.push_back(
        centreline_series(fmt::format("incompressible, {:.0f} m/s", slow->equivalent_velocity), slow->line));
  compare("centreline", line.z, total, f);
  figures_.add(f);
  figures_.add(
      beyond(f, 1e3 * far_field_from(model_.jet().scenario()), "Total pressure on the axis, far field"));
  figures_.add({"Mach number on the axis", "z [mm]", "Mach number", {{"computed", z, mach}}});
  output::Figure flux{"Momentum through planes across the jet", "z [mm]", "momentum flux [N]"};
  const auto add = [&](const char* label, std::vector<double> heights, const std::vector<double>& momentum) {
    for (double& height : heights) height *= 1e3;
    flux.series.push_back({label, std::move(heights), momentum});
  };
  add(compressible ? "compressible" : "incompressible", model_.momentum().heights(),
      model_.momentum().mean());
  if (const SettledJet* slow = model_.incompressible()) add("incompressible", slow->heights, slow->momentum);
  figures_.add(std::move(flux));
}

void JetOutputs::add_line_figures() {
  const Case& c = model_.jet().scenario();
  for (std::size_t n = 0; model_.at_full() && n < c.lines.size(); ++n) {
    const LineProfile& p = model_.at_full()->lines[n];
    std::vector<double> x, total, kilo;
    for (std::size_t i = 0; i < p.distance.size(); ++i) {
      x.push_back(1e3 * p.distance[i]);
      total.push_back(p.samples[i].total_gauge);
      kilo.push_back(1e-3 * p.samples[i].total_gauge);
    }
    output::Figure f{fmt::format("Total pressure along the line {}", c.lines[n].name),
                     "distance [mm]",
                     "total gauge pressure [kPa]",
                     {{"computed", x, kilo}}};
    compare(c.lines[n].name, p.distance, total, f);
    figures_.add(std::move(f));
  }
}

void JetOutputs::add_probe_figures() {
  for (std::size_t n = 0; n < model_.probes().size(); ++n) {
    const ProbeSpec& spec = model_.probes()[n].spec();
    const output::HistoryTable table = probes_[n]->table();
    const std::vector<double>& time = table.values[0];
    std::vector<double> ms = time, ideal = table.values[1], reading = table.values[2];
    for (auto* values : {&ideal, &reading})
      for (double& v : *values) v *= 1e-3;
    for (double& t : ms) t *= 1e3;
    output::Figure f{probe_title(spec),
                     "time [ms]",
                     "total gauge pressure [kPa]",
                     {{.label = "transducer", .x = ms, .y = reading},
                      {.label = "ideal", .x = ms, .y = ideal, .dashed = true}}};
    compare(spec.name, time, table.values[2], f);
    figures_.add(std::move(f));
  }
}

}  // namespace ejecta
