#include <gtest/gtest.h>

#include <algorithm>

#include "case/load.hpp"
#include "flow/cut_cells.hpp"
#include "flow/model/flow_model.hpp"
#include "flow/model/gas_from_case.hpp"
#include "flow/model/incompressible_states.hpp"

using namespace ejecta;

/// k and epsilon given as formulas reach the flow.
namespace {

constexpr int kTurbulence = 5;  // in FlowModel::quantities() of the incompressible flow

std::string channel(const std::string& more, const std::string& model = "k-epsilon") {
  return R"(
[run]
end_time = "20 ms"
[flow]
turbulence = ")" +
         model + R"("
[grid.x]
points = ["0 mm", "20 mm"]
cells = [10]
[grid.y]
points = ["0 mm", "4 mm"]
cells = [2]
[grid.z]
points = ["0 mm", "20 mm"]
cells = [10]
[boundary.x_max]
type = "pressure-outlet"
[boundary.y_min]
type = "slip"
[boundary.y_max]
type = "slip"
[boundary.z_min]
type = "slip"
[boundary.z_max]
type = "slip"
[[initial]]
velocity = ["2 m/s", "0 m/s", "0 m/s"]
k = "= 0.01 + 0.5 * z"
epsilon = "= 0.5 + 5 * x"
[boundary.x_min]
type = "velocity"
velocity = ["2 m/s", "0 m/s", "0 m/s"]
)" + more;
}

struct Channel {
  Case c;
  Grid grid;
  std::unique_ptr<FlowModel> flow;
  double time = 0.0;

  explicit Channel(const std::string& text)
      : c(parse_case(text, "channel")), grid(make_grid(c)), flow(make_flow_model(c, grid)) {}
  void advance(double until) {
    CutCells none;
    for (constexpr double dt = 2.5e-4; time < until - 1e-9; time += dt) flow->advance(time, dt, none);
  }
  double k_at(const Vec3& x) const {
    std::vector<double> values(flow->quantities().size());
    flow->sample(x, values);
    return values[kTurbulence];
  }
};

TEST(TurbulenceStates, AnInitialProfileIsTheFieldAtTheStart) {
  const Channel flow(channel(""));
  for (const double z : {1e-3, 5e-3, 11e-3, 19e-3})
    EXPECT_NEAR(flow.k_at({9e-3, 1e-3, z}), 0.01 + 0.5 * z, 1e-8) << z;
}

/// Over three times the way through the first cells, the inlet's profile has replaced that of the start.
TEST(TurbulenceStates, TheProfileOfAnInletArrivesInTheCellsBehindIt) {
  for (const char* model : {"k-epsilon", "k-omega-sst"}) {
    Channel flow(channel("k = \"= 0.02 - 0.5 * z\"\nepsilon = \"= 0.3 + 0 * z\"", model));
    flow.advance(4e-3);
    for (const double z : {3e-3, 9e-3, 17e-3})
      EXPECT_NEAR(flow.k_at({1e-3, 1e-3, z}), 0.02 - 0.5 * z, 1e-3) << model << z;
  }
}

TEST(TurbulenceStates, AnInletFollowsItsFormulaInTime) {
  Channel flow(channel("k = \"= 0.01 + t\"\nepsilon = \"0.3 m2/s3\""));
  flow.advance(10e-3);
  EXPECT_NEAR(flow.k_at({1e-3, 1e-3, 9e-3}), 0.0195, 1e-3) << "as at the start: 0.01";
}

TEST(TurbulenceStates, PatchesAndOpenFacesHaveProfilesToo) {
  const Case c = parse_case(channel(R"(
[[boundary.x_min.patch]]
centre = ["0 mm", "2 mm", "10 mm"]
radius = "3 mm"
velocity = ["2 m/s", "0 m/s", "0 m/s"]
k = "= z"
epsilon = "= 2 * z + t"
)"),
                            "patch");
  const Grid grid = make_grid(c);
  const StillAir air(c);
  const Inflow none;
  const Boundary inlet = make_boundary(c, grid, air, none, 0);
  EXPECT_TRUE(inlet.varies);
  EXPECT_NEAR(inlet.state({0, 2e-3, 11e-3}, 0.5).k, 11e-3, 1e-8);
  EXPECT_NEAR(inlet.state({0, 2e-3, 11e-3}, 0.5).dissipation, 22e-3 + 0.5, 1e-6);
  EXPECT_NEAR(inlet.state({0, 2e-3, 1e-3}, 0.5).k, air.k, 1e-9) << "outside of the disc";
  Case open = c;
  open.boundary[1].state.k = "1 + y * t";
  const Boundary outlet = make_boundary(open, grid, air, none, 1);
  EXPECT_TRUE(outlet.varies);
  EXPECT_NEAR(outlet.state({20e-3, 2e-3, 0}, 5.0).k, 1.01, 1e-6);
}

/// A formula may fall below nothing later on: then it means still air, not a negative eddy viscosity.
TEST(TurbulenceStates, LessThanNothingIsStillAir) {
  const Case c = parse_case(channel("k = \"= 0.1 - 100 * t\"\nepsilon = \"= 1 - 1000 * t\""), "channel");
  const StillAir air(c);
  const StateFormula state(c.boundary[0].state, air);
  EXPECT_EQ(state.turbulence_at({0, 0, 0}, 0.0).k, 0.1);
  EXPECT_EQ(state.turbulence_at({0, 0, 0}, 0.1).k, air.k);
  EXPECT_EQ(state.turbulence_at({0, 0, 0}, 0.1).dissipation, air.dissipation);
}

TEST(TurbulenceStates, AnInletOfGasHasItsProfile) {
  Channel flow(
      channel("k = \"= 0.02 - 0.5 * z + t\"\nepsilon = \"0.3 m2/s3\"\n[fluid]\nviscosity = \"1e-5 Pa s\"",
              "k-epsilon\"\nsolver = \"compressible-piso"));
  const gas::GasFormula inlet(flow.c, flow.c.boundary[0].state);
  EXPECT_TRUE(inlet.uses_time());
  EXPECT_NEAR(inlet.at({0, 0, 0.01}, 0.1).k, 0.115, 1e-12);
  EXPECT_NEAR(inlet.at({0, 0, 1.0}, 0.0).k, 1e-4, 1e-12) << "less than nothing: still air";
  flow.advance(5e-3);
  const auto fields = flow.flow->fields();
  const auto k = std::find_if(fields.begin(), fields.end(), [](const CellField& f) { return f.name == "k"; });
  ASSERT_NE(k, fields.end());
  for (const int layer : {1, 4, 8}) {
    const double z = 2e-3 * layer + 1e-3;
    EXPECT_NEAR(k->component[0](0, 0, layer), 0.0245 - 0.5 * z, 1.5e-3) << z;
  }
}

TEST(TurbulenceStates, AGasStartsFromItsProfile) {
  Case c = parse_case(channel("", "k-omega-sst"), "channel");
  const gas::GasState gas = gas::gas_state(c, c.initial[0].state, {4e-3, 0, 8e-3}, 0.0);
  EXPECT_NEAR(gas.k, 0.014, 1e-12);
  EXPECT_NEAR(gas.e, 0.52 / (0.09 * 0.014), 1e-4);
}

}  // namespace
