#include "flow/model/compressible_model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "base/stopwatch.hpp"
#include "case/expression.hpp"
#include "flow/model/gas_from_case.hpp"
#include "grid/sampler.hpp"

namespace ejecta {
namespace {

using namespace gas;

class CompressibleModel : public FlowModel {
 public:
  CompressibleModel(const Case& c, const Grid& grid, Inflow inflow)
      : case_(c), grid_(grid), inflow_(std::move(inflow)), formulas_(c, grid) {
    solver_ = solver_from_case(c, grid, inlets_);
    solver_->keep_ledger();
    if (!c.grains.empty()) solver_->expect_grains(density());
    if (inflow_.at) set_jet_states(0.0);
    momentum_at_start_ = momentum();
    mass_at_start_ = solver_->total(kRho);
    energy_at_start_ = solver_->total(kP);
  }

  double stable_dt(double time) override {
    set_boundaries(time);
    double dt = std::min(solver_->stable_dt(case_.run.courant), case_.run.time_step_max);
    if (inflow_.at) {
      // A jet that starts must not outrun the step that lets it in, nor open and close unseen within one.
      dt = std::min(dt, kStepOfPulse * case_.valve.duration);
      const double h = width_inside(grid_, inflow_.face);
      dt = std::min(dt,
                    std::max(0.5 * dt, case_.run.courant * h / std::max(inflow_.fastest(time + dt), 1e-30)));
    }
    return step_of_boundaries(time, dt);
  }
  double courant(double dt) const override { return dt / solver_->stable_dt(1.0); }
  void advance(double time, double dt, CutCells& solids) override {
    step(time, dt, [&] { solver_->advance(dt, solids); });
  }
  void advance_with_grains(double time, double dt, CutCells& solids, FluidFraction& grains) override {
    step(time, dt, [&] { solver_->advance(dt, solids, grains); });
  }

  double density() const override { return case_.fluid.density; }
  FluidSeen seen() const override {
    FluidSeen s{.velocity = {view(kU), view(kV), view(kW)}, .density = view(kRho)};
    if (turbulent()) s.k = view(kK), s.dissipation = view(kE);
    s.specific = case_.flow.turbulence == TurbulenceModel::k_omega_sst;
    return s;
  }
  std::vector<CellField> fields() override {
    std::vector<CellField> all{
        vector_field("velocity", view(kU), view(kV), view(kW)), scalar_field("density", view(kRho)),
        scalar_field("pressure", view(kP), 1.0, solver_->options().reference_pressure)};
    if (turbulent()) {
      all.push_back(scalar_field("k", view(kK)));
      all.push_back(scalar_field(case_.flow.turbulence == TurbulenceModel::k_omega_sst ? "omega" : "epsilon",
                                 view(kE)));
      all.push_back(scalar_field("eddy_viscosity", solver_->eddy_viscosity().view()));
    }
    return all;
  }
  std::vector<std::pair<std::string, std::string>> quantities() const override {
    return {{"velocity_x", "m/s"}, {"velocity_y", "m/s"}, {"velocity_z", "m/s"}, {"pressure", "Pa"},
            {"density", "kg/m3"},  {"temperature", "K"},  {"mach", "1"},         {"total_pressure", "Pa"}};
  }
  void sample(const Vec3& x, std::span<double> values) const override {
    const GridSampler at(grid_, x);
    const Gas& gas = solver_->options().gas;
    const Vec3 u(at(view(kU)), at(view(kV)), at(view(kW)));
    const double p = at(view(kP)) + solver_->options().reference_pressure, rho = at(view(kRho));
    const double temperature = p / (rho * gas.gas_constant),
                 mach = u.norm() / gas_sound_speed(gas, temperature);
    const std::array<double, 8> all{u.x(), u.y(),       u.z(), p,
                                    rho,   temperature, mach,  p * gas_total_pressure_ratio(gas, mach)};
    std::copy(all.begin(), all.end(), values.begin());
  }

