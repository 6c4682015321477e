#include "flow/model/gas_from_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "case/initial.hpp"
#include "flow/gas/turbulence_kernel.hpp"
#include "flow/godunov/solver.hpp"
#include "flow/piso/compressible.hpp"
#include "flow/turbulence/scales.hpp"

namespace ejecta::gas {
namespace {

/// Turbulence of air called still, m2/s2; its epsilon is such that its eddy viscosity equals the molecular
/// one.
constexpr double kStillK = 1e-4;

/// Initial gas at a point: what the regions of the case that hold it say together.
class InitialGas {
 public:
  explicit InitialGas(const Case& c) : case_(c) {}
  GasState at(const Vec3& x) {
    const std::vector<int> regions = regions_at(case_, x);
    auto known = formulas_.find(regions);
    if (known == formulas_.end())
      known = formulas_.emplace(regions, GasFormula(case_, merged(case_, regions))).first;
    return known->second.at(x, 0.0);
  }

 private:
  const Case& case_;
  std::map<std::vector<int>, GasFormula> formulas_;
};

Condition condition_of(const Case& c, BoundaryType type, const StateSpec& state, double total_pressure,
                       double total_temperature, const Vec3& position) {
  Condition condition;
  condition.type = type;
  condition.state = gas_state(c, state, position, 0.0);
  condition.total_pressure = total_pressure > 0.0 ? total_pressure : c.environment.pressure;
  condition.total_temperature = total_temperature > 0.0 ? total_temperature : c.environment.temperature;
  return condition;
}

/// The pressure from which the solver counts: that of the environment where the gas starts from it, else the
/// lowest of the initial state.
double reference_pressure(const Case& c, const Grid& grid, InitialGas& initial) {
  double lowest = std::numeric_limits<double>::max(), highest = 0.0;
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        const double p = initial.at(grid.centre(i, j, k)).pressure;
        lowest = std::min(lowest, p);
        highest = std::max(highest, p);
      }
  const double ambient = c.environment.pressure;
  return ambient >= lowest && ambient <= highest ? ambient : lowest;
}

}  // namespace

GasFormula::GasFormula(const Case& c, const StateSpec& spec) : case_(c) {
  if (spec.pressure) pressure_.emplace(*spec.pressure);
  if (spec.temperature) temperature_.emplace(*spec.temperature);
  if (spec.density) density_.emplace(*spec.density);
  if (spec.k) k_.emplace(*spec.k);
  if (spec.epsilon) epsilon_.emplace(*spec.epsilon);
  if (spec.velocity) {
    velocity_.emplace();
    for (std::size_t d = 0; d < 3; ++d) (*velocity_)[d] = Expression((*spec.velocity)[d]);
  }
}

GasState GasFormula::at(const Vec3& x, double t) const {
  const auto value = [&](const std::optional<Expression>& f, double otherwise) {
    return f ? (*f)(x.x(), x.y(), x.z(), t) : otherwise;
  };
  GasState s;
  s.pressure = value(pressure_, case_.environment.pressure);
  const double temperature = value(temperature_, case_.environment.temperature);
  s.density = value(density_, s.pressure / (case_.fluid.gas_constant * temperature));
  if (velocity_)
    for (int d = 0; d < 3; ++d)
      s.velocity[d] = (*velocity_)[static_cast<std::size_t>(d)](x.x(), x.y(), x.z(), t);
  // What a formula makes less than nothing, or no number of, counts as still air; a constant keeps its
  // meaning.
  const auto turbulent = [&](const std::optional<Expression>& f, double still) {
    const double v = value(f, still);
    return (f && f->is_constant()) || v > 0.0 ? v : still;
  };
  s.k = turbulent(k_, kStillK);
  const double viscosity = case_.fluid.viscosity;
  const double still = double(k_epsilon::kCmu) * s.k * s.k * s.density / viscosity;
  s.e = turbulent(epsilon_, viscosity > 0.0 ? still : 0.0);
  if (case_.flow.turbulence == TurbulenceModel::k_omega_sst) s.e = omega_of(s.k, s.e);
  return s;
}

template <class Visit>
bool GasFormula::any(const Visit& visit) const {
  for (const auto* f : {&pressure_, &temperature_, &density_, &k_, &epsilon_})
    if (*f && visit(**f)) return true;
  return velocity_ && std::any_of(velocity_->begin(), velocity_->end(), visit);
}

bool GasFormula::is_constant() const {
  return !any([](const Expression& f) { return !f.is_constant(); });
}
bool GasFormula::uses_time() const {
  return any([](const Expression& f) { return f.uses_time(); });
}

GasState gas_state(const Case& c, const StateSpec& spec, const Vec3& x, double t) {
  return GasFormula(c, spec).at(x, t);
}

FormulaFaces::FormulaFaces(const Case& c, const Grid& grid) : grid_(grid) {
  for (int face = 0; face < 6; ++face) {
    const BoundarySpec& b = c.boundary[static_cast<std::size_t>(face)];
    GasFormula formula(c, b.state);
    if (!grid.active(face / 2) || b.type == BoundaryType::jet || formula.is_constant()) continue;
    vary_ = vary_ || formula.uses_time();
    faces_.push_back({face, std::move(formula)});
  }
}

