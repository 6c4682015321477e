#include <fmt/format.h>

#include "app/jet_run.hpp"

/// The paper's figures of one jet, with what was measured.
namespace ejecta {

void JetRun::compare(const std::string& of, std::span<const double> x, std::span<const double> y,
                     output::Figure& figure) {
  const Case& c = jet_.scenario();
  for (std::size_t n = 0; n < c.measured.size(); ++n) {
    if (c.measured[n].of != of) continue;
    const MeasuredError error = compare_measured(measured_[n], x, y);
    nlohmann::ordered_json entry{{"of", of}, {"file", c.measured[n].file}};
    entry.update(error.summary());
    compared_.push_back(entry);
    const std::string label =
        fmt::format("measured: {} ({:.2f} kPa rms apart)", c.measured[n].file, 1e-3 * error.rms);
    figure.series.push_back(measured_series(label, measured_[n]));
  }
}

void JetRun::add_centreline_figures() {
  if (!shown_) return;
  output::Figure f = centreline_figure("Total pressure on the axis (paper, Figure 7)");
  const bool compressible = jet_.scenario().flow.solver == FlowSolver::compressible;
  f.series.push_back(centreline_series(compressible ? "compressible" : "incompressible", line_));
  std::vector<double> total, pitot, mach, z;
  for (std::size_t n = 0; n < line_.z.size(); ++n) {
    z.push_back(1e3 * line_.z[n]);
    total.push_back(line_.samples[n].total_gauge);
    pitot.push_back(1e-3 * line_.samples[n].pitot_gauge);
    mach.push_back(line_.samples[n].mach);
  }
  if (compressible)
    f.series.push_back({.label = "as a Pitot tube reads it", .x = z, .y = pitot, .dashed = true});
  if (incompressible_)
    f.series.push_back(
        centreline_series(fmt::format("incompressible, {:.0f} m/s", incompressible_->equivalent_velocity),
                          incompressible_->line));
  compare("centreline", line_.z, total, f);
  figures_.add(f);
  figures_.add(beyond(f, 1e3 * kFarView, "Total pressure on the axis, where the box begins and beyond"));
  figures_.add({"Mach number on the axis", "z [mm]", "Mach number", {{"computed", z, mach}}});
  output::Figure flux{"Momentum through planes across the jet", "z [mm]", "momentum flux [N]"};
  const auto add = [&](const char* label, std::vector<double> heights, const std::vector<double>& momentum) {
    for (double& height : heights) height *= 1e3;
    flux.series.push_back({label, std::move(heights), momentum});
  };
  add(compressible ? "compressible" : "incompressible", momentum_.heights(), momentum_.mean());
  if (incompressible_) add("incompressible", incompressible_->heights, incompressible_->momentum);
  figures_.add(std::move(flux));
}

void JetRun::add_line_figures() {
  const Case& c = jet_.scenario();
  for (std::size_t n = 0; n < profiles_.size(); ++n) {
    const LineProfile& p = profiles_[n];
    std::vector<double> x, total, kilo;
    for (std::size_t i = 0; i < p.distance.size(); ++i) {
      x.push_back(1e3 * p.distance[i]);
      total.push_back(p.samples[i].total_gauge);
      kilo.push_back(1e-3 * p.samples[i].total_gauge);
    }
    output::Figure f{fmt::format("Total pressure along the line {} (paper, Figure 8)", c.lines[n].name),
                     "distance [mm]",
                     "total gauge pressure [kPa]",
                     {{"computed", x, kilo}}};
    compare(c.lines[n].name, p.distance, total, f);
    figures_.add(std::move(f));
  }
}

void JetRun::add_probe_figures() {
  for (const JetProbe& p : probes_) {
    std::vector<double> ms = p.times(), ideal = p.ideal(), reading = p.readings();
    for (auto* values : {&ideal, &reading})
      for (double& v : *values) v *= 1e-3;
    for (double& t : ms) t *= 1e3;
    output::Figure f{probe_title(p.spec()),
                     "time [ms]",
                     "total gauge pressure [kPa]",
                     {{.label = "transducer", .x = ms, .y = reading},
                      {.label = "ideal", .x = ms, .y = ideal, .dashed = true}}};
    compare(p.spec().name, p.times(), p.readings(), f);
    figures_.add(std::move(f));
  }
}

}  // namespace ejecta