  Vec3 momentum() const override {
    return {solver_->total(kU), grid_.active(1) ? solver_->total(kV) : 0.0, solver_->total(kW)};
  }
  double kinetic_energy() const override {
    const auto rho = view(kRho), u = view(kU), v = view(kV), w = view(kW);
    const Metrics x = grid_.metrics(0), y = grid_.metrics(1), z = grid_.metrics(2);
    const ConstFieldView gas = solver_->part();
    return 0.5 * reduce_sum(grid_.range(), [=](int i, int j, int k) {
             const double share = gas.origin ? double(gas(i, j, k)) : 1.0;
             const double square = double(u(i, j, k)) * u(i, j, k) + double(v(i, j, k)) * v(i, j, k) +
                                   double(w(i, j, k)) * w(i, j, k);
             return share * double(rho(i, j, k)) * square * double(x.volume[i]) * double(y.volume[j]) *
                    double(z.volume[k]);
           });
  }
  bool finite(Vec3* where) const override { return solver_->finite(where); }

  std::vector<Figure> report() const override {
    const BoundaryLedger& l = solver_->ledger();
    const double mass = solver_->total(kRho), energy = solver_->total(kP);
    Vec3 lost = momentum() - momentum_at_start_ - l.momentum - l.momentum_of_solids - l.displaced.momentum;
    if (grid_.axisymmetric()) lost.x() = 0.0;  // radial momentum is not conserved
    const double scale = std::max({l.momentum.norm(), (momentum() - momentum_at_start_).norm(), 1e-30});
    std::vector<Figure> all{
        {"ledger",
         "mass_relative_residual",
         {std::abs(mass - mass_at_start_ - l.mass - l.displaced.mass) / mass_at_start_}},
        {"ledger", "momentum_relative_residual", {lost.norm() / scale}},
        {"ledger",
         "energy_relative_residual",
         {std::abs(energy - energy_at_start_ - l.energy - l.work_of_solids - l.displaced.energy) /
          std::max({std::abs(energy_at_start_), std::abs(l.energy), 1e-30})}},
        {"ledger", "mass_kg", {mass}}};
    const Vec3 push = -l.momentum_of_solids;
    if (!case_.bodies.empty())
      all.push_back({"ledger", "impulse_on_solids_N_s", {push.x(), push.y(), push.z()}});
    all.push_back({"", "fastest_m_s", {fastest_}});
    if (case_.exact.density)
      add_errors(all, "density", *case_.exact.density, [](const GasState& s) { return s.density; });
    if (case_.exact.pressure)
      add_errors(all, "pressure", *case_.exact.pressure, [](const GasState& s) { return s.pressure; });
    return all;
  }
  std::vector<OperatorTime> operators() const override {
    if (case_.flow.solver == FlowSolver::compressible_piso)
      return {
          {"flow.compressible_piso",
           "U = U - dt div(q U_up), q and p implicit in sound: dp/(K dt^2) - div(grad dp/rho) = -div q/dt "
           "(mass, momentum, energy)",
           seconds_, calls_}};
    return {{"flow.godunov", "U = U - dt div F(U), HLLC on MUSCL states, two stages (mass, momentum, energy)",
             seconds_, calls_}};
  }
  std::vector<NamedField> state_fields() override { return solver_->state(); }
  std::vector<double> state_numbers() const override {
    const BoundaryLedger& l = solver_->ledger();
    std::vector<double> all{l.mass,
                            l.mass_inward,
                            l.energy,
                            l.momentum.x(),
                            l.momentum.y(),
                            l.momentum.z(),
                            momentum_at_start_.x(),
                            momentum_at_start_.y(),
                            momentum_at_start_.z(),
                            mass_at_start_,
                            energy_at_start_,
                            fastest_,
                            l.momentum_of_solids.x(),
                            l.momentum_of_solids.y(),
                            l.momentum_of_solids.z(),
                            l.work_of_solids,
                            l.displaced.mass,
                            l.displaced.momentum.x(),
                            l.displaced.momentum.y(),
                            l.displaced.momentum.z(),
                            l.displaced.energy,
                            started_};
    for (const double* v : solver_->state_numbers()) all.push_back(*v);
    return all;
  }
  void restore_numbers(std::span<const double> n, double time) override {
    time_ = time;
    BoundaryLedger& l = solver_->ledger();
    StateReader in(n, "ledger of the gas");
    for (double* v : {&l.mass, &l.mass_inward, &l.energy}) *v = in.number();
    for (Vec3* v : {&l.momentum, &momentum_at_start_}) *v = in.vec3();
    for (double* v : {&mass_at_start_, &energy_at_start_, &fastest_}) *v = in.number();
    l.momentum_of_solids = in.vec3();
    l.work_of_solids = in.number();
    l.displaced.mass = in.number();
    l.displaced.momentum = in.vec3();
    l.displaced.energy = in.number();
    started_ = in.number();
    for (double* v : solver_->state_numbers()) *v = in.number();
    in.end();
    solver_->resume();
    set_boundaries(time);
  }

