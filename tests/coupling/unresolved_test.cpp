#include "coupling/unresolved/unresolved.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/parallel.hpp"
#include "flow/piso/incompressible.hpp"

/// Grains mapped to a flow: sums are exact, what acts is equal and opposite, nothing jumps.
namespace ejecta {
namespace {

constexpr double kRoundOff = 20 * double(std::numeric_limits<Real>::epsilon());

Body grain_at(const Vec3& x, double d, double density = 2650) {
  Body b{.name = "grain", .shape = make_sphere(d), .enters_at = {}};
  b.mass = density * b.shape.mass_properties().volume;
  b.position = x;
  return b;
}

Axis graded(double length, int cells, double grading) { return make_axis({0.0, length}, {cells}, {grading}); }

std::vector<Body> cloud(int count, const Vec3& size, double d, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<Body> all;
  for (int n = 0; n < count; ++n) {
    all.push_back(grain_at(size.cwiseProduct(Vec3(part(random), part(random), part(random))), d));
    all.back().velocity = Vec3(part(random), part(random) - 0.5, -part(random));
  }
  return all;
}

double volume_of(const std::vector<Body>& grains) {
  double sum = 0;
  for (const Body& b : grains) sum += b.shape.mass_properties().volume;
  return sum;
}

using Sides = std::array<std::array<Beyond, 2>, 3>;
constexpr std::array<Beyond, 2> kWalls{Beyond::mirror, Beyond::mirror},
    kJoined{Beyond::periodic, Beyond::periodic}, kOpen{Beyond::outside, Beyond::outside};

UnresolvedSetup air(const Sides& beyond) {
  UnresolvedSetup s;
  s.fluid_density = 1.2;
  s.viscosity = 1.5e-5;
  s.beyond = beyond;
  s.drag = drag::find_drag<drag::di_felice>;
  return s;
}

TEST(GrainKernel, WeightsAddUpToOneAndFadeOnlyThroughOpenSides) {
  const Axis axis = graded(0.02, 20, 4.0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 0.02), size(0.2e-3, 6e-3);
  for (int n = 0; n < 1000; ++n) {
    const double x = place(random), h = kernel_half_width(axis, x, size(random));
    for (const auto& sides : {kWalls, kJoined, kOpen}) {
      if (h > 2.5e-3) continue;
      const AxisWeights w = axis_weights(axis, x, h, sides);
      double sum = 0;
      for (int c = 0; c < w.count; ++c) sum += w.weight[static_cast<std::size_t>(c)];
      const double outside = kernel_below(-x / h) + 1 - kernel_below((0.02 - x) / h);
      EXPECT_NEAR(sum, sides == kOpen ? 1 - outside : 1.0, 1e-12);
    }
  }
}

/// A step of a thousandth of the width moves no weight by more than the kernel's height says.
TEST(GrainKernel, NothingJumpsAsAGrainMoves) {
  for (const auto& sides : {kWalls, kJoined, kOpen}) {
    const Axis axis = graded(0.02, 20, 1.0);
    std::vector<double> before;
    for (double x = 0; x <= 0.02; x += 1e-6) {
      const AxisWeights w = axis_weights(axis, x, kernel_half_width(axis, x, 1e-3), sides);
      std::vector<double> now(20, 0.0);
      for (int c = 0; c < w.count; ++c)
        now[static_cast<std::size_t>((w.first + c + 20) % 20)] += w.weight[static_cast<std::size_t>(c)];
      for (std::size_t c = 0; c < 20 && !before.empty(); ++c) EXPECT_LT(std::abs(now[c] - before[c]), 2.1e-3);
      before = now;
    }
  }
}

TEST(UnresolvedCoupling, VolumeIsExactAtWallsAndAcrossPeriodicSides) {
  const Grid grid(graded(0.012, 12, 2.0), graded(0.01, 10, 1.0), graded(0.02, 16, 0.5));
  const std::vector<Body> grains = cloud(500, Vec3(0.012, 0.01, 0.02), 0.3e-3, 1);
  for (const Sides& sides : {Sides{kWalls, kWalls, kWalls}, Sides{kWalls, kJoined, kWalls}}) {
    UnresolvedCoupling coupling(grid, air(sides));
    FluidFraction f(grid);
    const Field still = grid.make_field();
    coupling.map(grains, std::vector<char>(grains.size(), 1), {{still.view(), still.view(), still.view()}},
                 {}, 1e-3, f);
    // A sum over the cells: each of its additions may be off by half of the last digit.
    const double digits = 0.5 * static_cast<double>(grid.cells()) * std::numeric_limits<double>::epsilon();
    EXPECT_NEAR(coupling.mapped_volume(f) / volume_of(grains), 1.0, std::max(kRoundOff, digits));
  }
}

/// What grains get by drag is what the fields say that the fluid loses; what they get by the gradient of the
/// pressure is what is missing to the fluid where they are.
TEST(UnresolvedCoupling, ActionIsReaction) {
  const Grid grid(graded(0.012, 12, 2.0), graded(0.01, 10, 1.0), graded(0.02, 16, 0.5));
  const std::vector<Body> grains = cloud(500, Vec3(0.012, 0.01, 0.02), 0.3e-3, 2);
  UnresolvedCoupling coupling(grid, air({kWalls, kJoined, kWalls}));
  FluidFraction f(grid);
  std::array<Field, 3> u{grid.make_field(), grid.make_field(), grid.make_field()};
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 12; ++i)
        for (int c = 0; c < 3; ++c) {
          u[std::size_t(c)](i, j, k) = Real(std::sin(0.7 * i + 1.3 * j - k + c));
          f.seen[std::size_t(c)](i, j, k) = Real(std::cos(1.1 * i - 0.3 * j + 2 * k + c));
          f.push[std::size_t(c)](i, j, k) = Real(std::sin(i * j + k + c));
        }
  const std::vector<char> here(grains.size(), 1);
  coupling.map(grains, here, {{u[0].view(), u[1].view(), u[2].view()}}, {}, 1e-3, f);
  std::vector<Load> loads(grains.size());
  coupling.collect(grains, here, f, loads);
  Vec3 on_grains(0, 0, 0), by_drag(0, 0, 0), from_fluid(0, 0, 0);
  double size = 0;
  for (std::size_t n = 0; n < grains.size(); ++n) {
    on_grains += loads[n].force;
    by_drag += coupling.drag_forces()[n];
    size += coupling.drag_forces()[n].norm();
  }
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 12; ++i)
        for (int c = 0; c < 3; ++c) {
          const std::size_t d = static_cast<std::size_t>(c);
          from_fluid[c] +=
              1.2 * grid.volume(i, j, k) *
              (double(f.drag(i, j, k)) * double(f.seen[d](i, j, k)) - double(f.dragging[d](i, j, k)) +
               double(f.solids(i, j, k)) * double(f.push[d](i, j, k)));
        }
  EXPECT_LT((on_grains - from_fluid).norm(), kRoundOff * size);
  EXPECT_GT(by_drag.norm(), 1e-3 * size);  // there is something to compare
}

