#include "jet/source.hpp"

#include "case/extent.hpp"
#include "case/load.hpp"
#include "flow/ideal_gas.hpp"
#include "jet/computed.hpp"
#include "jet/nozzle.hpp"

namespace ejecta {
namespace {

JetSpec in_the_orifice(JetSpec jet) {
  jet.nozzle = Vec3::Zero();
  return jet;
}

/// Quasi-steady: what the orifice gives at the valve's opening of the moment.
class ValveJet : public JetSource {
 public:
  explicit ValveJet(const Case& c)
      : jet_(in_the_orifice(c.jet)),
        spec_(c.valve),
        gas_{c.fluid.gamma, c.fluid.gas_constant},
        density_(c.fluid.density),
        ambient_(c.environment.pressure),
        temperature_(c.valve.supply_temperature > 0.0 ? c.valve.supply_temperature
                                                      : c.environment.temperature),
        valve_(c.valve, folder_of(c)),
        far_(jet_, c.valve, 1.0),
        near_(jet_, c.valve) {
    valve_.require_jet(ambient_);
  }

  InflowState at(const Vec3& x, double half_x, double half_y, double time) const override {
    const double u = velocity(time);
    if (jet_.kind == JetKind::self_similar) return far_.at(x, u);
    const double share = near_.share(x, half_x, half_y);  // of the disc that flows, C_D of the orifice
    return share > 0.0 ? near_.at(share, u) : InflowState{};
  }
  double fastest(double time, double height) const override {
    const double u = velocity(time);
    if (jet_.kind != JetKind::self_similar) return u;
    return far_.at(Vec3(0, 0, height), u).velocity.z();
  }
  std::vector<double> events() const override { return valve_.events(); }
  double dead_from() const override { return valve_.closed_from(); }

 private:
  NozzleExit orifice(double time) const {
    return nozzle_exit(gas_, valve_.total_pressure(time, ambient_), temperature_, ambient_);
  }
  /// Momentum-equivalent velocity, or the one the case gives, opened like the momentum of the valve.
  double velocity(double time) const {
    const double flowing = jet_.kind == JetKind::self_similar ? spec_.discharge_coefficient : 1.0;
    if (jet_.inlet_velocity > 0.0) {
      const double full = nozzle_exit(gas_, spec_.supply_pressure, temperature_, ambient_).thrust_per_area;
      return jet_.inlet_velocity * std::sqrt(orifice(time).thrust_per_area / full);
    }
    return nozzle_equivalent_velocity(orifice(time), flowing, density_);
  }

  JetSpec jet_;
  ValveSpec spec_;
  Gas gas_;
  double density_, ambient_, temperature_;
  Valve valve_;
  SelfSimilarJet far_;
  NozzleInflow near_;
};

}  // namespace

bool has_jet(const Case& c) { return jet_face(c).has_value(); }

std::unique_ptr<JetSource> make_jet_source(const Case& c, const Note& note) {
  if (!has_jet(c)) return nullptr;
  if (c.jet.kind == JetKind::computed) return make_computed_jet(c, note);
  return std::make_unique<ValveJet>(c);
}

}  // namespace ejecta
