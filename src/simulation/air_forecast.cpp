#include "simulation/air_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "case/extent.hpp"
#include "flow/model/flow_model.hpp"
#include "jet/source.hpp"
#include "simulation/air_limits.hpp"
#include "simulation/prospect.hpp"

namespace ejecta {
namespace {

/// The jet, or for one that would have to be computed first, the self-similar one of the same valve.
std::unique_ptr<JetSource> jet_of(Case c) {
  if (c.jet.kind == JetKind::computed) c.jet.kind = JetKind::self_similar;
  return make_jet_source(c);
}

/// Highest speed on the jet's axis at a height above the orifice until then, m/s.
double peak_speed(const JetSource& jet, double until, double height) {
  constexpr int samples = 256;
  double fastest = 0.0;
  for (int n = 0; n <= samples; ++n) fastest = std::max(fastest, jet.fastest(until * n / samples, height));
  return fastest;
}

/// The jet after its valve has closed, on its axis: behind the wave that tells it of the end, u = z / 2t
/// solves the balance of momentum over its cross-section (Musculus 2009, entrainment wave; Gaussian profile),
/// m/s.
double dying_speed(double from_nozzle, double since_closed) { return from_nozzle / (2.0 * since_closed); }

/// Time after which the air of the box holds only the share kDeadAir of the energy of the steady jet, s: with
/// u = K / z before and z / 2t after, energies as u2 z2 dz.
double dying_time(const Case& original) {
  Case c = original;
  c.jet.kind = JetKind::self_similar;
  const std::vector<double>& x = c.grid.axis[static_cast<std::size_t>(*jet_face(c) / 2)].points;
  const double low = jet_height(c), high = low + x.back() - x.front();
  const double k = high * peak_speed(*jet_of(c), c.run.end_time, high);
  const double moment = (std::pow(high, 5) - std::pow(std::max(low, 0.0), 5)) / 5.0;
  return std::sqrt(moment / (4.0 * kDeadAir * k * k * (high - low)));
}

}  // namespace

double jet_speed(const Case& c) { return peak_speed(*jet_of(c), c.run.end_time, jet_height(c)); }

double air_until(const Case& c, const Company& company) {
  if (c.flow.solver == FlowSolver::none || !has_jet(c) || c.run.until != RunUntil::verdict)
    return c.run.end_time;
  const double closed = jet_of(c)->dead_from();
  double leave = 0.0;  // until the last body that nothing disturbs has left the box for good
  for (std::size_t n = 0; n < company.bodies.size(); ++n)
    if (const auto in_box = prospect_of(c, company, n, nullptr).in_box) leave = std::max(leave, in_box->to);
  return std::min(c.run.end_time, std::max(closed, std::min(leave, closed + dying_time(c))));
}

std::int64_t jet_steps(const Case& c, const Grid& grid, double until) {
  const std::unique_ptr<JetSource> jet = jet_of(c);
  const double closed = jet->dead_from();
  const int face = *jet_face(c);
  const Axis& x = grid.axis(face / 2);
  std::vector<double> height;  // of the cells along the way, above the orifice
  for (const double centre : x.centre)
    height.push_back(jet_height(c) + std::abs(centre - (face % 2 ? x.face.back() : x.face.front())));
  double longest = std::min(c.run.time_step_max, kStepOfPulse * c.valve.duration);
  for (const double interval : {c.output.fields_interval, c.output.slices_interval})
    if (interval > 0.0) longest = std::min(longest, interval);
  std::vector<double> peak;
  for (const double h : height) peak.push_back(peak_speed(*jet, closed, h));
  constexpr int samples = 400;
  double steps = 0.0;
  for (int n = 0; n < samples; ++n) {
    const double t = until * (n + 0.5) / samples;
    double rate = 1.0 / longest;
    for (std::size_t k = 0; k < height.size(); ++k) {
      const double speed =
          t < closed ? jet->fastest(t, height[k]) : std::min(peak[k], dying_speed(height[k], t - closed));
      rate = std::max(rate, speed / (c.run.courant * x.width[k]));
    }
    steps += rate * until / samples;
  }
  return static_cast<std::int64_t>(std::ceil(steps));
}

}  // namespace ejecta
