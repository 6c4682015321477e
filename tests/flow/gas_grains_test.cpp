#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "flow/piso/compressible.hpp"
#include "godunov_case.hpp"

/// Gas through a void fraction that is given, without drag: rest, a nozzle and a piston have exact answers.
namespace ejecta {
namespace {

using gas::GasState;
using test::even_axis;
using test::make_tube;
using FilledTube = test::TubeOf<gas::Compressible>;

constexpr double kPressure = 101325.0, kRhoOfAir = 1.184, kRatio = 1.4;

gas::Options inviscid_air() {
  gas::Options o;
  o.reference_pressure = kPressure;
  return o;
}

template <class Solids>
void fill_cells(const Grid& grid, Field& field, const Solids& solids) {
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) field(i, j, k) = Real(solids(grid.centre(i, j, k)));
}

/// Still gas stays still wherever the fraction jumps, at the pressure of the reference and above it.
TEST(GasThroughAFraction, StaysAtRestWhereItJumps) {
  for (const double excess : {0.0, 5000.0}) {
    FilledTube t(even_axis(0, 1, 7), make_axis({0, 1}, {6}, {3}), even_axis(0, 1, 5), false, inviscid_air());
    const GasState still{kRhoOfAir, {0, 0, 0}, kPressure + excess};
    t.all_boundaries(BoundaryType::wall);
    t.boundary(1, BoundaryType::pressure_outlet, still);
    t.fill([&](const Vec3&) { return still; });
    t.solver.expect_grains(kRhoOfAir);
    FluidFraction f(t.grid);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0.0, 0.6);
    fill_cells(t.grid, f.solids, [&](const Vec3&) { return any(random); });
    f.solids_before = f.solids;
    CutCells none;
    for (int n = 0; n < 20; ++n) t.solver.advance(1e-3, none, f);
    for (int k = 0; k < 5; ++k)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 7; ++i)  // above the reference sums of pressures leave their round-off
          ASSERT_LE(t.solver.at(i, j, k).velocity.norm(), excess > 0 ? 1e-4 : 0.0);
  }
}

/// The velocity that a face gives is that of gas alone: between grains that fill half of the box it is twice
/// as fast.
TEST(GasThroughAFraction, ComesInWithTheVelocityOfGasAlone) {
  auto t = make_tube<gas::Compressible>(0, 12, inviscid_air());
  const GasState outside{kRhoOfAir, {1, 0, 0}, kPressure}, inside{kRhoOfAir, {2, 0, 0}, kPressure};
  t->all_boundaries(BoundaryType::slip);
  t->boundary(0, BoundaryType::velocity, outside);
  t->boundary(1, BoundaryType::pressure_outlet, outside);
  t->fill([&](const Vec3&) { return inside; });
  t->solver.expect_grains(kRhoOfAir);
  FluidFraction f(t->grid);
  f.solids.fill(Real(0.5));
  f.solids_before = f.solids;
  CutCells none;
  for (int n = 0; n < 100; ++n) t->solver.advance(5e-4, none, f);
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(t->solver.at(i, 0, 0).velocity.x(), 2.0, 1e-5);
}

/// Through an even bed whose drag stops gas within a step the flow is steady, and its pressure falls as drag
/// asks: e grad p = -D u.
TEST(GasThroughAFraction, IsSteadyInAnEvenBed) {
  constexpr int kCells = 12;
  constexpr double kLength = 0.036, kPart = 0.47, kDrag = 2400.0;  // 1/s
  FilledTube t(even_axis(0, kLength, kCells), even_axis(0, 1, 1), even_axis(0, 1, 1), false, inviscid_air());
  const GasState outside{kRhoOfAir, {1, 0, 0}, kPressure};
  t.all_boundaries(BoundaryType::slip);
  t.boundary(0, BoundaryType::velocity, outside);
  t.boundary(1, BoundaryType::pressure_outlet, outside);
  t.fill([&](const Vec3&) { return GasState{kRhoOfAir, {1 / kPart, 0, 0}, kPressure}; });
  t.solver.expect_grains(kRhoOfAir);
  FluidFraction f(t.grid);
  f.solids.fill(Real(1 - kPart));
  f.solids_before = f.solids;
  f.drag.fill(Real(kDrag));
  CutCells none;
  double before = 0, rattle = 0;
  for (int n = 0; n < 400; ++n) {
    t.solver.advance(5e-4, none, f);
    const double now = t.solver.at(6, 0, 0).pressure;
    if (n > 300) rattle = std::max(rattle, std::abs(now - before));
    before = now;
  }
  const double slope = kRhoOfAir * kDrag / kPart / kPart;  // Pa/m
  EXPECT_LT(rattle, 0.01 * slope * kLength / kCells);
  for (int i = 2; i < 9; ++i) {
    EXPECT_NEAR(t.solver.at(i, 0, 0).velocity.x() * kPart, 1.0, 0.01) << i;
    EXPECT_NEAR(
        (t.solver.at(i - 1, 0, 0).pressure - t.solver.at(i, 0, 0).pressure) / (slope * kLength / kCells), 1.0,
        0.02)
        << i;
  }
}

