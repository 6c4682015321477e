#include "flow/gas/gas_flow.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace ejecta::gas {

Block GasFlow::make_block(const Grid& grid) {
  Block b;
  for (Field& f : b) f = grid.make_field();
  return b;
}

GasFlow::GasFlow(const Grid& grid, const Options& options)
    : grid_(grid),
      options_(options),
      gas_(options.gas.gamma, options.gas.gas_constant, options.reference_pressure),
      geometry_(grid),
      boundaries_(grid, gas_),
      u_(make_block(grid)),
      w_(make_block(grid)),
      next_(make_block(grid)),
      flux_{make_block(grid), make_block(grid), make_block(grid)},
      eddy_viscosity_(grid.make_field()),
      f1_(grid.make_field()),
      solid_distance_(grid) {
  const double cp = options.gas.specific_heat_pressure();
  diffusion_.viscosity = Real(options.viscosity);
  diffusion_.conductivity = Real(options.viscosity * cp / options.prandtl);
  diffusion_.conductivity_t = Real(cp / options.prandtl_turbulent);
  // Explicit diffusion is stable for dt <= h^2/(2 nu); heat diffuses fastest, with gamma/Pr of the momentum.
  diffusion_.fastest = Real(2.0 * options.gas.gamma / options.prandtl);
  diffusion_.fastest_t = Real(2.0 * options.gas.gamma / options.prandtl_turbulent);
  set_turbulence_constants();
}

void GasFlow::advance(double, CutCells&, FluidFraction&) { throw Error("this solver knows no grains"); }

void GasFlow::expect_grains(double) { throw Error("this solver knows no grains"); }

void GasFlow::set(int i, int j, int k, const GasState& s) {
  const double p = s.pressure - options_.reference_pressure;
  const std::array<double, kComponents> primitive{
      s.density, s.velocity.x(), s.velocity.y(), s.velocity.z(), p, s.k, s.e};
  const double energy = p / (options_.gas.gamma - 1.0) + 0.5 * s.density * s.velocity.squaredNorm();
  for (std::size_t c = 0; c < kComponents; ++c) {
    w_[c](i, j, k) = Real(primitive[c]);
    u_[c](i, j, k) = Real(c == kRho ? s.density : c == kP ? energy : s.density * primitive[c]);
  }
}

GasState GasFlow::at(int i, int j, int k) const {
  const auto v = [&](int c) { return double(w_[static_cast<std::size_t>(c)](i, j, k)); };
  return {v(kRho), {v(kU), v(kV), v(kW)}, v(kP) + options_.reference_pressure, v(kK), v(kE)};
}

void GasFlow::report_divergence() const {
  for (int k = 0; k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i) {
        const GasState s = at(i, j, k);
        if (s.density > 0.0 && s.pressure > 0.0 && std::isfinite(s.velocity.sum())) continue;
        const Vec3 x = grid_.centre(i, j, k);
        throw DivergedError(
            fmt::format("the gas at ({:.4g}, {:.4g}, {:.4g}) m has density {:.4g} kg/m3 and pressure {:.4g} "
                        "Pa; try a smaller "
                        "run.courant",
                        x.x(), x.y(), x.z(), s.density, s.pressure));
      }
  throw DivergedError("no stable time step: a velocity or an eddy viscosity is no number");
}

double GasFlow::total(Component c) const {
  const Metrics x = grid_.metrics(0), y = grid_.metrics(1), z = grid_.metrics(2);
  const auto u = u_[static_cast<std::size_t>(c)].view();
  const double around = grid_.axisymmetric() ? 2.0 * std::numbers::pi : 1.0;
  const ConstFieldView gas = part();
  return around * reduce_sum(grid_.range(), [=](int i, int j, int k) {
           const double share = gas.origin ? double(gas(i, j, k)) : 1.0;
           return share * double(u(i, j, k)) * double(x.volume[i]) * double(y.volume[j]) *
                  double(z.volume[k]);
         });
}

Contents GasFlow::contents() const {
  return {total(kRho), {total(kU), grid_.active(1) ? total(kV) : 0.0, total(kW)}, total(kP)};
}

void GasFlow::add_to_ledger(double seconds, const CutCells& cut) {
  const auto closed = [&](int d, int face, const int(&at)[3]) {
    if (cut.empty()) return 0.0;
    int inside[3] = {at[0], at[1], at[2]};
    inside[d] -= face % 2;
    const int index = cut.index(inside[0], inside[1], inside[2]);
    if (index > 0 && cut.cells[static_cast<std::size_t>(index - 1)].carrier < 0) return 1.0;  // locked in
    return double(cut.closed[static_cast<std::size_t>(d)](at[0], at[1], at[2]));
  };
  const double around = grid_.axisymmetric() ? 2.0 * std::numbers::pi : 1.0;
  const Metrics m[3]{grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2, a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
    if (!grid_.active(d)) continue;
    const double inward = (face % 2 ? -1.0 : 1.0) * seconds * around;
    const Block& f = flux(d);
    for_each_face_cell(grid_, face, [&](std::size_t, const int(&at)[3]) {
      const double through = (1.0 - closed(d, face, at)) * inward * double(m[d].area[at[d]]) *
                             double(m[a].volume[at[a]]) * double(m[b].volume[at[b]]);
      const auto value = [&](int c) {
        return through * double(f[static_cast<std::size_t>(c)](at[0], at[1], at[2]));
      };
      const double mass = value(kRho);
      ledger_.mass += mass;
      ledger_.mass_inward += mass > 0.0 ? mass : 0.0;
      ledger_.energy += value(kP);
      ledger_.momentum += Vec3(value(kU), value(kV), value(kW));
    });
  }
}

bool GasFlow::finite(Vec3* where) const {
  for (int k = 0; k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i) {
        const GasState s = at(i, j, k);
        // Eddies faster than sound are no turbulence: the model has run away.
        const bool runs_away = s.k * s.density > options_.gas.gamma * s.pressure;
        if (s.density > 0.0 && s.pressure > 0.0 && !runs_away &&
            std::isfinite(s.velocity.sum() + s.density + s.pressure))
          continue;
        if (where) *where = grid_.centre(i, j, k);
        return false;
      }
  return true;
}

std::vector<NamedField> GasFlow::state() {
  constexpr std::array kConserved{"density", "momentum_x", "momentum_y", "momentum_z",
                                  "energy",  "rho_k",      "rho_e"};
  constexpr std::array kPrimitive{"density_again", "velocity_x", "velocity_y", "velocity_z",
                                  "pressure",      "k",          "e"};
  std::vector<NamedField> fields;
  for (std::size_t c = 0; c < kComponents; ++c) fields.push_back({kConserved[c], &u_[c]});
  for (std::size_t c = 0; c < kComponents; ++c) fields.push_back({kPrimitive[c], &w_[c]});
  fields.push_back({"eddy_viscosity", &eddy_viscosity_});
  fields.push_back({"blending", &f1_});
  return fields;
}

}  // namespace ejecta::gas
