#include <gtest/gtest.h>

#include "case/load.hpp"
#include "coupling/resolved/resolved.hpp"
#include "flow/model/flow_model.hpp"
#include "flow/piso/incompressible.hpp"

/// A step that is tried leaves nothing behind, a body in the flow or not; neither does a resume.
namespace ejecta {
namespace {

/// A ball pushed through a box of water at rest.
struct Tank {
  Case c = parse_case(R"(
[run]
end_time = "1 s"
[grid.x]
points = ["-20 mm", "20 mm"]
cells = [20]
[grid.y]
points = ["-20 mm", "20 mm"]
cells = [20]
[grid.z]
points = ["0 mm", "40 mm"]
cells = [20]
[[body]]
diameter = "16 mm"
position = ["-5.3 mm", "0.2 mm", "19.1 mm"]
)",
                      "tank");
  Grid grid = make_grid(c);
  Incompressible flow{grid, {}, {.density = 1000.0, .viscosity = 1e-5}};
  ResolvedCoupling coupling{grid, {.fluid_density = 1000.0}};
  Body ball = make_body(c.bodies[0], Materials(c), "");
  CutCells mask;
  double time = 0.0;

  Tank() {
    ball.velocity = Vec3(0.3, 0.05, -0.1);
    flow.initialise([](const Vec3&) { return Vec3(0, 0, 0); }, [](const Vec3&) { return 0.0; }, 0.0);
  }
  void advance(double dt = 1e-3) {
    coupling.map({&ball, 1}, mask);
    flow.advance(time, dt, mask);
    ball.position += dt * ball.velocity;
    time += dt;
  }
};

/// In every cell; what lies around the grid is filled anew in every step.
void expect_same(Tank& a, Tank& b) {
  const auto x = a.flow.state(), y = b.flow.state();
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t n = 0; n < x.size(); ++n) {
    int differ = 0;
    for (int k = 0; k < a.grid.nz(); ++k)
      for (int j = 0; j < a.grid.ny(); ++j)
        for (int i = 0; i < a.grid.nx(); ++i) differ += (*x[n].field)(i, j, k) != (*y[n].field)(i, j, k);
    EXPECT_EQ(differ, 0) << x[n].name;
  }
  EXPECT_EQ(a.flow.ledger().displaced, b.flow.ledger().displaced);
  EXPECT_EQ(a.flow.ledger().impulse_on_solids, b.flow.ledger().impulse_on_solids);
  EXPECT_EQ(a.flow.momentum(), b.flow.momentum());
}

TEST(TryStep, AFlowAtRestHasNoDivergence) { EXPECT_EQ(Tank().flow.largest_divergence({}), 0.0); }

TEST(TryStep, LeavesTheFlowAroundABodyAsItIs) {
  Tank tried, untried;
  for (int n = 0; n < 8; ++n) {
    tried.advance();
    untried.advance();
    EXPECT_GT(tried.flow.try_step(tried.time, 1e-3), 0.0);
    expect_same(tried, untried);
  }
}

TEST(TryStep, AResumedFlowGoesOnToTheSameBits) {
  Tank whole;
  for (int n = 0; n < 5; ++n) whole.advance();
  Tank resumed;
  resumed.ball = whole.ball;
  resumed.time = whole.time;
  const auto from = whole.flow.state(), to = resumed.flow.state();
  for (std::size_t n = 0; n < from.size(); ++n) *to[n].field = *from[n].field;
  resumed.flow.ledger() = whole.flow.ledger();
  resumed.flow.resume(whole.time);
  for (int n = 0; n < 8; ++n) {
    expect_same(whole, resumed);
    whole.advance();
    resumed.advance();
  }
}

/// What ghosts hold is no fluid.
TEST(TryStep, CellsInsideABodyDoNotShortenTheStep) {
  Tank still;
  still.ball.velocity = Vec3(0, 0, 0);
  still.coupling.map({&still.ball, 1}, still.mask);
  for (GhostCell& g : still.mask.ghosts)
    if (g.donors == 0) g.solid = {1000, 0, 0};  // deep inside
  for (int n = 0; n < 2; ++n) still.flow.advance(1e-6 * n, 1e-6, still.mask);
  double deep = 0.0;
  for (const GhostCell& g : still.mask.ghosts)
    if (g.donors == 0) deep = std::max(deep, std::abs(double(still.flow.velocity()[0](g.i, g.j, g.k))));
  ASSERT_EQ(deep, 1000.0);
  EXPECT_LT(still.flow.courant(1.0), 0.5 * 1000.0 / 2e-3);
}

}  // namespace
}  // namespace ejecta