/// Mach number of an isentropic subsonic flow where the area is `area` of that at Mach 0.2.
double mach_in_nozzle(double area) {
  const auto flow = [](double m) { return m * std::pow(1 + 0.5 * (kRatio - 1) * m * m, -3.0); };
  double low = 0.1, high = 1.0;
  for (int n = 0; n < 60; ++n) {
    const double mid = 0.5 * (low + high);
    (area * flow(mid) < flow(0.2) ? low : high) = mid;
  }
  return low;
}

/// Steady flow along a fraction that falls from 1 to 0.5 is that of a nozzle of this area. Returns the
/// largest relative error of the Mach number and of the pressure's fall from the inlet.
std::array<double, 2> nozzle_errors(int cells) {
  auto t = make_tube<gas::Compressible>(0, cells, inviscid_air());
  const double total = kPressure * std::pow(1.008, 3.5), temperature = 300.0;
  const auto state_at = [&](double mach) {
    const double cooler = 1 + 0.2 * mach * mach, local = temperature / cooler;
    GasState s;
    s.pressure = total / std::pow(cooler, 3.5);
    s.density = s.pressure / (287.05 * local);
    s.velocity = {mach * std::sqrt(kRatio * 287.05 * local), 0, 0};
    return s;
  };
  const auto fraction = [](const Vec3& x) {
    const double s = std::clamp((x.x() - 0.1) / 0.8, 0.0, 1.0);
    return 1 - 0.5 * s * s * (3 - 2 * s);
  };
  const double last = mach_in_nozzle(0.5);
  t->all_boundaries(BoundaryType::slip);
  gas::Condition inlet;
  inlet.type = BoundaryType::total_pressure;
  inlet.total_pressure = total;
  inlet.total_temperature = temperature;
  t->solver.boundaries().set_face(0, inlet);
  t->boundary(1, BoundaryType::pressure_outlet, state_at(last));
  t->fill([&](const Vec3&) { return state_at(0.2); });
  t->solver.expect_grains(kRhoOfAir);
  FluidFraction f(t->grid);
  fill_cells(t->grid, f.solids, [&](const Vec3& x) { return 1 - fraction(x); });
  f.solids_before = f.solids;
  CutCells none;
  for (double time = 0; time < 0.4;) {
    const double dt = t->solver.stable_dt(0.8);
    t->solver.advance(dt, none, f);
    time += dt;
  }
  std::array<double, 2> errors{0, 0};
  for (int i = 0; i < cells; ++i) {
    const GasState got = t->solver.at(i, 0, 0);
    const double mach = got.velocity.x() / std::sqrt(kRatio * got.pressure / got.density),
                 right = mach_in_nozzle(fraction(t->grid.centre(i, 0, 0))),
                 inlet_pressure = state_at(0.2).pressure;
    errors[0] = std::max(errors[0], std::abs(mach / right - 1));
    errors[1] = std::max(errors[1], std::abs(got.pressure - state_at(right).pressure) / inlet_pressure);
  }
  return errors;
}

TEST(GasThroughAFraction, IsANozzle) {
  const auto coarse = nozzle_errors(40), fine = nozzle_errors(80);
  EXPECT_LT(coarse[0], 0.005);
  EXPECT_LT(coarse[1], 0.005);
  EXPECT_LT(fine[0], 0.4 * coarse[0]);
}

/// A closed box whose gas is squeezed slowly by grains that come from nowhere: p V^gamma.
TEST(GasThroughAFraction, IsCompressedAsByAPiston) {
  double error[2];
  for (const int finer : {0, 1}) {
    FilledTube t(even_axis(0, 1, 3), even_axis(0, 1, 3), even_axis(0, 1, 3), false, inviscid_air());
    t.all_boundaries(BoundaryType::wall);
    t.fill([&](const Vec3&) { return GasState{kRhoOfAir, {0, 0, 0}, kPressure}; });
    t.solver.expect_grains(kRhoOfAir);
    FluidFraction f(t.grid);
    CutCells none;
    const int steps = finer ? 80 : 40;
    for (int n = 0; n < steps; ++n) {
      f.solids_before = f.solids;
      f.solids.fill(Real(0.1 * (n + 1) / steps));
      t.solver.advance(1e-3, none, f);
    }
    const GasState got = t.solver.at(1, 1, 1);
    error[finer] = std::abs(got.pressure / kPressure / std::pow(0.9, -kRatio) - 1);
    EXPECT_LT(error[finer], 0.01);
    EXPECT_NEAR(got.density / (kRhoOfAir / 0.9), 1.0, 1e-5);
  }
  EXPECT_LT(error[1], 0.6 * error[0]);
}

}  // namespace
}  // namespace ejecta
