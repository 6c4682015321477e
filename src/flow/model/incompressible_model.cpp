#include "flow/model/incompressible_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "case/expression.hpp"
#include "case/initial.hpp"
#include "flow/model/boundary_change.hpp"
#include "flow/model/incompressible_states.hpp"
#include "flow/piso/incompressible.hpp"
#include "grid/sampler.hpp"

namespace ejecta {
namespace {

class IncompressibleModel : public FlowModel {
 public:
  IncompressibleModel(const Case& c, const Grid& grid, Inflow inflow)
      : case_(c), grid_(grid), still_(c), inflow_(std::move(inflow)) {
    IncompressibleSetup setup;
    setup.density = still_.density;
    setup.viscosity = still_.nu;
    setup.corrections = c.flow.corrections;
    setup.acceleration = c.flow.body_force;
    setup.round_jet_correction = c.flow.round_jet_correction;
    if (c.flow.turbulence == TurbulenceModel::k_epsilon) setup.turbulence = TwoEquationModel::k_epsilon;
    if (c.flow.turbulence == TurbulenceModel::k_omega_sst) setup.turbulence = TwoEquationModel::k_omega_sst;
    const auto& s = c.exact.source;
    if (s[0] != "0" || s[1] != "0" || s[2] != "0")
      setup.source = [f = std::array<Expression, 3>{Expression(s[0]), Expression(s[1]), Expression(s[2])}](
                         const Vec3& x, double t) {
        return Vec3(f[0](x.x(), x.y(), x.z(), t), f[1](x.x(), x.y(), x.z(), t), f[2](x.x(), x.y(), x.z(), t));
      };
    for (int f = 0; f < 6; ++f)
      faces_[static_cast<std::size_t>(f)] = make_boundary(c, grid, still_, inflow_, f);
    flow_ = std::make_unique<Incompressible>(grid, faces_, setup);
    if (inflow_.at) faces_[static_cast<std::size_t>(inflow_.face)].varies = false;  // has a limit of its own
    initialise();
  }

  double stable_dt(double time) override {
    double dt = step_of_flow(time);
    if (!std::isfinite(dt)) report_divergence(time);
    return step_of_boundaries(time, step_of_jet(time, std::min(dt, case_.run.time_step_max)));
  }
  double courant(double dt) const override { return flow_->courant(dt); }
  void advance(double time, double dt, CutCells& solids) override {
    flow_->advance(time, dt, solids);
    note_step(dt, solids);
  }
  void advance_with_grains(double time, double dt, CutCells& solids, FluidFraction& grains) override {
    if (!begun_ && last_dt_ == 0.0 && resumed_step_ == 0.0 && solids.empty()) {
      flow_->set_fraction(grains);  // the grains are part of what there is at the start
      momentum_at_start_ = flow_->momentum();
    }
    begun_ = true;
    flow_->advance(time, dt, solids, grains);
    note_step(dt, solids);
  }
  double density() const override { return still_.density; }
  FluidSeen seen() const override {
    FluidSeen s{.velocity = std::as_const(*flow_).velocity()};
    if (const TwoEquation* t = std::as_const(*flow_).turbulence())
      s.k = t->k().view(), s.dissipation = t->dissipation().view();
    s.specific = still_.omega;
    return s;
  }

  std::vector<CellField> fields() override {
    const auto u = flow_->velocity();
    std::vector<CellField> all{vector_field("velocity", u[0], u[1], u[2]),
                               scalar_field("pressure", flow_->pressure_field().view(), still_.density)};
    if (const TwoEquation* t = flow_->turbulence()) {
      all.push_back(scalar_field("k", t->k().view()));
      all.push_back(scalar_field(still_.omega ? "omega" : "epsilon", t->dissipation().view()));
      all.push_back(scalar_field("eddy_viscosity", t->eddy_viscosity()));
    }
    return all;
  }
  std::vector<std::pair<std::string, std::string>> quantities() const override {
    std::vector<std::pair<std::string, std::string>> q{{"velocity_x", "m/s"},
                                                       {"velocity_y", "m/s"},
                                                       {"velocity_z", "m/s"},
                                                       {"pressure", "Pa"},
                                                       {"total_pressure", "Pa"}};
    if (flow_->turbulence()) q.insert(q.end(), {{"k", "m2/s2"}, {"eddy_viscosity", "m2/s"}});
    return q;
  }
  void sample(const Vec3& x, std::span<double> values) const override {
    const GridSampler at(grid_, x);
    const auto u = flow_->velocity();
    for (std::size_t d = 0; d < 3; ++d) values[d] = at(u[d]);
    values[3] = still_.density * at(flow_->pressure_field().view());
    values[4] = values[3] + 0.5 * still_.density *
                                (values[0] * values[0] + values[1] * values[1] + values[2] * values[2]);
    if (const TwoEquation* t = flow_->turbulence()) {
      values[5] = at(t->k().view());
      values[6] = at(t->eddy_viscosity());
    }
  }