void FormulaFaces::apply(double time, GasFlow& flow) const {
  for (const Face& f : faces_)
    flow.boundaries().set_states(f.face, [&](const Vec3& x) { return f.formula.at(x, time); });
}

double FormulaFaces::change(double time, double dt) const {
  constexpr int kLooks = 8;  // within the step
  double most = 0.0;
  for (const Face& f : faces_) {
    if (!f.formula.uses_time()) continue;
    const int d = f.face / 2;
    const Axis& axis = grid_.axis(d);
    const double h = f.face % 2 ? axis.width.back() : axis.width.front();
    for_each_face_cell(grid_, f.face, [&](std::size_t, const int(&at)[3]) {
      Vec3 x = grid_.centre(std::min(at[0], grid_.nx() - 1), std::min(at[1], grid_.ny() - 1),
                            std::min(at[2], grid_.nz() - 1));
      x[d] = f.face % 2 ? grid_.upper()[d] : grid_.lower()[d];
      const GasState now = f.formula.at(x, time);
      for (int look = 1; look <= kLooks; ++look) {
        const GasState then = f.formula.at(x, time + dt * look / kLooks);
        const double pushed = std::sqrt(2.0 * std::abs(then.pressure - now.pressure) / now.density);
        most = std::max({most, dt * (then.velocity - now.velocity).norm() / h, dt * pushed / h});
      }
    });
  }
  return most;
}

double omega_of(double k, double epsilon) {
  return epsilon / (double(k_omega_sst::kBetaStar) * std::max(k, double(kLeastK)));
}

double epsilon_of(double k, double omega) { return double(k_omega_sst::kBetaStar) * k * omega; }

Options options_from_case(const Case& c) {
  Options o;
  o.gas = {c.fluid.gamma, c.fluid.gas_constant};
  o.viscosity = c.fluid.viscosity;
  o.prandtl = c.fluid.prandtl;
  o.prandtl_turbulent = c.fluid.prandtl_turbulent;
  o.turbulence = c.flow.turbulence;
  o.round_jet_correction = c.flow.round_jet_correction;
  o.compressibility_correction = c.flow.compressibility_correction;
  return o;
}

void drive(GasFlow& flow, const std::vector<DrivenInlet>& inlets, const Supply& supply) {
  const bool omega = flow.options().turbulence == TurbulenceModel::k_omega_sst;
  for (const DrivenInlet& inlet : inlets) {
    Condition& condition = flow.boundaries().condition(inlet.handle);
    condition.total_pressure = supply.total_pressure;
    condition.total_temperature = supply.total_temperature;
    if (supply.fluctuation <= 0.0) {
      condition.state.k = inlet.still_k;
      condition.state.e = inlet.still_e;
      continue;
    }
    condition.state.k = 1.5 * supply.fluctuation * supply.fluctuation;
    condition.state.e = epsilon_of_pipe(condition.state.k, 2.0 * inlet.radius);
    if (omega) condition.state.e = omega_of(condition.state.k, condition.state.e);
  }
}

std::unique_ptr<GasFlow> solver_from_case(const Case& c, const Grid& grid, std::vector<DrivenInlet>& inlets) {
  Options options = options_from_case(c);
  InitialGas initial(c);
  options.reference_pressure = reference_pressure(c, grid, initial);
  std::unique_ptr<GasFlow> solver;
  if (c.flow.solver == FlowSolver::compressible_piso)
    solver = std::make_unique<gas::Compressible>(grid, options);
  else solver = std::make_unique<Solver>(grid, options);
  for (int face = 0; face < 6; ++face) {
    const BoundarySpec& b = c.boundary[static_cast<std::size_t>(face)];
    Vec3 middle = 0.5 * (grid.lower() + grid.upper());
    middle[face / 2] = face % 2 ? grid.upper()[face / 2] : grid.lower()[face / 2];
    const bool axis = grid.axisymmetric() && face == 0 && grid.lower().x() == 0.0;
    const BoundaryType type = axis || !grid.active(face / 2) ? BoundaryType::symmetry : b.type;
    solver->boundaries().set_face(face, condition_of(c, b.type == BoundaryType::periodic ? b.type : type,
                                                     b.state, b.total_pressure, b.total_temperature, middle));
    for (const PatchSpec& p : b.patches) {
      const BoundaryType opened = p.type == BoundaryType::jet ? BoundaryType::total_pressure : p.type;
      const Condition condition =
          condition_of(c, opened, p.state, p.total_pressure, p.total_temperature, p.centre);
      const int disc = solver->boundaries().add_disc(face, p.centre, p.radius, condition);
      if (p.type == BoundaryType::jet)
        inlets.push_back({face, disc, p.centre, p.radius, condition.state.k, condition.state.e});
    }
  }
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) solver->set(i, j, k, initial.at(grid.centre(i, j, k)));
  FormulaFaces(c, grid).apply(0.0, *solver);
  return solver;
}

}  // namespace ejecta::gas