 private:
  void set_boundaries(double time) {
    if (inflow_.supply) drive(*solver_, inlets_, inflow_.supply(time));
    if (inflow_.at) set_jet_states(time);
    if (formulas_.vary()) formulas_.apply(time, *solver_);
  }
  template <class Advance>
  void step(double time, double dt, const Advance& advance) {
    const ScopedTimer timer(seconds_);
    set_boundaries(time + 0.5 * dt);
    advance();
    started_ = 1.0;
    fastest_ = std::max(fastest_, fastest());
    time_ = time + dt;
    ++calls_;
  }

  /// Gas at rest allows a long step, however hard boundaries or regions of another pressure are going to push
  /// it. The first step, and one in which a boundary is switched, is tried and taken back, and halved while
  /// it is outrun.
  double step_of_boundaries(double time, double dt) {
    const double courant = case_.run.courant;
    double changed = started_ > 0.0 ? 0.0 : courant;
    if (formulas_.vary()) {
      dt = std::min(dt, kStepOfPulse * case_.run.end_time);  // what comes and goes must not be stepped over
      for (int n = 0; n < 100 && formulas_.change(time, dt) > courant; ++n) dt *= 0.5;
      changed = std::max(changed, formulas_.change(time, dt));
    }
    if (changed > 0.25 * courant)
      for (int n = 0; n < 100 && !(try_step(time, dt) <= 1.25 * courant); ++n) dt *= 0.5;
    return dt;
  }
  /// The Courant number that a step without bodies would reach. What is kept is all that a resume needs.
  double try_step(double time, double dt) {
    std::vector<Field> kept;
    for (const NamedField& f : solver_->state()) kept.push_back(*f.field);
    std::vector<double> numbers;
    for (const double* v : solver_->state_numbers()) numbers.push_back(*v);
    const BoundaryLedger ledger = solver_->ledger();
    double reached = 1e30;
    try {
      CutCells none;
      set_boundaries(time + 0.5 * dt);
      solver_->advance(dt, none);
      set_boundaries(time + dt);
      reached = dt / solver_->stable_dt(1.0);
    } catch (const DivergedError&) {  // much too long
    }
    std::size_t n = 0;
    for (const NamedField& f : solver_->state()) *f.field = kept[n++];
    n = 0;
    for (double* v : solver_->state_numbers()) *v = numbers[n++];
    solver_->ledger() = ledger;
    solver_->resume();
    set_boundaries(time);
    solver_->stable_dt(case_.run.courant);  // which also says how a step is to be taken
    return reached;
  }

