#include "flow/piso/forcing.hpp"

#include "flow/stencil.hpp"

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

void force_solids(const Grid& grid, SolidMask& solids, double weight, std::array<FieldView, 3> u) {
  const int count = static_cast<int>(solids.cells.size());
  for_each_index(count, [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    for (int d = 0; d < 3; ++d) {
      Real target = c.solid[d];
      if (c.ratio != Real(0)) target += c.ratio * (image_velocity(c, u[d]) - c.solid[d]);
      solids.target[static_cast<std::size_t>(n)][d] = target;
    }
  });
  for_each_index(count, [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const double volume = grid.volume(c.i, c.j, c.k);
    for (int d = 0; d < 3; ++d) {
      Real& value = u[d](c.i, c.j, c.k);
      const Real change = c.weight * (solids.target[static_cast<std::size_t>(n)][d] - value);
      value += change;
      solids.impulse[static_cast<std::size_t>(n)][d] += weight * volume * double(change);
    }
  });
}

void face_velocities_at_solids(const Grid& grid, const SolidMask& solids, ConstFieldView inside_solid,
                               std::array<ConstFieldView, 3> u, std::array<FieldView, 3> q) {
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const int at[3] = {c.i, c.j, c.k};
    for (int d = 0; d < 3; ++d) {
      if (!grid.active(d)) continue;
      const Metrics m = grid.metrics(d);
      const std::ptrdiff_t s = stride(u[d], d);
      for (int side = 0; side < 2; ++side) {
        const int face = at[d] + side;
        if (face == 0 || face == grid.n(d)) continue;
        const Real* high = &u[d](c.i, c.j, c.k) + (side ? s : 0);
        Real& face_velocity = *(&q[d](c.i, c.j, c.k) + (side ? s : 0));
        // Inside the solid the rigid velocity itself, which is free of divergence (and does not vary along
        // d).
        const Real inside = c.weight * (&inside_solid(c.i, c.j, c.k))[side ? s : -s];
        const Real mean = m.weight[face] * high[-s] + (Real(1) - m.weight[face]) * high[0];
        face_velocity = mean + inside * (c.solid[d] - mean);
      }
    }
  });
}

}  // namespace ejecta
