#include "jet/records.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ejecta {
namespace {

/// Points of the average over the opening of a transducer: rings of equal area, evenly around.
constexpr int kRings = 4, kAround = 8;

double percent(double value, double reference) { return 100.0 * (value / reference - 1.0); }

}  // namespace

double JetProbe::over_opening(const JetModel& jet) const {
  if (spec_.diameter <= 0.0) return jet.sample(spec_.position).pitot_gauge;
  double sum = 0.0;
  for (int ring = 0; ring < kRings; ++ring)
    for (int n = 0; n < kAround; ++n) {
      const double r = 0.5 * spec_.diameter * std::sqrt((ring + 0.5) / kRings);
      const double angle = 2.0 * std::numbers::pi * (n + 0.5) / kAround;
      Vec3 at = spec_.position + Vec3(r * std::cos(angle), r * std::sin(angle), 0.0);
      if (jet.grid().axisymmetric()) at = {std::hypot(at.x(), at.y()), 0.0, at.z()};
      sum += jet.sample(at).pitot_gauge;
    }
  return sum / (kRings * kAround);
}

void JetProbe::advance(const JetModel& jet, double dt) {
  const double seen = over_opening(jet);
  const double follow = spec_.response_time > 0.0 ? 1.0 - std::exp(-dt / spec_.response_time) : 1.0;
  reading_ += follow * (seen - reading_);
  const JetSample s = jet.sample(spec_.position);
  if (reading_ > peak_reading_) peak_reading_ = reading_, peak_reading_at_ = jet.time();
  if (s.total_gauge > peak_total_) peak_total_ = s.total_gauge, peak_total_at_ = jet.time();
  peak_mach_ = std::max(peak_mach_, s.mach);
}

nlohmann::ordered_json JetProbe::summary() const {
  return {{"name", spec_.name},
          {"position_m", {spec_.position.x(), spec_.position.y(), spec_.position.z()}},
          {"peak_total_gauge_Pa", peak_total_},
          {"peak_total_gauge_at_s", peak_total_at_},
          {"peak_transducer_Pa", peak_reading_},
          {"peak_transducer_at_s", peak_reading_at_},
          {"peak_mach", peak_mach_}};
}

void JetProbe::save(std::vector<double>& out) const {
  out.insert(out.end(), {reading_, peak_reading_, peak_reading_at_, peak_total_, peak_total_at_, peak_mach_});
}

void JetProbe::load(StateReader& in) {
  for (double* v : {&reading_, &peak_reading_, &peak_reading_at_, &peak_total_, &peak_total_at_, &peak_mach_})
    *v = in.number();
}

void OrificeRecord::advance(const JetModel& jet, double dt) {
  const JetFlow flow = jet.orifice_flow();
  mass_ += flow.mass * dt;
  impulse_ += flow.momentum * dt;
  if (jet.valve().opening(jet.time()) < kFullyOpen) return;
  const ValveSpec& v = jet.scenario().valve;
  open_time_ += dt;
  mass_flow_ += flow.mass * dt;
  thrust_ += flow.momentum * dt;
  ideal_mass_flow_ += nozzle_mass_flow(jet.ideal_exit(), v.discharge_coefficient, v.orifice_diameter) * dt;
  ideal_thrust_ += nozzle_thrust(jet.ideal_exit(), v.discharge_coefficient, v.orifice_diameter) * dt;
}

void OrificeRecord::save(std::vector<double>& out) const {
  out.insert(out.end(), {mass_, impulse_, open_time_, mass_flow_, thrust_, ideal_mass_flow_, ideal_thrust_});
}

void OrificeRecord::load(StateReader& in) {
  for (double* v : {&mass_, &impulse_, &open_time_, &mass_flow_, &thrust_, &ideal_mass_flow_, &ideal_thrust_})
    *v = in.number();
}

nlohmann::ordered_json OrificeRecord::summary(const JetModel& jet) const {
  const Case& c = jet.scenario();
  const Gas gas{c.fluid.gamma, c.fluid.gas_constant};
  nlohmann::ordered_json r{
      {"diameter_m", c.valve.orifice_diameter},
      {"cells_across", jet.cells_across_orifice()},
      {"mass_kg", mass_},
      {"normal_litres", nozzle_normal_litres(gas, mass_)},
      {"impulse_N_s", impulse_},
      {"isothermal_work_J", nozzle_isothermal_work(gas, mass_, c.environment.temperature,
                                                   c.valve.supply_pressure, c.environment.pressure)}};
  if (open_time_ <= 0.0) return r;
  r["fully_open_s"] = open_time_;
  r["mass_flow_kg_s"] = mass_flow_ / open_time_;
  r["mass_flow_error_percent"] = percent(mass_flow_, ideal_mass_flow_);
  r["thrust_N"] = thrust_ / open_time_;
  r["thrust_error_percent"] = percent(thrust_, ideal_thrust_);
  return r;
}

}  // namespace ejecta
