#include "app/jet_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/report.hpp"

namespace ejecta {
namespace {

constexpr double kDefaultHistory = 20e-6;  ///< s
/// Probes look this often, s: a thousandth of the paper's transducer's response, and many steps of the flow.
constexpr double kLook = 1e-6;
constexpr double kShocksEnd = 30e-3;    ///< m: from here on the two jets of Figure 7 are compared
constexpr double kMomentumLook = 5e-6;  ///< s, between two looks at the momentum
/// The far field is fitted from this many orifices on unless the case says otherwise, and up to this share
/// of the box.
constexpr double kFarFrom = 25.0, kFarTo = 0.9;

/// Largest deviation of the density from that of the air at rest along a line across the jet, percent.
double density_variation(const JetModel& jet, double z) {
  const double rest = jet.scenario().environment.pressure /
                      (jet.scenario().fluid.gas_constant * jet.scenario().environment.temperature);
  double most = 0.0;
  for (const double r : jet.grid().axis(0).centre)
    most = std::max(most, std::abs(jet.sample({r, jet.grid().lower().y(), z}).density / rest - 1.0));
  return 100.0 * most;
}

/// Momentum of the incompressible jet over that of the compressible one at the same heights from kShocksEnd
/// on.
void add_momentum_ratio(nlohmann::ordered_json& to, const SettledJet& jet,
                        const std::vector<double>& reference) {
  double least = 1e300, most = 0.0;
  for (std::size_t n = 0; n < reference.size(); ++n)
    if (jet.heights[n] > kShocksEnd && reference[n] > 0.0) {
      least = std::min(least, jet.momentum[n] / reference[n]);
      most = std::max(most, jet.momentum[n] / reference[n]);
    }
  if (most > 0.0) {
    to["momentum_over_compressible_least"] = least;
    to["momentum_over_compressible_most"] = most;
  }
}

std::vector<MeasuredCurve> read_measurements(const Case& c) {
  std::vector<MeasuredCurve> curves;
  for (const MeasuredSpec& m : c.measured) {
    const bool over_time =
        std::any_of(c.probes.begin(), c.probes.end(), [&](const ProbeSpec& p) { return p.name == m.of; });
    curves.push_back(read_measured(beside_case(c, m.file), over_time ? Dimension::time : Dimension::length));
  }
  return curves;
}

}  // namespace

JetRun::JetRun(const Case& c, double kept_at, const RunOptions& options)
    : jet_(c),
      measured_(read_measurements(c)),
      directory_(output::RunDirectory::create(options.out.empty() ? output::RunDirectory::default_path(c.path)
                                                                  : std::filesystem::path(options.out),
                                              options.force)),
      provenance_{.command = command_line_of("jet", c, options),
                  .case_path = c.path,
                  .input = write_case(c),
                  .threads = thread_count(),
                  .overrides = options.overrides},
      lines_(output::provenance_lines(provenance_)),
      orifice_(directory_, lines_),
      momentum_(jet_),
      profile_(jet_, kept_at),
      progress_(std::cerr, output::progress_options_of_terminal(options.quiet ? output::Verbosity::quiet
                                                                              : output::Verbosity::normal)),
      quiet_(options.quiet),
      interval_(c.output.history_interval > 0.0 ? c.output.history_interval : kDefaultHistory) {
  directory_.write_case(provenance_.input);
  directory_.write_manifest(output::make_manifest(provenance_));
  for (const ProbeSpec& p : c.probes) probes_.emplace_back(p, directory_, lines_);
  const ValveSpec& v = c.valve;
  shown_at_ = v.shape == ValveShape::trace
                  ? 0.5 * (jet_.valve().events().front() + jet_.valve().events().back())
                  : v.opens_at + v.delay + v.duration;
  jet_.clock().add_event(shown_at_);
}

void JetRun::advance_to_end() {
  const double end = jet_.scenario().run.end_time, start = wall_seconds();
  write_histories();
  while (jet_.time() < end) {
    const double dt = jet_.step();
    orifice_.advance(jet_, dt);
    unseen_ += dt;
    if (unseen_ >= kLook) observe();
    profile_.advance(jet_);
    if (jet_.time() >= next_history_) write_histories();
    if (!shown_ && jet_.time() >= shown_at_) show();
    progress_.update(state(dt));
  }
  progress_.finish(state(0.0), "done");
  profile_.profile().write(jet_file(jet_.scenario(), profile_.profile().height()));
  const Case& c = jet_.scenario();
  if (c.jet.compare_incompressible && c.flow.solver == FlowSolver::compressible)
    incompressible_ =
        settled_jet(incompressible_jet(c), jet_.grid().axis(2).length(), [&](const std::string& line) {
          if (!quiet_) std::cerr << line << std::endl;
        });
  wall_ = wall_seconds() - start;
}

void JetRun::observe() {
  for (JetProbe& p : probes_) p.advance(jet_, unseen_);
  unseen_ = 0.0;
  // The second half of the time in which the valve is fully open counts for the momentum.
  if (shown_ || jet_.valve().opening(jet_.time()) < kFullyOpen) return;
  if (fully_open_from_ < 0.0) fully_open_from_ = jet_.time();
  const double since = momentum_seen_at_ > 0.0 ? momentum_seen_at_ : 0.5 * (fully_open_from_ + shown_at_);
  if (jet_.time() < since + kMomentumLook) return;
  momentum_.observe(jet_, jet_.time() - since);
  momentum_seen_at_ = jet_.time();
}

void JetRun::write_histories() {
  next_history_ = jet_.time() + interval_;
  if (jet_.steps() > 0) orifice_.write(jet_);
  for (JetProbe& p : probes_) p.write(jet_);
}

void JetRun::show() {
  shown_ = true;
  const Case& c = jet_.scenario();
  line_ = centreline(jet_);
  write_centreline(directory_, lines_, jet_.time(), "centreline", line_);
  for (const LineSpec& spec : c.lines) {
    profiles_.push_back(line_profile(jet_, spec));
    write_line(directory_, lines_, jet_.time(), spec, profiles_.back());
  }
  picture_ = schlieren_picture(jet_);
  const double d = jet_.orifice_diameter(), pa = jet_.ambient_pressure();
  const double p0 = jet_.valve().total_pressure(jet_.time(), pa);
  const Gas gas{c.fluid.gamma, c.fluid.gas_constant};
  const ShockStructure shocks = shock_structure(line_, gas);
  const double u = nozzle_equivalent_velocity(jet_.ideal_exit(), c.valve.discharge_coefficient,
                                              gas_density(gas, pa, c.environment.temperature));
  const double from = c.jet.far_field_from > 0.0 ? c.jet.far_field_from : kFarFrom * d;
  const FarField far = far_field(line_, u, d, from, kFarTo * jet_.grid().axis(2).length());
  at_full_["profiles_at_s"] = jet_.time();
  at_full_["equivalent_velocity_m_s"] = u;
  at_full_["shocks"] = {{"mach_disk_m", shocks.mach_disk},
                        {"mach_disk_ashkenas_sherman_m", nozzle_mach_disk(p0, pa, d)},
                        {"peak_mach", shocks.peak_mach},
                        {"behind_over_normal_shock", shocks.behind_over_normal_shock},
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
  at_full_["momentum"] = momentum_.summary();
}

void JetRun::write_result() {
  const Case& c = jet_.scenario();
  add_centreline_figures();
  add_line_figures();
  add_probe_figures();
  if (shown_) figures_.add(picture_);
  figures_.write(directory_.figures());
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
  if (incompressible_)
    r["incompressible"] = {{"inlet_velocity_m_s", incompressible_->equivalent_velocity},
                           {"velocity_m_s", incompressible_->at_stand_off.velocity.z()},
                           {"mach", incompressible_->at_stand_off.mach},
                           {"total_gauge_Pa", incompressible_->at_stand_off.total_gauge},
                           {"momentum", incompressible_->momentum_summary}};
  if (incompressible_) add_momentum_ratio(r["incompressible"], *incompressible_, momentum_.mean());
  r["probes"] = nlohmann::ordered_json::array();
  for (const JetProbe& p : probes_) r["probes"].push_back(p.summary());
  if (!compared_.empty()) r["measured"] = compared_;
  r["stored_profile"] = jet_file(c, profile_.profile().height()).string();
  directory_.write_result(r);
  if (c.output.report) output::write_report(directory_.path());
  if (!quiet_) fmt::print("{}\n", r.dump(2));
}

output::ProgressState JetRun::state(double dt) const {
  return {.time = jet_.time(),
          .end_time = jet_.scenario().run.end_time,
          .step = jet_.steps(),
          .dt = dt,
          .courant = jet_.scenario().run.courant,
          .cells = jet_.grid().cells()};
}

}  // namespace ejecta
