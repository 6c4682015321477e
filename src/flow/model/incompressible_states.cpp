#include "flow/model/incompressible_states.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "flow/turbulence/scales.hpp"

namespace ejecta {
namespace {

BoundaryState jet_state(const Grid& grid, const StillAir& air, const Inflow& inflow, const Vec3& x,
                        double t) {
  const InflowState jet = inflow.at(x, half_widths(grid, x), t);
  BoundaryState s;
  for (int d = 0; d < 3; ++d) s.velocity[static_cast<std::size_t>(d)] = static_cast<Real>(jet.velocity[d]);
  const double k = std::max(jet.k, air.k);
  const double epsilon = jet.k > air.k ? jet.epsilon : epsilon_with(k, air.nu);
  s.k = static_cast<Real>(k);
  s.dissipation = static_cast<Real>(air.omega ? epsilon / (kCmu * k) : epsilon);
  return s;
}

}  // namespace

StillAir::StillAir(const Case& c)
    : density(c.fluid.density),
      nu(c.fluid.viscosity / c.fluid.density),
      omega(c.flow.turbulence == TurbulenceModel::k_omega_sst),
      k(1e-4),
      dissipation(omega ? k / nu : epsilon_with(k, nu)) {}

StateFormula::StateFormula(const StateSpec& s, const StillAir& air) : still_(air) {
  if (s.velocity)
    for (std::size_t d = 0; d < 3; ++d) {
      velocity[d] = Expression((*s.velocity)[d]);
      varies = varies || velocity[d].uses_time();
    }
  has_velocity = s.velocity.has_value();
  if (s.k) k_ = Expression(*s.k);
  if (s.epsilon) epsilon_ = Expression(*s.epsilon);
  varies = varies || (k_ && k_->uses_time()) || (epsilon_ && epsilon_->uses_time());
}

StateFormula::Turbulence StateFormula::turbulence_at(const Vec3& x, double t) const {
  Turbulence s{still_.k, still_.dissipation};
  // A constant keeps its meaning: k = 0 lets the turbulence inside through.
  const auto value = [&](const Expression& f, double still) {
    const double v = f(x.x(), x.y(), x.z(), t);
    return f.is_constant() || v > 0.0 ? v : still;
  };
  if (k_) s.k = value(*k_, still_.k);
  if (epsilon_) {
    const double epsilon = value(*epsilon_, epsilon_with(still_.k, still_.nu));
    s.dissipation = still_.omega ? epsilon / (kCmu * s.k) : epsilon;
  }
  return s;
}

Boundary make_boundary(const Case& c, const Grid& grid, const StillAir& air, const Inflow& inflow, int face) {
  const BoundarySpec& spec = c.boundary[static_cast<std::size_t>(face)];
  const StateFormula formula(spec.state, air);
  Boundary b;
  b.varies = formula.varies;
  const auto with_turbulence = [](BoundaryState s, const StateFormula::Turbulence& turbulence) {
    s.k = static_cast<Real>(turbulence.k);
    s.dissipation = static_cast<Real>(turbulence.dissipation);
    return s;
  };
  std::function<BoundaryState(const Vec3&, double)> outside;  // of an open face, apart from discs in it
  const bool axis = grid.axisymmetric() && face == 0 && grid.lower().x() == 0.0;
  switch (axis ? BoundaryType::symmetry : spec.type) {
    case BoundaryType::slip:
    case BoundaryType::symmetry:
      b.kind = BoundaryKind::mirror;
      return b;
    case BoundaryType::periodic:
      b.kind = BoundaryKind::periodic;
      return b;
    case BoundaryType::pressure_outlet:
    case BoundaryType::wave_transmissive:
    case BoundaryType::free_stream:
    case BoundaryType::total_pressure: {
      b.kind = BoundaryKind::open;
      b.total_pressure = spec.type == BoundaryType::total_pressure;
      const double ambient = c.environment.pressure;
      const double stagnation =
          b.total_pressure && spec.total_pressure > 0.0 ? spec.total_pressure - ambient : 0.0;
      const auto given = spec.state.pressure ? std::optional(Expression(*spec.state.pressure)) : std::nullopt;
      b.varies = b.varies || (given && given->uses_time());
      b.discs = !spec.patches.empty();
      outside = [=](const Vec3& x, double t) {
        BoundaryState s;
        s.pressure = static_cast<Real>((given ? (*given)(x.x(), x.y(), x.z(), t) : stagnation) / air.density);
        return with_turbulence(s, formula.turbulence_at(x, t));
      };
      break;
    }
    case BoundaryType::wall:
    case BoundaryType::moving_wall:
      b.kind = spec.patches.empty() ? BoundaryKind::wall : BoundaryKind::inflow;
      break;
    case BoundaryType::velocity:
    case BoundaryType::jet:
      b.kind = BoundaryKind::inflow;
      break;
  }
  struct Piece {
    Vec3 centre;
    double radius;
    bool jet;
    StateFormula formula;
  };
  std::vector<Piece> pieces;
  for (const PatchSpec& p : spec.patches) {
    pieces.push_back({p.centre, p.radius, p.type == BoundaryType::jet, StateFormula(p.state, air)});
    b.varies = b.varies || pieces.back().jet || pieces.back().formula.varies;
  }
  const bool whole_jet = spec.type == BoundaryType::jet;
  b.varies = b.varies || whole_jet;
  b.state = [=, &c, &grid, &inflow](Vec3 x, double t) {
    if (grid.axisymmetric()) x.y() = c.jet.nozzle.y();  // all around is in the one cell
    const Piece* piece = nullptr;
    for (const Piece& p : pieces)
      if ((x - p.centre).norm() <= p.radius) piece = &p;
    if (!piece && outside) return outside(x, t);
    BoundaryState s;
    if (piece ? piece->jet : whole_jet) {
      s = jet_state(grid, air, inflow, x, t);
    } else {
      const StateFormula& f = piece ? piece->formula : formula;
      const Vec3 v = f.at(x, t);
      for (int d = 0; d < 3; ++d) s.velocity[static_cast<std::size_t>(d)] = static_cast<Real>(v[d]);
      s = with_turbulence(s, f.turbulence_at(x, t));
    }
    s.prescribed = outside != nullptr;
    return s;
  };
  return b;
}

}  // namespace ejecta
