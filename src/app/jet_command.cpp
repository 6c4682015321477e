#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>

#include "app/exit_code.hpp"
#include "app/jet_analysis.hpp"
#include "app/jet_model.hpp"
#include "app/jet_records.hpp"
#include "app/jet_store.hpp"
#include "app/simulation.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/progress.hpp"

namespace ejecta {
namespace {

constexpr double kDefaultHistory = 20e-6;  ///< s
/// The far field is fitted from this many orifices on, and up to this share of the box.
constexpr double kFarFrom = 25.0, kFarTo = 0.9;

/// A box that is fed with a computed jet stands for the case that computes it.
Case jet_of(const Case& c) {
  if (c.flow.solver == FlowSolver::compressible || c.jet.source_case.empty()) return c;
  return load_case((std::filesystem::path(c.path).parent_path() / c.jet.source_case).string());
}

void write_centreline(const output::RunDirectory& directory, std::span<const std::string> provenance,
                      double time, const Centreline& line) {
  output::HistoryFile file(directory.history("centreline"), provenance,
                           {{"z", "m"},
                            {"velocity_z", "m/s"},
                            {"mach", "1"},
                            {"pressure", "Pa"},
                            {"temperature", "K"},
                            {"total_gauge", "Pa"},
                            {"pitot_gauge", "Pa"},
                            {"half_radius", "m"},
                            {"k", "m2/s2"},
                            {"epsilon", "m2/s3"}});
  for (std::size_t n = 0; n < line.z.size(); ++n) {
    const JetSample& s = line.samples[n];
    const std::array<double, 10> row{line.z[n],     s.velocity.z(), s.mach,        s.pressure,
                                     s.temperature, s.total_gauge,  s.pitot_gauge, line.half_radius[n],
                                     s.k,           s.epsilon};
    file.add(time, row);
  }
}

void write_line(const output::RunDirectory& directory, std::span<const std::string> provenance,
                const JetModel& jet, const LineSpec& spec) {
  output::HistoryFile file(directory.history(spec.name), provenance,
                           {{"x", "m"},
                            {"y", "m"},
                            {"z", "m"},
                            {"velocity_x", "m/s"},
                            {"velocity_z", "m/s"},
                            {"mach", "1"},
                            {"density", "kg/m3"},
                            {"total_gauge", "Pa"},
                            {"pitot_gauge", "Pa"}});
  for (int n = 0; n < spec.points; ++n) {
    const Vec3 x = spec.from + (spec.to - spec.from) * (double(n) / std::max(1, spec.points - 1));
    const JetSample s = jet.sample(x);
    const std::array<double, 9> row{x.x(),  x.y(),     x.z(),         s.velocity.x(), s.velocity.z(),
                                    s.mach, s.density, s.total_gauge, s.pitot_gauge};
    file.add(jet.time(), row);
  }
}

/// Largest deviation of the density from that of the air at rest along a line across the jet, percent.
double density_variation(const JetModel& jet, double z) {
  const double rest = jet.scenario().environment.pressure /
                      (jet.scenario().fluid.gas_constant * jet.scenario().environment.temperature);
  double most = 0.0;
  for (const double r : jet.grid().axis(0).centre)
    most = std::max(most, std::abs(jet.sample({r, jet.grid().lower().y(), z}).density / rest - 1.0));
  return 100.0 * most;
}

/// One computation of a jet with its observers.
class JetRun {
 public:
  JetRun(const Case& c, const RunOptions& options)
      : jet_(c),
        directory_(output::RunDirectory::create(options.out.empty()
                                                    ? output::RunDirectory::default_path(c.path)
                                                    : std::filesystem::path(options.out),
                                                options.force)),
        provenance_{.command = "ejecta jet " + c.path,
                    .case_path = c.path,
                    .input = write_case(c),
                    .threads = thread_count()},
        lines_(output::provenance_lines(provenance_)),
        orifice_(directory_, lines_),
        momentum_(jet_),
        profile_(jet_, kBoxHeight),
        progress_(std::cerr, output::progress_options_of_terminal(options.quiet ? output::Verbosity::quiet
                                                                                : output::Verbosity::normal)),
        interval_(c.output.history_interval > 0.0 ? c.output.history_interval : kDefaultHistory) {
    directory_.write_case(provenance_.input);
    directory_.write_manifest(output::make_manifest(provenance_));
    for (const ProbeSpec& p : c.probes) probes_.emplace_back(jet_, p, directory_, lines_);
    const ValveSpec& v = c.valve;
    shown_at_ = v.shape == ValveShape::trace
                    ? 0.5 * (jet_.valve().events().front() + jet_.valve().events().back())
                    : v.opens_at + v.delay + v.duration;
    jet_.clock().add_event(shown_at_);
  }

