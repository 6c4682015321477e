#include "jet/inlet.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "case/load.hpp"
#include "flow/model/flow_model.hpp"
#include "scratch_directory.hpp"
#include "small_jet.hpp"

/// A jet let into a box: through any face, aslant, beside planes of symmetry, and several of them.
namespace ejecta {
namespace {

constexpr double kBlowing = 0.8e-3;  // s: the jet has come through most of the box
constexpr std::array<const char*, 6> kFaces{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
const std::array<const char*, 3> kSolvers{"incompressible", "compressible-piso", "compressible"};

/// A box of 24 x 24 x 24 mm that begins 40 mm from the plane of the orifice, along the normal of `face`; from
/// `from` mm on along x, with a plane of symmetry there when it is not the whole.
std::string box(const std::string& solver, int face, const std::string& jet, double from = -12.0) {
  std::string text = fmt::format(R"(
[run]
end_time = "10 ms"
courant = 0.8
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[flow]
solver = "{}"
[valve]
supply_pressure = "300 kPa gauge"
rise_time = "0.2 ms"
fall_time = "0 ms"
duration = "8 ms"
[jet]
{}
)",
                                 solver, jet);
  for (int d = 0; d < 3; ++d) {
    const char* axis = d == 0 ? "x" : d == 1 ? "y" : "z";
    const double low = d == face / 2 ? (face % 2 ? -64.0 : 40.0) : d == 0 ? from : -12.0;
    const double high = d == face / 2 ? low + 24.0 : 12.0;
    text += fmt::format("[grid.{}]\npoints = [\"{} mm\", \"{} mm\"]\ncells = [{}]\n", axis, low, high,
                        int(high - low) / 2);
  }
  for (int f = 0; f < 6; ++f)
    text += fmt::format("[boundary.{}]\ntype = \"{}\"\n", kFaces[static_cast<std::size_t>(f)],
                        f == face                ? "jet"
                        : f == 0 && from > -12.0 ? "symmetry"
                                                 : "free-stream");
  return text;
}

/// A box after kBlowing, to be asked for velocities.
struct Blown {
  Case c;
  Grid grid;
  std::unique_ptr<FlowModel> flow;
  explicit Blown(const std::string& text)
      : c(parse_case(text, "box")), grid(make_grid(c)), flow(make_flow_model(c, grid, inflow_of(c))) {
    CutCells none;
    double t = 0.0;
    while (t < kBlowing) {
      const double dt = std::min(flow->stable_dt(t), kBlowing - t);
      flow->advance(t, dt, none);
      t += dt;
    }
  }
  Vec3 velocity(const Vec3& x) const {
    std::vector<double> values(flow->quantities().size());
    flow->sample(x, values);
    return {values[0], values[1], values[2]};
  }
};

TEST(JetInlet, AJetThroughAnyFaceIsTheSameJetTurned) {
  for (const std::string solver : kSolvers) {
    const Blown upwards(box(solver, 4, ""));
    ASSERT_GT(upwards.velocity({0, 0, 0.05}).z(), 20.0);
    for (const int face : {0, 1, 2, 3, 5}) {
      Vec3 along = Vec3::Zero();
      along[face / 2] = face % 2 ? -1.0 : 1.0;
      const Vec3 across = Vec3::Unit((face / 2 + 1) % 3);
      const Blown turned(
          box(solver, face, fmt::format("direction = [{}, {}, {}]", along.x(), along.y(), along.z())));
      for (const double height : {0.042, 0.05, 0.06})
        for (const double beside : {0.0, 0.003, 0.008}) {
          const Vec3 u = upwards.velocity({beside, 0, height});
          const Vec3 v = turned.velocity(height * along + beside * across);
          EXPECT_NEAR(v.dot(along), u.z(), 0.05)
              << solver << " " << kFaces[std::size_t(face)] << " " << height;
          EXPECT_NEAR(v.dot(across), u.x(), 0.05)
              << solver << " " << kFaces[std::size_t(face)] << " " << height;
        }
    }
  }
}

TEST(JetInlet, AJetOnAPlaneOfSymmetryIsHalfOfTheWholeOne) {
  for (const std::string solver : kSolvers) {
    const Blown whole(box(solver, 4, "")), half(box(solver, 4, "", 0.0));
    for (const Vec3& x : {Vec3(0.003, 0.001, 0.045), Vec3(0.005, -0.005, 0.055), Vec3(0.001, 0.003, 0.06)})
      EXPECT_LT((whole.velocity(x) - half.velocity(x)).norm(), 0.05) << solver;
  }
}

TEST(JetInlet, JetsOffTheCentreMirrorEachOther) {
  const std::string pair =
      "nozzle = [\"5 mm\", \"0 mm\", \"0 mm\"]\nmore_nozzles = [[\"-5 mm\", \"0 mm\", \"0 mm\"]]";
  for (const std::string solver : kSolvers) {
    const Blown whole(box(solver, 4, pair)), half(box(solver, 4, pair, 0.0));
    for (const Vec3& x : {Vec3(0.005, 0.001, 0.045), Vec3(0.003, -0.005, 0.055), Vec3(0.009, 0.003, 0.06)}) {
      const Vec3 left(-x.x(), x.y(), x.z()), u = whole.velocity(x), v = whole.velocity(left);
      EXPECT_LT((u - Vec3(-v.x(), v.y(), v.z())).norm(), 0.05) << solver;
      EXPECT_LT((u - half.velocity(x)).norm(), 0.05) << solver;
    }
    EXPECT_GT(whole.velocity({0.005, 0, 0.045}).z(), whole.velocity({0, 0, 0.045}).z());
  }
}

TEST(JetInlet, MomentumOfJetsThatMeetAddsUp) {
  const auto state = [](const std::string& jet) {
    return JetInlet(parse_case(box("incompressible", 4, jet), "box")).at({1e-3, 0, 0.04}, {}, 5e-3).velocity;
  };
  const std::string left = "[\"-5 mm\", \"0 mm\", \"0 mm\"]", right = "[\"5 mm\", \"0 mm\", \"0 mm\"]";
  const Vec3 one = state("nozzle = " + left), other = state("nozzle = " + right),
             both = state("nozzle = " + left + "\nmore_nozzles = [" + right + "]");
  EXPECT_LT((both.norm() * both - one.norm() * one - other.norm() * other).norm(), 1e-9 * both.squaredNorm());
}

TEST(JetInlet, AJetAslantIsTheStraightOneAtTheSameHeight) {
  const JetInlet straight(parse_case(box("incompressible", 4, ""), "box")),
      aslant(parse_case(
          box("incompressible", 4, "nozzle = [\"-40 mm\", \"0 mm\", \"0 mm\"]\ndirection = [1, 0, 1]"),
          "box"));
  const double time = 5e-3, half = std::sqrt(0.5);
  const Vec3 along(half, 0, half), across(half, 0, -half), orifice(-0.04, 0, 0);
  for (const double height : {0.05, 0.0566, 0.06})
    for (const double beside : {-0.004, 0.0, 0.004}) {
      const Vec3 u = straight.at({beside, 0, height}, {}, time).velocity;
      const Vec3 v = aslant.at(orifice + height * along + beside * across, {}, time).velocity;
      EXPECT_LT((v - u.z() * along - u.x() * across).norm(), 1e-9 * u.norm());
    }
  const Blown flow(
      box("compressible-piso", 4, "nozzle = [\"-40 mm\", \"0 mm\", \"0 mm\"]\ndirection = [1, 0, 1]"));
  const Vec3 u = flow.velocity({0.006, 0, 0.046});
  EXPECT_GT(u.x(), 20.0);
  EXPECT_NEAR(u.x() / u.z(), 1.0, 0.1);
}

// The stored jet is a disc; a face aslant cuts the cone that it belongs to.
TEST(JetInlet, AComputedJetAslantIsContinuedAsACone) {
  const ScratchDirectory scratch;
  setenv("EJECTA_CACHE", scratch.path().c_str(), 1);
  std::ofstream(scratch.path() / "jet.toml") << test::small_jet();
  const std::string placed = R"(
[run]
end_time = "0.2 ms"
[flow]
solver = "compressible-piso"
[valve]
supply_pressure = "700 kPa gauge"
orifice_diameter = "1.8 mm"
rise_time = "0.02 ms"
fall_time = "0 ms"
duration = "0.1 ms"
[grid.x]
points = ["-6 mm", "6 mm"]
cells = [12]
[grid.y]
points = ["-6 mm", "6 mm"]
cells = [12]
[grid.z]
points = ["8 mm", "20 mm"]
cells = [12]
[boundary.z_min]
type = "jet"
[jet]
kind = "computed"
source_case = "jet.toml"
nozzle = ["-6 mm", "0 mm", "0 mm"]
direction = [0.75, 0, 1]
)";
  std::ofstream(scratch.path() / "box.toml") << placed;
  const JetInlet inlet(load_case((scratch.path() / "box.toml").string()));
  unsetenv("EJECTA_CACHE");
  const Vec3 along(0.6, 0, 0.8), across(0.8, 0, -0.6), orifice(-6e-3, 0, 0);
  const auto velocity = [&](double height, double beside) {
    return inlet.at(orifice + height * along + beside * across, {}, 1e-4).velocity;
  };
  const Vec3 stored = velocity(10e-3, 0.0);
  EXPECT_GT(stored.norm(), 100.0);
  EXPECT_NEAR(stored.dot(along) / stored.norm(), 1.0, 1e-9);
  for (const double beside : {0.0, 0.5e-3, 1e-3})
    EXPECT_LT((1.2 * velocity(12e-3, 1.2 * beside) - velocity(10e-3, beside)).norm(), 1e-9 * stored.norm());
  EXPECT_EQ(velocity(-1e-3, 0.0).norm(), 0.0);
}

}  // namespace
}  // namespace ejecta