  Vec3 momentum() const override { return flow_->momentum(); }
  double kinetic_energy() const override { return flow_->kinetic_energy(); }
  bool finite(Vec3* where) const override { return flow_->finite(where); }

  std::vector<Figure> report() const override {
    const FlowLedger& l = flow_->ledger();
    const Vec3 change = flow_->momentum() - momentum_at_start_;
    Vec3 lost = change - l.momentum_through_boundaries + l.impulse_on_solids - l.displaced;
    if (grid_.axisymmetric()) lost.x() = 0.0;  // radial momentum is not conserved
    const double scale =
        std::max({l.momentum_through_boundaries.norm(), l.impulse_on_solids.norm(), change.norm(), 1e-30});
    const auto vector = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
    return {{"ledger",
             "mass_relative_residual",
             {l.mass_in > 0.0 ? std::abs(l.mass_through_boundaries) / l.mass_in : 0.0}},
            {"ledger", "momentum_relative_residual", {lost.norm() / scale}},
            {"ledger", "momentum_through_boundaries_N_s", vector(l.momentum_through_boundaries)},
            {"ledger", "impulse_on_solids_N_s", vector(l.impulse_on_solids)},
            {"ledger", "momentum_of_displaced_fluid_N_s", vector(l.displaced)},
            {"ledger", "largest_divergence", {divergence()}}};
  }

  std::vector<OperatorTime> operators() const override {
    const FlowTimes& t = flow_->times();
    return {
        {"flow.boundaries", "states of the boundaries into ghost cells", t.boundaries, 0},
        {"flow.momentum_predictor", "u* = u + dt [-div(q u) + div(2 nu_eff S) - grad p], two Heun stages",
         t.momentum, 0},
        {"flow.face_velocities", "q* = mean(u*) + dt (mean(grad p) - grad p), r = div q* / dt", t.faces, 0},
        {"flow.pressure", "div grad phi = r, exact by fast diagonalisation", t.pressure, 0},
        {"flow.correction", "q -= dt grad phi, u -= dt grad phi, p += phi", t.correction, 0},
        {"flow.turbulence", "k and epsilon or omega: transport, sources, nu_t", t.turbulence, 0},
        {"flow.ledger", "momentum and mass through the boundaries", t.ledger, 0}};
  }

  std::vector<NamedField> state_fields() override { return flow_->state(); }
  std::vector<double> state_numbers() const override {
    const FlowLedger& l = flow_->ledger();
    std::vector<double> n;
    for (const Vec3& v :
         {l.momentum_through_boundaries, l.impulse_on_solids, l.displaced, momentum_at_start_})
      n.insert(n.end(), {v.x(), v.y(), v.z()});
    n.insert(n.end(), {l.mass_through_boundaries, l.mass_in});
    // The velocity before the last step is not stored, only what it says of the next one.
    const double next = last_dt_ > 0.0 ? flow_->stable_dt(case_.run.courant, last_dt_) : resumed_step_;
    n.insert(n.end(), {next, divergence()});
    return n;
  }
  void restore_numbers(std::span<const double> n, double time) override {
    FlowLedger& l = flow_->ledger();
    StateReader in(n, "ledger of the air");
    for (Vec3* v : {&l.momentum_through_boundaries, &l.impulse_on_solids, &l.displaced, &momentum_at_start_})
      *v = in.vec3();
    for (double* v : {&l.mass_through_boundaries, &l.mass_in, &resumed_step_, &resumed_divergence_})
      *v = in.number();
    in.end();
    flow_->resume(time);
  }

