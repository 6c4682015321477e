#include <numbers>

#include "flow/godunov/solver.hpp"

namespace ejecta::godunov {

void Solver::add_to_ledger(double seconds) {
  const double around = grid_.axisymmetric() ? 2.0 * std::numbers::pi : 1.0;
  const std::array<Metrics, 3> m{grid_.metrics(0), grid_.metrics(1), grid_.metrics(2)};
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) continue;
    const int a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
    const Block& f = flux(d);
    for (int side = 0; side < 2; ++side) {
      const int at = side ? grid_.n(d) : 0;
      const double inward =
          (side ? -1.0 : 1.0) * seconds * around * double(m[static_cast<std::size_t>(d)].area[at]);
      for (int q = 0; q < grid_.n(b); ++q)
        for (int p = 0; p < grid_.n(a); ++p) {
          std::array<int, 3> cell{};
          cell[static_cast<std::size_t>(d)] = at;
          cell[static_cast<std::size_t>(a)] = p;
          cell[static_cast<std::size_t>(b)] = q;
          const double through = inward * double(m[static_cast<std::size_t>(a)].volume[p]) *
                                 double(m[static_cast<std::size_t>(b)].volume[q]);
          const auto value = [&](int c) {
            return through * double(f[static_cast<std::size_t>(c)](cell[0], cell[1], cell[2]));
          };
          const double mass = value(kRho);
          ledger_.mass += mass;
          ledger_.mass_inward += mass > 0.0 ? mass : 0.0;
          ledger_.energy += value(kP);
          ledger_.momentum += Vec3(value(kU), value(kV), value(kW));
        }
    }
  }
}

std::vector<Field*> Solver::state() {
  std::vector<Field*> fields;
  for (Field& f : u_) fields.push_back(&f);
  for (Field& f : w_) fields.push_back(&f);
  fields.push_back(&eddy_viscosity_);
  fields.push_back(&f1_);
  return fields;
}

}  // namespace ejecta::godunov
