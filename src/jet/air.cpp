#include "jet/air.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "flow/model/gas_from_case.hpp"
#include "flow/model/incompressible_model.hpp"
#include "flow/turbulence/scales.hpp"
#include "grid/sampler.hpp"
#include "jet/drive.hpp"
#include "jet/inlet.hpp"

namespace ejecta {
namespace {

/// Under-expanded, from a driven orifice.
class CompressibleAir : public JetAir {
 public:
  CompressibleAir(const Case& c, const Grid& grid)
      : case_(c),
        grid_(grid),
        drive_(c),
        formulas_(c, grid),
        solver_(gas::solver_from_case(c, grid, inlets_)) {}

  double stable_dt(double) override { return solver_->stable_dt(case_.run.courant); }
  void advance(double time, double dt) override {
    gas::drive(*solver_, inlets_, drive_.supply(time + 0.5 * dt));
    if (formulas_.vary()) formulas_.apply(time + 0.5 * dt, *solver_);
    solver_->advance(dt);
  }
  JetPoint at(const Vec3& position) const override {
    const GridSampler sampler(grid_, position);
    const auto value = [&](int c) {
      return sampler(solver_->primitive()[static_cast<std::size_t>(c)].view());
    };
    JetPoint p;
    p.density = value(gas::kRho);
    p.velocity = {value(gas::kU), grid_.axisymmetric() ? 0.0 : value(gas::kV), value(gas::kW)};
    p.pressure = value(gas::kP) + solver_->options().reference_pressure;
    p.k = value(gas::kK);
    p.epsilon = value(gas::kE);
    if (case_.flow.turbulence == TurbulenceModel::k_omega_sst) p.epsilon = gas::epsilon_of(p.k, p.epsilon);
    return p;
  }
  JetFlow flux(int i, int j, int k) const override {
    const gas::Block& f = solver_->flux(2);
    return {double(f[gas::kRho](i, j, k)), double(f[gas::kW](i, j, k))};
  }
  bool finite(Vec3* where) const override { return solver_->finite(where); }
  std::vector<NamedField> state_fields() override { return solver_->state(); }
  std::vector<double> state_numbers() const override {
    std::vector<double> all;
    for (const double* v : solver_->state_numbers()) all.push_back(*v);
    return all;
  }
  void restore_numbers(std::span<const double> numbers, double) override {
    StateReader in(numbers, "gas of the jet");
    for (double* v : solver_->state_numbers()) *v = in.number();
    in.end();
    solver_->resume();
  }

 private:
  const Case& case_;
  const Grid& grid_;
  JetDrive drive_;
  gas::FormulaFaces formulas_;
  std::vector<gas::DrivenInlet> inlets_;
  std::unique_ptr<gas::GasFlow> solver_;
};

/// Of constant density, from a velocity inlet (paper 2.2.2).
class IncompressibleAir : public JetAir {
 public:
  IncompressibleAir(const Case& c, const Grid& grid)
      : case_(c), grid_(grid), flow_(make_incompressible_model(c, grid, inflow_of(c))) {
    turbulent_ = flow_->quantities().size() > kKinetic;
  }

  double stable_dt(double time) override { return flow_->stable_dt(time); }
  void advance(double time, double dt) override { flow_->advance(time, dt, no_bodies_); }
  JetPoint at(const Vec3& position) const override {
    const Values v = values(position);
    JetPoint p;
    p.velocity = {v[0], v[1], v[2]};
    p.pressure = case_.environment.pressure + v[kPressure];
    p.density = flow_->density();
    p.k = v[kKinetic];
    if (v[kEddy] > 0.0) p.epsilon = epsilon_with(p.k, v[kEddy]);
    return p;
  }
  JetFlow flux(int i, int j, int k) const override {
    const Axis& z = grid_.axis(2);
    const auto centre = [&](int n) { return z.centre[static_cast<std::size_t>(n)]; };
    const Vec3 x = grid_.centre(i, j, 0);
    const double rho = flow_->density();
    const Values v = values({x.x(), x.y(), z.face[static_cast<std::size_t>(k)]});
    const double w = v[2];
    double gradient = 0.0;
    if (k > 0 && k < z.n)
      gradient = (values({x.x(), x.y(), centre(k)})[2] - values({x.x(), x.y(), centre(k - 1)})[2]) /
                 (centre(k) - centre(k - 1));
    const double viscosity = case_.fluid.viscosity + rho * v[kEddy];
    return {rho * w, rho * w * w + v[kPressure] - 2.0 * viscosity * gradient};
  }
  bool finite(Vec3* where) const override { return flow_->finite(where); }
  std::vector<NamedField> state_fields() override { return flow_->state_fields(); }
  std::vector<double> state_numbers() const override { return flow_->state_numbers(); }
  void restore_numbers(std::span<const double> numbers, double time) override {
    flow_->restore_numbers(numbers, time);
  }

 private:
  // As IncompressibleModel::quantities names them.
  static constexpr std::size_t kPressure = 3, kKinetic = 5, kEddy = 6;
  using Values = std::array<double, 7>;
  Values values(const Vec3& x) const {
    Values v{};
    flow_->sample(x, std::span(v).first(turbulent_ ? v.size() : kKinetic));
    return v;
  }
  const Case& case_;
  const Grid& grid_;
  std::unique_ptr<FlowModel> flow_;
  CutCells no_bodies_;
  bool turbulent_ = false;
};

}  // namespace

std::unique_ptr<JetAir> make_jet_air(const Case& c, const Grid& grid) {
  require_jet_air(c);
  if (c.flow.solver == FlowSolver::compressible) return std::make_unique<CompressibleAir>(c, grid);
  return std::make_unique<IncompressibleAir>(c, grid);
}

void require_jet_air(const Case& c) {
  if (c.flow.solver == FlowSolver::compressible ||
      (c.flow.solver == FlowSolver::incompressible && c.jet.kind == JetKind::velocity_inlet))
    return;
  throw InputError(
      "a jet is computed from its nozzle with flow.solver = \"compressible\", or incompressible with "
      "jet.kind = \"velocity-inlet\"");
}

}  // namespace ejecta
