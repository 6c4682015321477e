#pragma once
#include <functional>
#include <memory>

#include "flow/godunov/solver.hpp"

/// Short ways to set up the compressible solver in tests.
namespace ejecta::test {

inline Axis even_axis(double low, double high, int cells) { return make_axis({low, high}, {cells}, {}); }

using GasAt = std::function<gas::GasState(const Vec3&)>;

template <class Flow>
struct TubeOf {
  Grid grid;
  Flow solver;
  TubeOf(Axis x, Axis y, Axis z, bool axisymmetric, const gas::Options& options)
      : grid(std::move(x), std::move(y), std::move(z), axisymmetric), solver(grid, options) {}

  void boundary(int face, BoundaryType type, const gas::GasState& outside = {}) {
    gas::Condition c;
    c.type = type;
    c.state = outside;
    solver.boundaries().set_face(face, c);
  }
  void all_boundaries(BoundaryType type) {
    for (int f = 0; f < 6; ++f) boundary(f, type);
  }
  void fill(const GasAt& gas) {
    for (int k = 0; k < grid.nz(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i) solver.set(i, j, k, gas(grid.centre(i, j, k)));
  }
  void run(double end, double courant) {
    double t = 0.0;
    while (t < end * (1.0 - 1e-12)) {
      const double dt = std::min(solver.stable_dt(courant), end - t);
      solver.advance(dt);
      t += dt;
    }
  }
};

using Tube = TubeOf<gas::Solver>;

/// A tube along x (0), y (1) or z (2) of the unit length.
template <class Flow = gas::Solver>
std::unique_ptr<TubeOf<Flow>> make_tube(int axis, int cells, const gas::Options& options = {}) {
  std::array<Axis, 3> a;
  for (int d = 0; d < 3; ++d) a[static_cast<std::size_t>(d)] = even_axis(0, 1, d == axis ? cells : 1);
  return std::make_unique<TubeOf<Flow>>(a[0], a[1], a[2], false, options);
}

}  // namespace ejecta::test
