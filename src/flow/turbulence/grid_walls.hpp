#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "flow/stencil.hpp"
#include "flow/turbulence/wall_law.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// What walls do to the turbulence of a cell beside them.
struct WallShear {
  Real produced;  ///< of k, m2/s3
  Real strain2;   ///< 2 S_ij S_ij of the law of the wall, 1/s2: differences across a wall are no gradients
};

/// The faces of the box that are walls, and the cells beside them.
class GridWalls {
 public:
  /// u: velocities with ghosts that tell how fast walls move, m/s.
  GridWalls(const Grid& grid, const std::array<bool, 6>& is_wall, const std::array<ConstFieldView, 3>& u)
      : grid_(grid), is_wall_(is_wall), u_(u) {}

  /// Whether a row has cells beside walls.
  bool beside_row(int j, int k) const { return is_wall_[0] || is_wall_[1] || beside(1, j) || beside(2, k); }
  /// visit(i) for these cells.
  template <class Visit>
  void for_each_in_row(int j, int k, const Visit& visit) const {
    const int last = grid_.nx() - 1;
    if (beside(1, j) || beside(2, k)) {
      for (int i = 0; i <= last; ++i) visit(i);
      return;
    }
    if (is_wall_[0] || (is_wall_[1] && last == 0)) visit(0);
    if (is_wall_[1] && last > 0) visit(last);
  }
  /// visit(i, j, k) for all cells beside walls.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    if (std::none_of(is_wall_.begin(), is_wall_.end(), [](bool is) { return is; })) return;
    for_each_index(grid_.nz(), [&](int k) {
      for (int j = 0; j < grid_.ny(); ++j) for_each_in_row(j, k, [&](int i) { visit(i, j, k); });
    });
  }
  /// visit(face, distance, speed along it) for the walls of a cell, m, m/s.
  template <class Visit>
  void for_each_wall(int i, int j, int k, const Visit& visit) const {
    const std::array<int, 3> at{i, j, k};
    for (int face = 0; face < 6; ++face) {
      const int d = face / 2;
      std::array<int, 3> ghost = at;
      int& along = ghost[static_cast<std::size_t>(d)];
      if (!is_wall_[static_cast<std::size_t>(face)] || along != (face % 2 ? grid_.n(d) - 1 : 0)) continue;
      along += face % 2 ? 1 : -1;
      Real square = 0;
      for (int c = 0; c < 3; ++c) {
        const ConstFieldView& u = u_[static_cast<std::size_t>(c)];
        const Real slip = Real(0.5) * (u(i, j, k) - u(ghost[0], ghost[1], ghost[2]));
        if (c != d) square += slip * slip;
      }
      visit(face, Real(0.5) * grid_.metrics(d).width[at[static_cast<std::size_t>(d)]], std::sqrt(square));
    }
  }

  /// By the law of the wall, with this k (m2/s2); the mean of its walls in a corner. nu: m2/s.
  WallShear shear(int i, int j, int k_index, Real k, Real nu) const {
    WallShear sum{};
    Real count = 0;
    const Real star = wall_law::kQuarterCmu * std::sqrt(k);
    for_each_wall(i, j, k_index, [&](int, Real y, Real speed) {
      const Real stress = speed * wall_law::conductance(speed, y, nu, k, Real(0));
      const bool turbulent = wall_law::beyond_viscous_layer(y, nu, k, Real(0));
      const Real height = wall_law::kKappa * y;
      sum.produced += turbulent ? stress * star / height : Real(0);
      sum.strain2 += turbulent ? stress / (height * height) : (speed / y) * (speed / y);
      count += Real(1);
    });
    return {sum.produced / count, sum.strain2 / count};
  }
  /// Equilibrium of the dissipation (omega), that of the nearest wall in corners. k: m2/s2, nu: m2/s.
  template <bool kSst>
  Real dissipation(int i, int j, int k_index, Real k, Real nu) const {
    Real most = 0;
    for_each_wall(i, j, k_index, [&](int, Real y, Real) {
      most =
          std::max(most, kSst ? wall_law::specific_dissipation(k, y, nu) : wall_law::dissipation(k, y, nu));
    });
    return most;
  }
  /// Gives the ghosts of an eddy viscosity what makes the shear that of the law of the wall (Launder &
  /// Spalding 1974); `density`: of a dynamic viscosity, kg/m3.
  void shear_by(FieldView eddy_viscosity, int i, int j, int k_index, Real k, Real nu,
                Real density = Real(1)) const {
    for_each_wall(i, j, k_index, [&](int face, Real y, Real speed) {
      const Real on_wall = density * (wall_law::conductance(speed, y, nu, k, Real(0)) * y - nu);
      std::array<int, 3> ghost{i, j, k_index};
      ghost[static_cast<std::size_t>(face / 2)] += face % 2 ? 1 : -1;
      eddy_viscosity(ghost[0], ghost[1], ghost[2]) = Real(2) * on_wall - eddy_viscosity(i, j, k_index);
    });
  }

 private:
  bool beside(int d, int at) const {
    return (is_wall_[static_cast<std::size_t>(2 * d)] && at == 0) ||
           (is_wall_[static_cast<std::size_t>(2 * d + 1)] && at == grid_.n(d) - 1);
  }

  const Grid& grid_;
  std::array<bool, 6> is_wall_;
  std::array<ConstFieldView, 3> u_;
};

}  // namespace ejecta
