#include "jet/nozzle.hpp"

#include <gtest/gtest.h>

namespace ejecta {
namespace {

constexpr double kAmbient = 101325.0, kTemperature = 298.15;

struct Row {
  double gauge_kpa, thrust_kpa, velocity, disk, mass_flux, thrust, grams, litres_per_minute;
};

// Exact relations of a choked orifice at 25 C, 2 mm across, C_D = 1.
class ChokedNozzle : public testing::TestWithParam<Row> {};

TEST_P(ChokedNozzle, MatchesTheExactRelations) {
  const Row row = GetParam();
  const Gas air;
  const double p0 = kAmbient + 1e3 * row.gauge_kpa, d = 2e-3;
  const NozzleExit exit = nozzle_exit(air, p0, kTemperature, kAmbient);
  EXPECT_DOUBLE_EQ(exit.mach, 1.0);
  EXPECT_NEAR(1e-3 * exit.thrust_per_area, row.thrust_kpa, 0.1);
  EXPECT_NEAR(nozzle_equivalent_velocity(exit, 1.0, gas_density(air, kAmbient, kTemperature)), row.velocity,
              0.1);
  EXPECT_NEAR(nozzle_mach_disk(p0, kAmbient, d) / d, row.disk, 1e-3);
  EXPECT_NEAR(exit.mass_flux, row.mass_flux, 0.1);
  EXPECT_NEAR(nozzle_thrust(exit, 1.0, d), row.thrust, 1e-3);
  const double flow = nozzle_mass_flow(exit, 1.0, d);
  EXPECT_NEAR(1e3 * flow, row.grams, 1e-3);
  EXPECT_NEAR(60.0 * nozzle_normal_litres(air, flow), row.litres_per_minute, 1.0);
}

INSTANTIATE_TEST_SUITE_P(At25C, ChokedNozzle,
                         testing::Values(Row{400, 534.3, 671.8, 1.490, 1173.4, 1.679, 3.686, 171},
                                         Row{500, 661.1, 747.2, 1.632, 1407.5, 2.077, 4.422, 205},
                                         Row{600, 787.9, 815.7, 1.763, 1641.5, 2.475, 5.157, 239},
                                         Row{700, 914.7, 878.9, 1.884, 1875.6, 2.873, 5.892, 273},
                                         Row{800, 1041.4, 937.9, 1.998, 2109.6, 3.272, 6.628, 308},
                                         Row{900, 1168.2, 993.3, 2.106, 2343.7, 3.670, 7.363, 342}));

TEST(Nozzle, DischargeCoefficientScalesTheMomentum) {
  const Gas air;
  const NozzleExit exit = nozzle_exit(air, 801325.0, kTemperature, kAmbient);
  EXPECT_NEAR(nozzle_equivalent_velocity(exit, 0.95, 1.1839) / nozzle_equivalent_velocity(exit, 1.0, 1.1839),
              0.97468, 1e-5);
}

TEST(Nozzle, BelowChokingTheExitIsAtAmbientPressure) {
  const Gas air;
  const double p0 = 1.2 * kAmbient;
  const NozzleExit exit = nozzle_exit(air, p0, 300.0, kAmbient);
  EXPECT_DOUBLE_EQ(exit.pressure, kAmbient);
  EXPECT_NEAR(exit.mach, 0.5171, 1e-4);  // p0/p = 1.2
  // Energy: cp T0 = cp T + u^2/2
  EXPECT_NEAR(air.specific_heat_pressure() * (300.0 - exit.temperature), 0.5 * exit.velocity * exit.velocity,
              1e-6);
}

TEST(Nozzle, IsContinuousWhereItChokes) {
  const Gas air;
  const double critical = gas_critical_pressure_ratio(air) * kAmbient;
  const NozzleExit below = nozzle_exit(air, critical * (1 - 1e-9), 300.0, kAmbient);
  const NozzleExit above = nozzle_exit(air, critical * (1 + 1e-9), 300.0, kAmbient);
  EXPECT_NEAR(below.thrust_per_area / above.thrust_per_area, 1.0, 1e-6);
  EXPECT_NEAR(below.mass_flux / above.mass_flux, 1.0, 1e-6);
}

TEST(Nozzle, WithoutOverpressureNothingFlows) {
  const NozzleExit exit = nozzle_exit(Gas{}, kAmbient, 300.0, kAmbient);
  EXPECT_EQ(exit.mass_flux, 0.0);
  EXPECT_EQ(exit.thrust_per_area, 0.0);
}

TEST(Nozzle, ShockCellAndPitotOfTheFullyExpandedJet) {
  const Gas air;
  EXPECT_NEAR(nozzle_shock_cell(air, 801325.0, kAmbient, 1.0), 2.96, 0.005);
  EXPECT_NEAR(gas_isentropic_mach(air, 7.9085), 2.0069, 1e-3);
  EXPECT_NEAR(gas_pitot_ratio(air, 2.0), 5.640, 1e-3);
  EXPECT_NEAR(gas_pitot_ratio(air, 3.0), 12.061, 1e-3);
  EXPECT_EQ(nozzle_shock_cell(air, 1.1 * kAmbient, kAmbient, 1.0), 0.0);
}

TEST(Nozzle, IsothermalWork) {
  EXPECT_NEAR(nozzle_isothermal_work(Gas{}, 1.0, 293.15, 801325.0, kAmbient), 174e3, 0.1e3);
}

}  // namespace
}  // namespace ejecta
