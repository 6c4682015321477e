#pragma once
#include <array>
#include <type_traits>

#include "base/parallel.hpp"
#include "flow/fluid_fraction.hpp"
#include "flow/stencil.hpp"
#include "grid/grid.hpp"

/// What grains smaller than a cell and the fluid give each other in a step, whatever solver computes it.
namespace ejecta {

/// div tau of a row as viscosity times the Laplacian of a component of the velocity: whatever it is, what the
/// grains get the fluid loses.
template <bool kTurbulent>
struct FrictionRow {
  const Real *u, *eddy;
  std::ptrdiff_t sy, sz;
  Metrics x, y, z;
  Real on_x, on_y, on_z, viscosity;
  int j, k;

  EJECTA_KERNEL static Real second(const Real* at, std::ptrdiff_t s, const Metrics& m, int n) {
    return ((at[s] - at[0]) * m.inv_distance[n + 1] - (at[0] - at[-s]) * m.inv_distance[n]) * m.inv_width[n];
  }
  EJECTA_KERNEL Real operator()(int i) const {
    const Real* at = u + i;
    const Real sum = on_x * second(at, 1, x, i) + on_y * second(at, sy, y, j) + on_z * second(at, sz, z, k);
    if constexpr (kTurbulent) return (viscosity + eddy[i]) * sum;
    else return viscosity * sum;
  }
};

/// use(j, k, c, friction of the row) for every row of every component of the velocity. eddy: its viscosity,
/// in the unit of `viscosity`; origin null: laminar.
template <class Use>
void for_each_friction_row(const Grid& grid, const std::array<ConstFieldView, 3>& u, ConstFieldView eddy,
                           double viscosity, const Use& use) {
  const auto go = [&]<bool kTurbulent>(std::bool_constant<kTurbulent>) {
    for_each_index(grid.nz(), [&](int k) {
      for (int j = 0; j < grid.ny(); ++j)
        for (std::size_t c = 0; c < 3; ++c)
          use(j, k, c,
              FrictionRow<kTurbulent>{u[c].row(j, k), kTurbulent ? eddy.row(j, k) : nullptr, u[c].sy, u[c].sz,
                                      grid.metrics(0), grid.metrics(1), grid.metrics(2), Real(grid.active(0)),
                                      Real(grid.active(1)), Real(grid.active(2)),
                                      static_cast<Real>(viscosity), j, k});
    });
  };
  eddy.origin ? go(std::true_type{}) : go(std::false_type{});
}

/// What grains see of a flow in which they take no room: f.push, -grad p + div tau times `scale`, and f.seen
/// where they do not act on it. p and u with ghosts; p, viscosities and scale in any units that make m/s2
/// together.
void find_undisplaced(const Grid& grid, ConstFieldView p, const std::array<ConstFieldView, 3>& u,
                      ConstFieldView eddy, double viscosity, double scale, FluidFraction& f);

/// What the grains took from the fluid in a step, from its fields, not from the grains.
struct TakenByGrains {
  Vec3 force{0, 0, 0};  ///< over the density that f is normalised with, m4/s2
  double volume = 0;    ///< m3
};
/// part: of each cell whose momentum is the fluid's, for grains that drag it but take no room of it; origin
/// null: they take room. acceleration: m/s2, of the fluid.
TakenByGrains taken_by_grains(const Grid& grid, const FluidFraction& f, const Vec3& acceleration,
                              ConstFieldView part);

}  // namespace ejecta