TEST(UnresolvedCoupling, AnyNumberOfThreadsGivesTheSameBits) {
  const Grid grid(graded(0.012, 12, 2.0), graded(0.01, 10, 1.0), graded(0.02, 16, 0.5));
  const std::vector<Body> grains = cloud(3000, Vec3(0.012, 0.01, 0.02), 0.3e-3, 3);
  const std::vector<char> here(grains.size(), 1);
  const int before = thread_count();
  std::vector<std::vector<Real>> all;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    UnresolvedCoupling coupling(grid, air({kWalls, kWalls, kWalls}));
    FluidFraction f(grid);
    Field u = grid.make_field();
    u.fill(Real(1.5));
    coupling.map(grains, here, {{u.view(), u.view(), u.view()}}, {}, 1e-3, f);
    std::vector<Load> loads(grains.size());
    coupling.collect(grains, here, f, loads);
    std::vector<Real> numbers;
    for (const Field* field : {&f.solids, &f.drag, &f.dragging[0], &f.dragging[2]})
      numbers.insert(numbers.end(), field->data(), field->data() + field->size());
    for (const Load& l : loads) numbers.push_back(static_cast<Real>(l.force.x() + l.force.z()));
    all.push_back(numbers);
  }
  set_thread_count(before);
  EXPECT_EQ(all[0], all[1]);
  EXPECT_EQ(all[0], all[2]);
}

