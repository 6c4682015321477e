#include <gtest/gtest.h>

#include <cmath>

#include "godunov_case.hpp"

/// The same round flow on an axisymmetric grid and in a Cartesian quarter.
namespace ejecta {
namespace {

using gas::GasState;
using test::even_axis;
using test::Tube;

/// A viscous puff: a smooth ball of pressure above the lower wall, and a wind through it.
GasState puff(double r, double z) {
  const double ball = std::exp(-(r * r + (z - 0.4) * (z - 0.4)) / 0.04);
  return {1.0 + 0.3 * ball, {0, 0, 0.4 * ball}, 1.0 + 0.5 * ball, 0.01 + 0.01 * ball, 0.02 + 0.02 * ball};
}

gas::Options options() {
  gas::Options o;
  o.reference_pressure = 1.0;
  o.viscosity = 2e-3;
  o.turbulence = TurbulenceModel::k_epsilon;
  return o;
}

std::unique_ptr<Tube> run(int cells, bool axisymmetric, double time) {
  const Axis x = even_axis(0, 1, cells), y = even_axis(0, 1, axisymmetric ? 1 : cells);
  auto t = std::make_unique<Tube>(x, y, even_axis(0, 1, cells), axisymmetric, options());
  t->all_boundaries(BoundaryType::symmetry);
  t->fill([&](const Vec3& at) { return puff(axisymmetric ? at.x() : std::hypot(at.x(), at.y()), at.z()); });
  t->run(time, 0.6);
  return t;
}

/// Mean difference of pressure between a quarter of `cells`^3 and a fine axisymmetric grid, over the mean
/// disturbance.
double difference(int cells, const Tube& fine, double time) {
  const auto quarter = run(cells, false, time);
  const Grid& g = fine.grid;
  double sum = 0.0, scale = 0.0;
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const Vec3 x = quarter->grid.centre(i, j, k);
        const double r = std::hypot(x.x(), x.y());
        if (r > 0.9) continue;
        // linear between the centres of the fine grid
        const double at_r = r * g.nx() - 0.5, at_z = x.z() * g.nz() - 0.5;
        const int i0 = std::max(0, int(at_r)), k0 = std::clamp(int(at_z), 0, g.nz() - 2);
        const double a = std::max(0.0, at_r - i0), b = at_z - k0;
        const auto p = [&](int n, int m) { return fine.solver.at(n, 0, m).pressure; };
        const double exact = (1 - b) * ((1 - a) * p(i0, k0) + a * p(i0 + 1, k0)) +
                             b * ((1 - a) * p(i0, k0 + 1) + a * p(i0 + 1, k0 + 1));
        sum += std::abs(quarter->solver.at(i, j, k).pressure - exact);
        scale += std::abs(exact - 1.0);
      }
  return sum / scale;
}

TEST(GodunovAxisymmetric, AgreesWithAQuarterInThreeDimensionsAtSecondOrder) {
  constexpr double kTime = 0.25;
  const auto fine = run(128, true, kTime);
  const double coarse = difference(16, *fine, kTime), finer = difference(32, *fine, kTime);
  EXPECT_LT(finer, 0.03);
  EXPECT_GT(std::log2(coarse / finer), 1.7) << coarse << " " << finer;
}

}  // namespace
}  // namespace ejecta