  void advance_to_end() {
    const double end = jet_.scenario().run.end_time, start = wall_seconds();
    write_histories();
    while (jet_.time() < end) {
      const double dt = jet_.step();
      orifice_.advance(jet_, dt);
      momentum_.advance(jet_, dt);
      for (JetProbe& p : probes_) p.advance(jet_, dt);
      profile_.advance(jet_);
      if (jet_.time() >= next_history_) write_histories();
      if (!shown_ && jet_.time() >= shown_at_) show();
      progress_.update(state(dt));
    }
    wall_ = wall_seconds() - start;
    progress_.finish(state(0.0), "done");
    profile_.profile().write(jet_file(jet_.scenario(), kBoxHeight));
  }

  void write_result() {
    const Case& c = jet_.scenario();
    nlohmann::ordered_json r;
    r["title"] = c.run.title;
    r["outcome"] = "jet computed";
    r["cells"] = jet_.grid().cells();
    r["steps"] = jet_.steps();
    r["simulated_time_s"] = jet_.time();
    r["wall_time_s"] = wall_;
    r["threads"] = thread_count();
    r["cell_steps_per_s"] = double(jet_.grid().cells()) * double(jet_.steps()) / wall_;
    r["orifice"] = orifice_.summary(jet_);
    for (const auto& [key, value] : at_full_.items()) r[key] = value;
    r["momentum"] = momentum_.summary();
    r["probes"] = nlohmann::ordered_json::array();
    for (const JetProbe& p : probes_) r["probes"].push_back(p.summary());
    r["stored_profile"] = jet_file(c, kBoxHeight).string();
    directory_.write_result(r);
    fmt::print("{}\n", r.dump(2));
  }

 private:
  output::ProgressState state(double dt) const {
    return {.time = jet_.time(),
            .end_time = jet_.scenario().run.end_time,
            .step = jet_.steps(),
            .dt = dt,
            .courant = jet_.scenario().run.courant,
            .cells = jet_.grid().cells()};
  }

  void write_histories() {
    next_history_ = jet_.time() + interval_;
    if (jet_.steps() > 0) orifice_.write(jet_);
    for (JetProbe& p : probes_) p.write(jet_);
  }

  /// Profiles and figures of the jet at the end of the command, when it blows its strongest.
  void show() {
    shown_ = true;
    const Case& c = jet_.scenario();
    const Centreline line = centreline(jet_);
    write_centreline(directory_, lines_, jet_.time(), line);
    for (const LineSpec& spec : c.lines) write_line(directory_, lines_, jet_, spec);
    const double d = jet_.orifice_diameter(), pa = jet_.ambient_pressure();
    const double p0 = jet_.valve().total_pressure(jet_.time(), pa);
    const Gas gas{c.fluid.gamma, c.fluid.gas_constant};
    const ShockStructure shocks = shock_structure(line);
    const double u = nozzle_equivalent_velocity(jet_.ideal_exit(), c.valve.discharge_coefficient,
                                                gas_density(gas, pa, c.environment.temperature));
    const FarField far = far_field(line, u, d, kFarFrom * d, kFarTo * jet_.grid().axis(2).length());
    at_full_["profiles_at_s"] = jet_.time();
    at_full_["equivalent_velocity_m_s"] = u;
    at_full_["shocks"] = {{"mach_disk_m", shocks.mach_disk},
                          {"mach_disk_ashkenas_sherman_m", nozzle_mach_disk(p0, pa, d)},
                          {"peak_mach", shocks.peak_mach},
                          {"first_cell_m", shocks.first_cell},
                          {"first_cell_prandtl_pack_m", nozzle_shock_cell(gas, p0, pa, d)},
                          {"pressure_maxima_m", shocks.pressure_maxima}};
    at_full_["far_field"] = {{"decay", far.decay},
                             {"spreading", far.spreading},
                             {"decay_times_spreading", far.decay * far.spreading},
                             {"virtual_origin_m", far.virtual_origin}};
    const double z = jet_.grid().lower().z() + c.launch.stand_off;
    const JetSample s = jet_.sample({jet_.grid().lower().x(), jet_.grid().lower().y(), z});
    at_full_["at_stand_off"] = {{"height_m", c.launch.stand_off},
                                {"velocity_m_s", s.velocity.z()},
                                {"mach", s.mach},
                                {"total_gauge_Pa", s.total_gauge},
                                {"density_variation_percent", density_variation(jet_, z)}};
  }

  JetModel jet_;
  output::RunDirectory directory_;
  output::Provenance provenance_;
  std::vector<std::string> lines_;
  OrificeRecord orifice_;
  MomentumRecord momentum_;
  ProfileRecorder profile_;
  std::vector<JetProbe> probes_;
  output::Progress progress_;
  nlohmann::ordered_json at_full_;
  double interval_, next_history_ = 0.0, shown_at_ = 0.0, wall_ = 0.0;
  bool shown_ = false;
};

}  // namespace

int jet_case(const Case& c, const RunOptions& options) {
  if (options.threads > 0) set_thread_count(options.threads);
  JetRun run(jet_of(c), options);
  if (options.dry_run) return exit_done;
  run.advance_to_end();
  run.write_result();
  return exit_done;
}

}  // namespace ejecta