  /// What the jet brings to each cell of its face. The jet's velocity is that of air of the ambient density
  /// with the same momentum; here rho w^2 is kept, and the total temperature is that of the ambient, of which
  /// a jet some tens of orifices away consists (Crocco: it is even where the reservoir has it too): w^2 = M R
  /// T0 / (p + M R/(2 cp)), M = rho_a w_a^2.
  void set_jet_states(double time) {
    const Gas& gas = solver_->options().gas;
    const double r = gas.gas_constant, cp = gas.specific_heat_pressure();
    const double pressure = case_.environment.pressure, total = case_.environment.temperature;
    const double ambient = pressure / (r * total);
    const auto state = [&](const Vec3& at) {
      const Vec3 on_plane = grid_.axisymmetric() ? Vec3(at.x(), case_.jet.nozzle.y(), at.z()) : at;
      const InflowState jet = inflow_.at(on_plane, half_widths(grid_, at), time);
      const double momentum = ambient * jet.velocity.squaredNorm();
      const double square = momentum * r * total / (pressure + 0.5 * momentum * r / cp);
      GasState s;
      s.pressure = pressure;
      s.density = pressure / (r * (total - 0.5 * square / cp));
      if (momentum > 0.0) s.velocity = std::sqrt(square / jet.velocity.squaredNorm()) * jet.velocity;
      const StateSpec still;
      const GasState around = gas_state(case_, still, at, time);
      s.k = std::max(jet.k, around.k);
      const double epsilon = std::max(jet.epsilon, still_epsilon(around));
      s.e = case_.flow.turbulence == TurbulenceModel::k_omega_sst ? omega_of(s.k, epsilon) : epsilon;
      return s;
    };
    solver_->boundaries().set_states(inflow_.face, std::cref(state));  // a reference: nothing is allocated
  }
  double still_epsilon(const GasState& s) const {
    return case_.flow.turbulence == TurbulenceModel::k_omega_sst ? epsilon_of(s.k, s.e) : s.e;
  }
  double fastest() const {
    const auto u = view(kU), v = view(kV), w = view(kW);
    return std::sqrt(double(reduce_max(
        grid_.range(), [=](int i, int j, int k) __attribute__((always_inline)) {
          return u(i, j, k) * u(i, j, k) + v(i, j, k) * v(i, j, k) + w(i, j, k) * w(i, j, k);
        })));
  }
  ConstFieldView view(Component c) const { return solver_->primitive()[static_cast<std::size_t>(c)].view(); }
  /// Volume-weighted mean and largest error of a scalar against a formula.
  template <class Value>
  void add_errors(std::vector<Figure>& all, const std::string& name, const std::string& formula,
                  const Value& value) const {
    const Expression exact(formula);
    double sum = 0.0, square = 0.0, volume = 0.0, largest = 0.0;
    for (int k = 0; k < grid_.nz(); ++k)
      for (int j = 0; j < grid_.ny(); ++j)
        for (int i = 0; i < grid_.nx(); ++i) {
          const Vec3 x = grid_.centre(i, j, k);
          const double e = std::abs(value(solver_->at(i, j, k)) - exact(x.x(), x.y(), x.z(), time_));
          const double v = grid_.volume(i, j, k);
          sum += v * e;
          square += v * e * e;
          volume += v;
          largest = std::max(largest, e);
        }
    all.push_back({"errors", name + "_l1", {sum / volume}});
    all.push_back({"errors", name + "_l2", {std::sqrt(square / volume)}});
    all.push_back({"errors", name + "_max", {largest}});
  }
  bool turbulent() const { return case_.flow.turbulence != TurbulenceModel::laminar; }

  const Case& case_;
  const Grid& grid_;
  const Inflow inflow_;
  FormulaFaces formulas_;
  std::vector<DrivenInlet> inlets_;
  std::unique_ptr<GasFlow> solver_;
  Vec3 momentum_at_start_{0, 0, 0};
  double mass_at_start_ = 0.0, energy_at_start_ = 0.0, seconds_ = 0.0, time_ = 0.0;
  double fastest_ = 0.0;  ///< m/s, anywhere at any time
  double started_ = 0.0;  ///< 1 after the first step
  std::int64_t calls_ = 0;
};

}  // namespace

std::unique_ptr<FlowModel> make_compressible_model(const Case& c, const Grid& grid, Inflow inflow) {
  return std::make_unique<CompressibleModel>(c, grid, std::move(inflow));
}

}  // namespace ejecta