 private:
  void note_step(double dt, CutCells& solids) {
    cut_ = &solids;
    last_dt_ = dt;
    resumed_step_ = 0.0;
  }
  /// Of the last step: the cut cells to which it belongs are not in a checkpoint.
  double divergence() const { return cut_ ? flow_->largest_divergence(*cut_) : resumed_divergence_; }
  /// What the flow itself allows.
  double step_of_flow(double time) {
    const double courant = case_.run.courant;
    if (last_dt_ > 0.0) return flow_->stable_dt(courant, last_dt_);
    if (resumed_step_ == 0.0)
      return flow_->first_step(time, courant, step_of_jet(time, case_.run.time_step_max));
    flow_->stable_dt(courant);  // sets what advance() needs
    return resumed_step_;
  }
  /// A jet that starts must not outrun the step that lets it in.
  double step_of_jet(double time, double dt) const {
    if (!inflow_.at) return dt;
    dt = std::min(dt, kStepOfPulse * case_.valve.duration);
    const double h = width_inside(grid_, inflow_.face);
    for (int n = 0; n < 60; ++n) {
      const double limit = case_.run.courant * h / std::max(inflow_.fastest(time + dt), 1e-30);
      if (limit >= dt) break;
      dt = std::max(limit, 0.5 * dt);
    }
    return dt;
  }
  /// Nor must a boundary that is switched on; where it is, what the flow behind it does is tried as well.
  double step_of_boundaries(double time, double dt) {
    if (std::none_of(faces_.begin(), faces_.end(), [](const Boundary& b) { return b.varies; })) return dt;
    const double courant = case_.run.courant;
    dt = std::min(dt, kStepOfPulse * case_.run.end_time);  // what comes and goes must not be stepped over
    BoundaryChange change = boundary_change(grid_, faces_, time, dt);
    for (int n = 0; n < 100 && change.reached > courant; ++n) {
      dt *= 0.5;
      change = boundary_change(grid_, faces_, time, dt);
    }
    if (change.changed > 0.25 * courant)
      for (int n = 0; n < 100 && !(flow_->try_step(time, dt) <= 1.5 * courant); ++n) dt *= 0.5;
    return dt;
  }
  [[noreturn]] void report_divergence(double time) const {
    Vec3 x{0, 0, 0};
    std::string where;
    if (!flow_->finite(&x))
      where = fmt::format(" near x, y, z = {:.4g}, {:.4g}, {:.4g} mm", x.x() * 1e3, x.y() * 1e3, x.z() * 1e3);
    throw DivergedError(fmt::format(
        "the flow diverged at t = {:.6g} s{}: a velocity or an eddy viscosity is no number; try a "
        "smaller run.courant, a smoother grid there, or a longer valve.rise_time",
        time, where));
  }

  /// What the regions that hold a cell say together.
  struct Start {
    StateFormula formula;
    Expression pressure;
  };
  void initialise() {
    std::map<std::vector<int>, Start> starts;
    const auto start_at = [&](const Vec3& x) -> const Start& {
      const std::vector<int> regions = regions_at(case_, x);
      const auto known = starts.find(regions);
      if (known != starts.end()) return known->second;
      const StateSpec spec = merged(case_, regions);
      return starts
          .emplace(regions, Start{StateFormula(spec, still_),
                                  spec.pressure ? Expression(*spec.pressure) : Expression()})
          .first->second;
    };
    if (TwoEquation* t = flow_->turbulence()) {
      t->initialise(still_.k, still_.dissipation);
      for (int k = 0; k < grid_.nz(); ++k)
        for (int j = 0; j < grid_.ny(); ++j)
          for (int i = 0; i < grid_.nx(); ++i) {
            const Vec3 x = grid_.centre(i, j, k);
            const StateFormula::Turbulence at = start_at(x).formula.turbulence_at(x, 0.0);
            t->set_at(i, j, k, at.k, at.dissipation);
          }
    }
    const auto velocity = [&](const Vec3& x) { return start_at(x).formula.at(x, 0.0); };
    const auto pressure = [&](const Vec3& x) {
      return start_at(x).pressure(x.x(), x.y(), x.z(), 0.0) / still_.density;
    };
    flow_->initialise(velocity, pressure, 0.0);
    resumed_divergence_ = flow_->largest_divergence({});
    momentum_at_start_ = flow_->momentum();
  }

  const Case& case_;
  const Grid& grid_;
  StillAir still_;
  const Inflow inflow_;
  std::array<Boundary, 6> faces_;
  std::unique_ptr<Incompressible> flow_;
  Vec3 momentum_at_start_{0, 0, 0};
  double last_dt_ = 0;             ///< s, of the last step of this process
  double resumed_step_ = 0;        ///< s, what the flow allowed when the checkpoint was written
  double resumed_divergence_ = 0;  ///< what it was then
  const CutCells* cut_ = nullptr;  // of the last step
  bool begun_ = false;             // with grains
};

}  // namespace

std::unique_ptr<FlowModel> make_incompressible_model(const Case& c, const Grid& grid, Inflow inflow) {
  return std::make_unique<IncompressibleModel>(c, grid, std::move(inflow));
}

}  // namespace ejecta