/// A stiff grain in a wind that it does not notice: after one step of a hundred of its times it has come to
/// its own velocity in it, gravity counted, and a slow one has gained what an exact solution says.
TEST(UnresolvedCoupling, DragIsTheExactRelaxationForAnyStep) {
  const Grid grid(graded(0.01, 10, 1.0), graded(0.01, 10, 1.0), graded(0.01, 10, 1.0));
  UnresolvedSetup setup = air({kWalls, kWalls, kWalls});
  setup.drag = drag::find_drag<drag::stokes>;
  setup.acts = false;
  setup.gravity = {0, 0, -9.81};
  setup.fluid_density = 1e-3;  // no buoyancy to speak of
  setup.viscosity = 1.8e-2;
  Field u = grid.make_field();
  u.fill(Real(2));
  const double d = 50e-6, tau = 2650 * d * d / 18 / 1.8e-5;
  for (const double steps : {0.01, 1.0, 100.0}) {
    UnresolvedCoupling coupling(grid, setup);
    FluidFraction f(grid);
    for (Field& seen : f.seen) seen = u;
    std::vector<Body> grains{grain_at({5e-3, 5e-3, 5e-3}, d)};
    const double dt = steps * tau;
    coupling.map(grains, {1}, {{u.view(), u.view(), u.view()}}, {}, dt, f);
    std::vector<Load> loads(1);
    coupling.collect(grains, {1}, f, loads);
    const Vec3 after = dt * (loads[0].force / grains[0].mass + setup.gravity);
    const double gained = 1 - std::exp(-steps);
    EXPECT_NEAR(after.x(), 2 * gained, 1e-5 * gained);
    EXPECT_NEAR(after.z(), (2 - 9.81 * tau) * gained, 1e-5 * gained);
  }
}

std::array<Boundary, 6> all_of(BoundaryKind kind) {
  std::array<Boundary, 6> faces;
  for (Boundary& b : faces) b.kind = kind;
  return faces;
}

/// Flow and grains as a run does them, grains on courses of their own.
struct Stirred {
  Grid grid;
  Incompressible flow;
  UnresolvedCoupling coupling;
  FluidFraction f;
  std::vector<Body> grains;
  std::vector<Load> loads;

  Stirred(Grid g, BoundaryKind kind, const IncompressibleSetup& fluid, UnresolvedSetup setup,
          std::vector<Body> all)
      : grid(std::move(g)),
        flow(grid, all_of(kind), fluid),
        coupling(grid, setup),
        f(grid),
        grains(std::move(all)),
        loads(grains.size()) {
    flow.initialise([](const Vec3&) { return Vec3(0, 0, 0); }, [](const Vec3&) { return 0.0; }, 0.0);
    flow.stable_dt(1.0);
  }
  void advance(double time, double dt) {
    const std::vector<char> here(grains.size(), 1);
    CutCells none;
    coupling.map(grains, here, {flow.velocity()}, none, dt, f);
    flow.advance(time, dt, none, f);
    coupling.collect(grains, here, f, loads);
    for (Body& b : grains) b.position += dt * b.velocity;
  }
};

IncompressibleSetup fluid_of(double density, double viscosity) {
  IncompressibleSetup s;
  s.density = density;
  s.viscosity = viscosity;
  return s;
}

/// Fluid at rest, any void fraction, held grains, gravity: nothing moves, and on each grain acts -rho V_p g.
TEST(FluidWithGrains, StaysAtRestWithGravityAndHeldGrains) {
  const Axis a = graded(0.012, 12, 3.0);
  std::vector<Body> grains = cloud(800, Vec3(0.012, 0.012, 0.006), 0.3e-3, 4);
  for (Body& b : grains) b.motion = Motion::fixed, b.velocity.setZero();
  UnresolvedSetup setup = air({kWalls, kWalls, kWalls});
  setup.gravity = {0, 0, -9.81};
  Stirred s(Grid(a, a, a), BoundaryKind::wall, fluid_of(1.2, 1.5e-5), setup, grains);
  for (int n = 0; n < 20; ++n) s.advance(n * 1e-3, 1e-3);
  for (int c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < s.flow.velocity_field(c).size(); ++n)
      ASSERT_EQ(s.flow.velocity_field(c).data()[n], Real(0));
  for (std::size_t n = 0; n < grains.size(); ++n)
    EXPECT_NEAR(s.loads[n].force.z() / (1.2 * 9.81 * s.grains[n].shape.mass_properties().volume), 1.0, 1e-6);
}

