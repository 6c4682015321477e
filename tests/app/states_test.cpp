#include <fmt/format.h>
#include <gtest/gtest.h>

#include "case/load.hpp"
#include "flow/model/flow_model.hpp"

/// States of regions and boundaries: the same words mean the same to every solver.
namespace ejecta {
namespace {

std::string box(const std::string& solver, const std::string& more, const std::string& ends) {
  return fmt::format(R"toml(
[run]
end_time = "1 ms"
courant = 0.8
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[fluid]
viscosity = "0 Pa s"
[flow]
solver = "{}"
[grid.x]
points = ["0 mm", "20 mm"]
cells = [20]
[grid.y]
points = ["0 mm", "1 mm"]
cells = [1]
[grid.z]
points = ["0 mm", "20 mm"]
cells = [10]
{}
[boundary.z_min]
type = "slip"
[boundary.z_max]
type = "slip"
{}
)toml",
                     solver, ends, more);
}

struct Flow {
  Case c;
  Grid grid;
  std::unique_ptr<FlowModel> flow;
  explicit Flow(const std::string& text)
      : c(parse_case(text, "box")), grid(make_grid(c)), flow(make_flow_model(c, grid)) {}
  /// Blows until `end` in steps of at most `longest`.
  void advance(double end, double longest) {
    CutCells none;
    for (double t = 0.0; t < end;) {
      const double dt = std::min({flow->stable_dt(t), longest, end - t});
      flow->advance(t, dt, none);
      t += dt;
    }
  }
  double at(const char* quantity, const Vec3& x) const {
    const auto names = flow->quantities();
    std::vector<double> values(names.size());
    flow->sample(x, values);
    for (std::size_t n = 0; n < names.size(); ++n)
      if (names[n].first == quantity) return values[n];
    return 1e300;
  }
};

class States : public testing::TestWithParam<const char*> {};

/// A later region says one thing more; it does not unsay what an earlier one said. Corners in any order.
TEST_P(States, RegionsAddUpKeyByKey) {
  const bool gauge = std::string(GetParam()) == "incompressible";
  const std::string open =
      "[boundary.x_min]\ntype = \"velocity\"\nvelocity = [\"30 m/s\", \"0 m/s\", \"0 m/s\"]\n"
      "[boundary.x_max]\ntype = \"pressure-outlet\"\n";
  const Flow f(box(GetParam(),
                   fmt::format("[[initial]]\nvelocity = [\"30 m/s\", \"0 m/s\", \"0 m/s\"]\n[[initial]]\n"
                               "box = [[\"20 mm\", \"1 mm\", \"20 mm\"], [\"10 mm\", \"0 mm\", \"0 mm\"]]\n"
                               "pressure = \"{}\"\n",
                               gauge ? "100 Pa gauge" : "101425 Pa absolute"),
                   open));
  EXPECT_NEAR(f.at("velocity_x", Vec3(0.005, 0.0005, 0.01)), 30.0, 1e-3);
  EXPECT_NEAR(f.at("velocity_x", Vec3(0.015, 0.0005, 0.01)), 30.0, 1e-3);
  EXPECT_NEAR(f.at("pressure", Vec3(0.015, 0.0005, 0.01)) - f.at("pressure", Vec3(0.005, 0.0005, 0.01)),
              100.0, 0.1);
}

/// At a boundary, velocity and pressure follow their formulas in place and time.
TEST_P(States, BoundariesFollowTheirFormulas) {
  const std::string open =
      "[boundary.x_min]\ntype = \"velocity\"\nvelocity = [\"= 10 + 10000 * t + 500 * z\", \"0 m/s\", \"0 "
      "m/s\"]\n"
      "[boundary.x_max]\ntype = \"pressure-outlet\"\n";
  Flow f(box(GetParam(), "[[initial]]\nvelocity = [\"= 10 + 500 * z\", \"0 m/s\", \"0 m/s\"]\n", open));
  f.advance(1e-3, 1e-5);
  for (const double z : {0.005, 0.015})
    EXPECT_NEAR(f.at("velocity_x", Vec3(0, 0.0005, z)), 20.0 + 500 * z, 0.6) << z;
}

TEST_P(States, AnOutletFollowsItsFormula) {
  const bool gauge = std::string(GetParam()) == "incompressible";
  const std::string open = fmt::format(
      "[boundary.x_min]\ntype = \"velocity\"\nvelocity = [\"10 m/s\", \"0 m/s\", \"0 m/s\"]\n"
      "[boundary.x_max]\ntype = \"pressure-outlet\"\npressure = \"= {} + 1e6 * t\"\n",
      gauge ? "0" : "101325");
  Flow f(box(GetParam(), "[[initial]]\nvelocity = [\"10 m/s\", \"0 m/s\", \"0 m/s\"]\n", open));
  f.advance(1e-3, 1e-5);
  EXPECT_NEAR(f.at("pressure", Vec3(0.0199, 0.0005, 0.01)), (gauge ? 0.0 : 101325.0) + 1000.0, 60.0);
}

INSTANTIATE_TEST_SUITE_P(Solvers, States,
                         testing::Values("incompressible", "compressible", "compressible-piso"));

}  // namespace
}  // namespace ejecta
