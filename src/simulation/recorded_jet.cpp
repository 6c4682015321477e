#include "simulation/recorded_jet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "case/load.hpp"
#include "simulation/jet_figures.hpp"

namespace ejecta {
namespace {

/// Probes look this often, s: a thousandth of the paper's transducer's response, and many steps of the flow.
constexpr double kProbeLook = 1e-6;
constexpr double kShocksEnd =
    30e-3;  ///< m: from here on the compressible and the incompressible jet are compared
constexpr double kMomentumLook = 5e-6;  ///< s, between two looks at the momentum
constexpr double kFarTo = 0.9;          ///< share of the box up to which the far field is fitted

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

double full_at(const ValveSpec& v, const Valve& valve) {
  if (v.shape == ValveShape::trace) return 0.5 * (valve.events().front() + valve.events().back());
  return v.opens_at + v.delay + v.duration;
}

}  // namespace

RecordedJet::RecordedJet(const Case& c, double kept_at)
    : jet_(c),
      measured_(read_measurements(c)),
      momentum_(jet_),
      profile_(jet_, kept_at),
      probes_(c.probes.begin(), c.probes.end()),
      full_at_(full_at(c.valve, jet_.valve())) {
  for (const NamedField& f : jet_.air().state_fields()) air_at_full_.push_back(*f.field);
  numbers_at_full_ = jet_.air().state_numbers();
}

std::vector<double> RecordedJet::events() const {
  std::vector<double> list = jet_.valve().events();
  list.push_back(full_at_);
  return list;
}

void RecordedJet::advance(const Step& step) {
  {
    const ScopedTimer timer(advance_.seconds);
    jet_.advance(step);
    ++advance_.calls;
  }
  const ScopedTimer timer(record_.seconds);
  ++record_.calls;
  orifice_.advance(jet_, step.dt);
  not_yet_observed_ += step.dt;
  if (not_yet_observed_ >= kProbeLook) observe();
  profile_.advance(jet_);
  if (!at_full_ && jet_.time() >= full_at_) look_at_full();
}

void RecordedJet::observe() {
  for (JetProbe& p : probes_) p.advance(jet_, not_yet_observed_);
  not_yet_observed_ = 0.0;
  // The second half of the time in which the valve is fully open counts for the momentum.
  if (at_full_ || jet_.valve().opening(jet_.time()) < kFullyOpen) return;
  if (fully_open_from_ < 0.0) fully_open_from_ = jet_.time();
  const double since = momentum_seen_at_ > 0.0 ? momentum_seen_at_ : 0.5 * (fully_open_from_ + full_at_);
  if (jet_.time() < since + kMomentumLook) return;
  momentum_.observe(jet_, jet_.time() - since);
  momentum_seen_at_ = jet_.time();
}

void RecordedJet::look_at_full() {
  const auto air = jet_.air().state_fields();
  for (std::size_t f = 0; f < air.size(); ++f) air_at_full_[f] = *air[f].field;
  numbers_at_full_ = jet_.air().state_numbers();
  JetAtFull& full = at_full_.emplace();
  const Case& c = jet_.scenario();
  full.time = jet_.time();
  full.centreline = centreline(jet_);
  for (const LineSpec& spec : c.lines) full.lines.push_back(line_profile(jet_, spec));
  full.schlieren = schlieren_picture(jet_);
  const double d = jet_.orifice_diameter(), pa = jet_.ambient_pressure();
  const double p0 = jet_.valve().total_pressure(jet_.time(), pa);
  const Gas gas{c.fluid.gamma, c.fluid.gas_constant};
  const ShockStructure shocks = shock_structure(full.centreline, gas);
  const double u = nozzle_equivalent_velocity(jet_.ideal_exit(), c.valve.discharge_coefficient,
                                              gas_density(gas, pa, c.environment.temperature));
  const FarField far =
      far_field(full.centreline, u, d, far_field_from(c), kFarTo * jet_.grid().axis(2).length());
  full.figures["profiles_at_s"] = jet_.time();
  full.figures["equivalent_velocity_m_s"] = u;
  full.figures["shocks"] = {{"mach_disk_m", shocks.mach_disk},
                            {"mach_disk_ashkenas_sherman_m", nozzle_mach_disk(p0, pa, d)},
                            {"peak_mach", shocks.peak_mach},
                            {"behind_over_normal_shock", shocks.behind_over_normal_shock},
                            {"first_cell_m", shocks.first_cell},
                            {"first_cell_prandtl_pack_m", nozzle_shock_cell(gas, p0, pa, d)},
                            {"pressure_maxima_m", shocks.pressure_maxima}};
  full.figures["far_field"] = {{"decay", far.decay},
                               {"spreading", far.spreading},
                               {"decay_times_spreading", far.decay * far.spreading},
                               {"virtual_origin_m", far.virtual_origin}};
  const double z = jet_.grid().lower().z() + c.launch.stand_off;
  const JetSample s = jet_.sample({jet_.grid().lower().x(), jet_.grid().lower().y(), z});
  full.figures["at_stand_off"] = {{"height_m", c.launch.stand_off},
                                  {"velocity_m_s", s.velocity.z()},
                                  {"mach", s.mach},
                                  {"total_gauge_Pa", s.total_gauge},
                                  {"density_variation_percent", density_variation(jet_, z)}};
  full.figures["momentum"] = momentum_.summary();
}

bool RecordedJet::conclude(const std::function<bool()>& stop, const Note& note) {
  const Case& c = jet_.scenario();
  profile_.profile().write(jet_file(c, profile_.profile().height()));
  if (!c.jet.compare_incompressible || c.flow.solver != FlowSolver::compressible) return true;
  incompressible_ = settled_jet(incompressible_jet(c), jet_.grid().axis(2).length(), note, stop);
  return incompressible_.has_value();
}

void RecordedJet::require_finite(double time) const {
  Vec3 where{0, 0, 0};
  if (jet_.air().finite(&where)) return;
  throw DivergedError(
      fmt::format("the jet diverged at t = {:.6g} s near x, y, z = {:.4g}, {:.4g}, {:.4g} mm; try a smaller "
                  "run.courant, a smoother grid there, or a longer valve.rise_time",
                  time, where.x() * 1e3, where.y() * 1e3, where.z() * 1e3));
}

std::vector<NamedField> RecordedJet::state_fields() {
  std::vector<NamedField> all = jet_.air().state_fields();
  for (std::size_t f = 0; f < air_at_full_.size(); ++f)
    all.push_back({"at_full/" + all[f].name, &air_at_full_[f]});
  return all;
}

std::vector<double> RecordedJet::records() const {
  std::vector<double> all{not_yet_observed_, fully_open_from_, momentum_seen_at_,
                          at_full_ ? at_full_->time : -1.0};
  orifice_.save(all);
  momentum_.save(all);
  profile_.save(all);
  for (const JetProbe& p : probes_) p.save(all);
  return all;
}

StateNumbers RecordedJet::state_numbers() const {
  return {{"air", jet_.air().state_numbers()}, {"at_full", numbers_at_full_}, {"records", records()}};
}

void RecordedJet::restore_numbers(const StateNumbers& numbers, double time) {
  StateReader in(numbers_of(numbers, "records"), "records of the jet");
  for (double* v : {&not_yet_observed_, &fully_open_from_, &momentum_seen_at_}) *v = in.number();
  const double seen_at = in.number();
  orifice_.load(in);
  momentum_.load(in);
  profile_.load(in);
  for (JetProbe& p : probes_) p.load(in);
  in.end();
  if (seen_at >= 0.0) {
    const auto air = jet_.air().state_fields();
    for (std::size_t f = 0; f < air.size(); ++f) std::swap(*air[f].field, air_at_full_[f]);
    jet_.restore(numbers_of(numbers, "at_full"), seen_at);
    std::vector<Field> now = air_at_full_;
    look_at_full();
    for (std::size_t f = 0; f < air.size(); ++f) *air[f].field = std::move(now[f]);
  }
  numbers_at_full_ = numbers_of(numbers, "at_full");
  jet_.restore(numbers_of(numbers, "air"), time);
}

nlohmann::ordered_json RecordedJet::result(double time, std::int64_t steps, double wall_time,
                                           std::span<const OperatorTime> operators) const {
  const Case& c = jet_.scenario();
  nlohmann::ordered_json r;
  r["title"] = c.run.title;
  r["outcome"] = "jet computed";
  r["cells"] = cells();
  r["steps"] = steps;
  r["simulated_time_s"] = time;
  r["wall_time_s"] = wall_time;
  r["threads"] = thread_count();
  r["cell_steps_per_s"] = wall_time > 0.0 ? double(cells()) * double(steps) / wall_time : 0.0;
  r["orifice"] = orifice_.summary(jet_);
  if (at_full_)
    for (const auto& [key, value] : at_full_->figures.items()) r[key] = value;
  if (incompressible_) {
    r["incompressible"] = {{"inlet_velocity_m_s", incompressible_->equivalent_velocity},
                           {"velocity_m_s", incompressible_->at_stand_off.velocity.z()},
                           {"mach", incompressible_->at_stand_off.mach},
                           {"total_gauge_Pa", incompressible_->at_stand_off.total_gauge},
                           {"momentum", incompressible_->momentum_summary}};
    add_momentum_ratio(r["incompressible"], *incompressible_, momentum_.mean());
  }
  r["probes"] = nlohmann::ordered_json::array();
  for (const JetProbe& p : probes_) r["probes"].push_back(p.summary());
  r["stored_profile"] = jet_file(c, profile_.profile().height()).string();
  if (!operators.empty()) r["operators"] = operators_json(operators);
  return r;
}

}  // namespace ejecta
