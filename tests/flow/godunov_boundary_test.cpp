#include <gtest/gtest.h>

#include <cmath>

#include "flow/ideal_gas.hpp"
#include "godunov_case.hpp"

namespace ejecta {
namespace {

using gas::Condition;
using gas::GasState;
using gas::Primitive;
using test::even_axis;
using test::make_tube;

constexpr double kAmbient = 101325.0, kTemperature = 298.15;
const Gas kAir{};

gas::Options air() {
  gas::Options o;
  o.reference_pressure = kAmbient;
  return o;
}

/// Amplitude of what comes back, over that of a pulse of sound sent against the upper end of a tube.
double reflection(BoundaryType type, int cells) {
  auto t = make_tube(2, cells, air());
  const double rho = gas_density(kAir, kAmbient, kTemperature), c = gas_sound_speed(kAir, kTemperature);
  const GasState still{rho, {0, 0, 0}, kAmbient};
  for (int f = 0; f < 6; ++f) t->boundary(f, BoundaryType::symmetry, still);
  t->boundary(5, type, still);
  const double height = 100.0, width = 0.05;
  t->fill([&](const Vec3& x) {
    const double p = height * std::exp(-std::pow((x.z() - 0.6) / width, 2));
    return GasState{rho + p / (c * c), {0, 0, p / (rho * c)}, kAmbient + p};
  });
  t->run(0.7 / c, 0.8);
  double most = 0.0;
  for (int k = 0; k < cells; ++k) most = std::max(most, std::abs(t->solver.at(0, 0, k).pressure - kAmbient));
  return most / height;
}

// Each of 400 discs, one a cell, keeps its own condition: a handle of eight bits would begin again at the
// 257th.
TEST(GodunovBoundary, HoldsHundredsOfDiscs) {
  const int n = 20;
  const Grid grid(even_axis(0, 1, n), even_axis(0, 1, n), even_axis(0, 1, 2), false);
  gas::Boundaries boundaries(grid, gas::GasConstants{});
  const auto number = [&](int i, int j) { return double(1 + i + n * j); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      Condition c;
      c.type = BoundaryType::velocity;
      c.state.velocity = Vec3(0, 0, number(i, j));
      boundaries.add_disc(4, Vec3((i + 0.5) / n, (j + 0.5) / n, 0), 0.4 / n, c);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(boundaries.at(4, static_cast<std::size_t>(i + n * j)).state.velocity.z(), number(i, j));
}

TEST(GodunovBoundary, ATransmissiveEndReturnsLessThanTwoPercent) {
  EXPECT_LT(reflection(BoundaryType::wave_transmissive, 200), 0.02);
}

TEST(GodunovBoundary, AWallReturnsAllAndAFixedPressureToo) {
  EXPECT_GT(reflection(BoundaryType::wall, 200), 0.9);
  EXPECT_GT(reflection(BoundaryType::free_stream, 200), 0.9);
}

// Air drawn in through the rim of a cylinder towards a sink: u r is even, and the pressure at the rim is the
// one kept outside. An even velocity across the rim would ask for rho c u h/(2 R) = 9 Pa here.
TEST(GodunovBoundary, AFreeStreamLetsAirConvergeThroughARim) {
  const double rho = gas_density(kAir, kAmbient, kTemperature), inner = 0.01, outer = 0.07;
  const GasState still{rho, {0, 0, 0}, kAmbient};
  const auto drawn = [&](double r) {
    const double u = outer / r;  // 1 m/s at the rim
    return GasState{rho, {-u, 0, 0}, kAmbient - 0.5 * rho * u * u};
  };
  test::Tube t(even_axis(inner, outer, 20), even_axis(0, 1, 1), even_axis(0, 0.01, 1), true, air());
  for (int f = 0; f < 6; ++f) t.boundary(f, BoundaryType::symmetry, still);
  t.boundary(0, BoundaryType::velocity, drawn(inner));
  t.boundary(1, BoundaryType::free_stream, still);
  t.fill([&](const Vec3& x) { return drawn(x.x()); });
  t.run(5e-3, 0.8);
  EXPECT_NEAR(t.solver.at(19, 0, 0).pressure, kAmbient, 1.5);
}

gas::GasConstants constants() { return {1.4, 287.05, kAmbient}; }

Primitive at_rest(double pressure) {
  return {Real(gas_density(kAir, pressure, kTemperature)), 0, 0, 0, Real(pressure - kAmbient)};
}

TEST(GodunovBoundary, TheInletIsSonicAtHighPressure) {
  const Primitive w = inlet_total_pressure(constants(), 801325.0, kTemperature, at_rest(kAmbient));
  const double star = kTemperature / 1.2;
  EXPECT_NEAR(w.un, gas_sound_speed(kAir, star), 1e-2);
  EXPECT_NEAR(double(w.p) + kAmbient, 801325.0 / gas_critical_pressure_ratio(kAir), 1.0);
  EXPECT_NEAR(w.rho * w.un, 1875.6, 0.5);  // kg/m2/s, exact
}

TEST(GodunovBoundary, TheInletIsShutWhenThePressureInsideIsHigher) {
  EXPECT_EQ(inlet_total_pressure(constants(), kAmbient, kTemperature, at_rest(kAmbient)).un, 0);
  EXPECT_EQ(inlet_total_pressure(constants(), 0.9 * kAmbient, kTemperature, at_rest(kAmbient)).un, 0);
}

// What enters keeps total pressure and temperature, and meets the sound wave it sends ahead.
TEST(GodunovBoundary, TheSubsonicInletKeepsTotalPressureAndTemperature) {
  const double p0 = 1.02 * kAmbient;
  const Primitive w = inlet_total_pressure(constants(), p0, kTemperature, at_rest(kAmbient));
  const double p = double(w.p) + kAmbient, temperature = p / (287.05 * double(w.rho));
  const double mach = double(w.un) / gas_sound_speed(kAir, temperature);
  EXPECT_NEAR(p * gas_total_pressure_ratio(kAir, mach), p0, 1.0);
  EXPECT_NEAR(temperature * gas_total_temperature_ratio(kAir, mach), kTemperature, 1e-2);
  const double rho = gas_density(kAir, kAmbient, kTemperature), c = gas_sound_speed(kAir, kTemperature);
  EXPECT_NEAR(double(w.p) / (rho * c * double(w.un)), 1.0, 0.02);
}

/// Choked orifice against the exact relations: mass flow and thrust.
class Orifice : public testing::TestWithParam<double> {};

TEST_P(Orifice, PassesTheExactMassAndMomentum) {
  const double gauge = GetParam(), radius = 1e-3, p0 = kAmbient + gauge;
  gas::Options o = air();
  test::Tube t(make_axis({0, 2e-3, 2e-2}, {16, 20}, {1, 12}), even_axis(0, 1, 1),
               make_axis({0, 1e-2, 6e-2}, {60, 30}, {1, 10}), true, o);
  const GasState still{gas_density(kAir, kAmbient, kTemperature), {0, 0, 0}, kAmbient};
  for (int f = 0; f < 6; ++f) t.boundary(f, BoundaryType::symmetry, still);
  t.boundary(1, BoundaryType::free_stream, still);
  t.boundary(4, BoundaryType::wall, still);
  t.boundary(5, BoundaryType::wave_transmissive, still);
  Condition inlet;
  inlet.type = BoundaryType::total_pressure;
  inlet.state = still;
  inlet.total_pressure = p0;
  inlet.total_temperature = kTemperature;
  t.solver.boundaries().add_disc(4, {0, 0, 0}, radius, inlet);
  t.fill([&](const Vec3&) { return still; });
  t.run(5e-5, 0.8);
  double mass = 0.0, thrust = 0.0;
  const Metrics r = t.grid.metrics(0);
  for (int i = 0; i < 8; ++i) {
    mass += 2 * M_PI * double(r.volume[i]) * double(t.solver.flux(2)[gas::kRho](i, 0, 0));
    thrust += 2 * M_PI * double(r.volume[i]) * double(t.solver.flux(2)[gas::kW](i, 0, 0));
  }
  const double area = M_PI * radius * radius, star = p0 / gas_critical_pressure_ratio(kAir);
  EXPECT_NEAR(mass / (0.040418 * p0 / std::sqrt(kTemperature) * area), 1.0, 0.01);
  EXPECT_NEAR(thrust / ((2.4 * star - kAmbient) * area), 1.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(GaugePressure, Orifice, testing::Values(400e3, 700e3, 900e3));

}  // namespace
}  // namespace ejecta
