#include "flow/godunov/from_case.hpp"

#include <algorithm>
#include <limits>

#include "case/expression.hpp"
#include "flow/godunov/solver.hpp"
#include "flow/godunov/turbulence_kernel.hpp"
#include "flow/piso/compressible.hpp"

namespace ejecta::godunov {
namespace {

/// Turbulence of air called still, m2/s2; its epsilon is such that its eddy viscosity equals the molecular
/// one.
constexpr double kStillK = 1e-4;

double value(const std::optional<std::string>& text, double otherwise, const Vec3& x, double t) {
  return text ? Expression(*text)(x.x(), x.y(), x.z(), t) : otherwise;
}

/// Initial gas at a point: the regions of the case in order.
GasState initial_state(const Case& c, const Vec3& x) {
  StateSpec spec;
  for (const InitialSpec& region : c.initial) {
    if (region.box) {
      const Vec3 low = (*region.box)[0].cwiseMin((*region.box)[1]);
      const Vec3 high = (*region.box)[0].cwiseMax((*region.box)[1]);
      if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) continue;
    }
    spec = region.state;
  }
  return gas_state(c, spec, x, 0.0);
}

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
double reference_pressure(const Case& c, const Grid& grid) {
  double lowest = std::numeric_limits<double>::max(), highest = 0.0;
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        const double p = initial_state(c, grid.centre(i, j, k)).pressure;
        lowest = std::min(lowest, p);
        highest = std::max(highest, p);
      }
  const double ambient = c.environment.pressure;
  return ambient >= lowest && ambient <= highest ? ambient : lowest;
}

}  // namespace

GasState gas_state(const Case& c, const StateSpec& spec, const Vec3& x, double t) {
  GasState s;
  s.pressure = value(spec.pressure, c.environment.pressure, x, t);
  const double temperature = value(spec.temperature, c.environment.temperature, x, t);
  s.density = value(spec.density, s.pressure / (c.fluid.gas_constant * temperature), x, t);
  if (spec.velocity)
    for (int d = 0; d < 3; ++d)
      s.velocity[d] = Expression((*spec.velocity)[static_cast<std::size_t>(d)])(x.x(), x.y(), x.z(), t);
  s.k = std::max(value(spec.k, kStillK, x, t), 0.0);
  const double still = double(k_epsilon::kCmu) * s.k * s.k * s.density / c.fluid.viscosity;
  s.e = std::max(value(spec.epsilon, c.fluid.viscosity > 0.0 ? still : 0.0, x, t), 0.0);
  if (c.flow.turbulence == TurbulenceModel::k_omega_sst) s.e = omega_of(s.k, s.e);
  return s;
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

std::unique_ptr<GasFlow> solver_from_case(const Case& c, const Grid& grid, std::vector<DrivenInlet>& inlets) {
  Options options = options_from_case(c);
  options.reference_pressure = reference_pressure(c, grid);
  std::unique_ptr<GasFlow> solver;
  if (c.flow.solver == FlowSolver::compressible_piso)
    solver = std::make_unique<piso::Compressible>(grid, options);
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
      if (p.type == BoundaryType::jet) inlets.push_back({face, disc, p.centre, p.radius});
    }
  }
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) solver->set(i, j, k, initial_state(c, grid.centre(i, j, k)));
  return solver;
}

}  // namespace ejecta::godunov