/// A cloud carried through still fluid with drag off: the fluid makes room. Continuity holds to the solver's
/// tolerance, and what momentum the fluid has came from the grains and the walls.
TEST(FluidWithGrains, MakesRoomForACloudThatIsCarried) {
  const Axis a = graded(0.016, 16, 1.0);
  std::vector<Body> grains;
  for (int n = 0; n < 60; ++n) {
    const double t = 2.4 * n, z = 1 - (2.0 * n + 1) / 60;
    grains.push_back(grain_at(Vec3(5e-3, 8e-3, 8e-3) + 1e-3 * Vec3(std::sqrt(1 - z * z) * std::cos(t),
                                                                   std::sqrt(1 - z * z) * std::sin(t), z),
                              0.3e-3));
    grains.back().motion = Motion::fixed;
    grains.back().velocity = {0.2, 0, 0};
  }
  UnresolvedSetup setup = air({kWalls, kWalls, kWalls});
  setup.drag = nullptr;
  Stirred s(Grid(a, a, a), BoundaryKind::mirror, fluid_of(1.2, 1.5e-5), setup, grains);
  CutCells none;
  const double volume = volume_of(grains);
  double fastest = 0;
  for (int n = 0; n < 100; ++n) {
    s.advance(n * 2e-4, 2e-4);
    EXPECT_NEAR(s.coupling.mapped_volume(s.f) / volume, 1.0, kRoundOff);
    if (n > 1) EXPECT_LT(s.flow.largest_divergence(none), 2e-5);
    for (std::size_t m = 0; m < s.flow.velocity_field(0).size(); ++m)
      fastest = std::max(fastest, std::abs(double(s.flow.velocity_field(0).data()[m])));
    Vec3 given(0, 0, 0);
    for (const Load& l : s.loads) given += 2e-4 * l.force;
    EXPECT_LT((given - s.flow.impulse_on_grains()).norm(), 1e-5 * std::max(given.norm(), 1e-9));
  }
  EXPECT_GT(fastest, 1e-3);  // it does flow
}

/// Drag on one grain dragged through cells of three diameters, aslant to them, in a fluid that it moves:
/// ripples by less than 1 %, and a grid shifted by half a cell gives the same mean within that.
TEST(FluidWithGrains, DragOnAGrainRipplesLittleAsItCrossesCells) {
  const double d = 1e-3, h = 3e-3;
  double mean[2] = {0, 0};
  for (const int shifted : {0, 1}) {
    const Axis x = make_axis({0.0, 24 * h}, {24}, {}), y = make_axis({0.0, 8 * h}, {8}, {});
    const double off = shifted ? 0.5 * h : 0.0;
    std::vector<Body> grains{grain_at(Vec3(4.2 * h, 4.1 * h, 4.0 * h) + Vec3::Constant(off), d)};
    grains[0].motion = Motion::fixed;
    grains[0].velocity = {5.0, 0.9, 0.7};
    Stirred s(Grid(x, y, y), BoundaryKind::mirror, fluid_of(1.2, 1.5e-5), air({kWalls, kWalls, kWalls}),
              grains);
    double least = 1e300, most = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 180; ++n) {
      s.advance(n * 5e-5, 5e-5);
      if (n < 60) continue;
      const double force = s.coupling.drag_forces()[0].norm();
      least = std::min(least, force);
      most = std::max(most, force);
      sum += force;
      ++count;
    }
    mean[shifted] = sum / count;
    EXPECT_LT((most - least) / mean[shifted], 0.01);
  }
  EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.01);
}

/// One way, the flow keeps its bits.
TEST(FluidWithGrains, GrainsThatDoNotActChangeNoBit) {
  const Axis a = graded(0.012, 12, 2.0);
  const auto swirl = [](const Vec3& x) { return Vec3(std::sin(500 * x.y()), std::sin(500 * x.x()), 0.1); };
  std::vector<std::vector<Real>> all;
  for (const bool with : {false, true}) {
    const Grid grid(a, a, a);
    Incompressible flow(grid, all_of(BoundaryKind::wall), fluid_of(1.2, 1.5e-5));
    flow.initialise(
        swirl, [](const Vec3&) { return 0.0; }, 0.0);
    const std::vector<Body> grains = cloud(100, Vec3(0.012, 0.012, 0.012), 0.3e-3, 5);
    UnresolvedCoupling coupling(grid, air({kWalls, kWalls, kWalls}));
    FluidFraction f(grid);
    f.acts = false;
    flow.stable_dt(1.0);
    for (int n = 0; n < 10; ++n) {
      CutCells none;
      if (!with) {
        flow.advance(n * 1e-4, 1e-4, none);
        continue;
      }
      coupling.map(grains, std::vector<char>(grains.size(), 1), {flow.velocity()}, none, 1e-4, f);
      flow.advance(n * 1e-4, 1e-4, none, f);
    }
    std::vector<Real> cells;
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 12; ++k)
        for (int j = 0; j < 12; ++j)
          for (int i = 0; i < 12; ++i) cells.push_back(flow.velocity_field(c)(i, j, k));
    all.push_back(cells);
  }
  EXPECT_EQ(all[0], all[1]);
}

}  // namespace
}  // namespace ejecta
