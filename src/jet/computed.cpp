#include "jet/computed.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "jet/store.hpp"
#include "jet/valve.hpp"

namespace ejecta {
namespace {

/// How long the air of a shut valve is followed, s: it crosses 40 mm in well under one.
constexpr double kAfterClosing = 2e-3;

/// The valve's pulse as the jet's case computes it: commanded at time zero.
ValveSpec from_zero(ValveSpec v) {
  for (double& t : v.more_pulses) t -= v.opens_at;
  v.opens_at = 0.0;
  return v;
}

class ComputedJet : public JetSource {
 public:
  ComputedJet(const Case& box, Case source, const Note& note)
      : starts_(box.valve.opens_at),
        source_(std::move(source)),
        valve_(source_.valve, folder_of(source_)),
        profile_(stored_or_computed_jet(source_, jet_height(box), note)) {}

  /// Where a face lies aslant its points are at other heights than the stored plane: near it the jet is a
  /// cone with its tip in the orifice, in which r ~ z, u ~ 1/z, k ~ u^2 and epsilon ~ u^3/z.
  InflowState at(const Vec3& x, double, double, double time) const override {
    if (x.z() <= 0.0) return {};
    const double closer = profile_.height() / x.z();
    InflowState s = profile_.at(closer * x, time - starts_);
    s.velocity *= closer;
    s.k *= closer * closer;
    s.epsilon *= std::pow(closer, 4);
    return s;
  }
  double fastest(double time, double) const override { return profile_.fastest(time - starts_); }
  std::vector<double> events() const override {
    std::vector<double> list = valve_.events();
    for (double& t : list) t += starts_;
    return list;
  }
  double dead_from() const override { return starts_ + profile_.end_time(); }

 private:
  double starts_;  ///< s, command of the box's valve
  Case source_;
  Valve valve_;
  JetProfile profile_;
};

}  // namespace

Case computed_jet_case(const Case& box) {
  Case c = load_case(beside_case(box, box.jet.source_case));
  if (!box.valve.trace.empty())
    throw InputError("jet.kind = \"computed\": give a valve.trace in the jet's case, not in the box");
  const ValveSpec own = c.valve;
  c.valve = from_zero(box.valve);
  if (own.shape == ValveShape::trace) {
    c.valve.shape = own.shape;
    c.valve.trace = own.trace;
  }
  c.run.end_time = Valve(c.valve, folder_of(c)).closed_from() + kAfterClosing;
  return c;
}

std::unique_ptr<JetSource> make_computed_jet(const Case& box, const Note& note) {
  return std::make_unique<ComputedJet>(box, computed_jet_case(box), note);
}

}  // namespace ejecta
