#include "flow/piso/forcing.hpp"

namespace ejecta {
namespace {

/// u at the image point of a solid cell, trilinear.
Real image_velocity(const SolidCell& c, ConstFieldView u) {
  const Real* p = &u(c.image_i, c.image_j, c.image_k);
  const auto [x, y, z] = c.fraction;
  const auto along_x = [&](const Real* q) { return q[0] + x * (q[1] - q[0]); };
  const auto along_y = [&](const Real* q) {
    const Real low = along_x(q);
    return low + y * (along_x(q + u.sy) - low);
  };
  const Real low = along_y(p);
  return low + z * (along_y(p + u.sz) - low);
}

}  // namespace

void aim_at_solids(SolidMask& solids, const std::array<ConstFieldView, 3>& u) {
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    for (int d = 0; d < 3; ++d) {
      Real target = c.solid[d];
      if (c.ratio != Real(0)) target += c.ratio * (image_velocity(c, u[d]) - c.solid[d]);
      solids.target[static_cast<std::size_t>(n)][d] = target;
    }
  });
}

void force_solids(const Grid& grid, SolidMask& solids, double density, std::array<FieldView, 3> u) {
  aim_at_solids(solids, {u[0], u[1], u[2]});
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const double mass = density * grid.volume(c.i, c.j, c.k);
    for (int d = 0; d < 3; ++d) {
      Real& value = u[d](c.i, c.j, c.k);
      const Real change = c.weight * (solids.target[static_cast<std::size_t>(n)][d] - value);
      value += change;
      solids.impulse[static_cast<std::size_t>(n)][d] += mass * double(change);
    }
  });
}

}  // namespace ejecta
