#include "flow/piso/incompressible.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "coupling/resolved/resolved.hpp"

/// Bodies in incompressible flow: what must be kept, and forces that are known.
namespace ejecta {
namespace {

constexpr bool kSingle = sizeof(Real) == 4;
constexpr double kDensity = 1.2;

Body body_of(Shape shape, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Body b{.name = "body", .shape = std::move(shape), .enters_at = {}};
  b.mass = 1.0;
  b.position = position;
  b.velocity = velocity;
  return b;
}

Body turned(Body b, double angle, const Vec3& axis) {
  b.orientation = Quat(Eigen::AngleAxisd(angle, axis.normalized()));
  return b;
}

Axis even(double low, double high, int n) { return make_axis({low, high}, {n}, {}); }

std::array<Boundary, 6> all(BoundaryKind kind) {
  std::array<Boundary, 6> faces;
  for (Boundary& b : faces) b.kind = kind;
  return faces;
}

/// Flow with bodies that move as they are told.
struct Bodies {
  Grid grid;
  std::vector<Body> bodies;
  Incompressible flow;
  ResolvedCoupling coupling;
  CutCells mask;
  std::vector<Load> loads;
  double time = 0.0;

  Bodies(Grid g, const std::array<Boundary, 6>& faces, IncompressibleSetup setup, std::vector<Body> them,
         const Vec3& velocity)
      : grid(std::move(g)),
        bodies(std::move(them)),
        flow(grid, faces, with_density(setup)),
        coupling(grid, coupling_setup(faces)),
        loads(bodies.size()) {
    if (setup.turbulence) flow.turbulence()->initialise(1e-2, 0.1);
    flow.initialise([&](const Vec3&) { return velocity; }, [](const Vec3&) { return 0.0; }, 0.0);
  }
  static IncompressibleSetup with_density(IncompressibleSetup s) {
    s.density = kDensity;
    return s;
  }
  static CouplingSetup coupling_setup(const std::array<Boundary, 6>& faces) {
    CouplingSetup s;
    s.fluid_density = kDensity;
    for (std::size_t d = 0; d < 3; ++d) s.periodic[d] = faces[2 * d].kind == BoundaryKind::periodic;
    return s;
  }
  void step(double dt) {
    coupling.map(bodies, mask);
    flow.advance(time, dt, mask);
    coupling.collect(bodies, mask, dt, loads);
    time += dt;
    for (Body& b : bodies) {
      b.position += dt * b.velocity;
      const double turn = dt * b.angular_velocity.norm();
      if (turn > 0.0)
        b.orientation = Quat(Eigen::AngleAxisd(turn, b.angular_velocity.normalized())) * b.orientation;
      for (int d = 0; d < 3; ++d)  // into a periodic box
        if (flow.boundaries().kind(2 * d) == BoundaryKind::periodic) {
          const double length = grid.axis(d).length();
          b.position[d] -= length * std::floor((b.position[d] - grid.lower()[d]) / length);
        }
    }
  }
  /// What the ledger cannot explain, N s.
  double lost(const Vec3& start) const {
    const FlowLedger& l = flow.ledger();
    return (flow.momentum() - start - l.momentum_through_boundaries + l.impulse_on_solids - l.displaced)
        .norm();
  }
};

/// Single precision in a box that fixes no pressure: round-off of the pressure equation.
void expect_uniform(const Bodies& b, const Vec3& u, int step) {
  const double part = !kSingle ? 1e-9 : b.flow.boundaries().open() ? 1e-4 : 1e-3;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < b.grid.nz(); ++k)
      for (int j = 0; j < b.grid.ny(); ++j)
        for (int i = 0; i < b.grid.nx(); ++i)
          ASSERT_NEAR(b.flow.velocity_field(c)(i, j, k), u[c], part * u.norm())
              << c << " at " << i << " " << j << " " << k << " in step " << step;
}

TEST(BodiesInLiquid, ABodyThatMovesWithTheStreamLeavesItAlone) {
  const Vec3 u(30, -12, 9);
  for (const bool periodic : {true, false})
    for (const bool turbulent : {false, true}) {
      std::array<Boundary, 6> faces = all(periodic ? BoundaryKind::periodic : BoundaryKind::inflow);
      if (!periodic) {
        for (Boundary& b : faces)
          b.state = [u](const Vec3&, double) {
            BoundaryState s;
            for (int d = 0; d < 3; ++d) s.velocity[std::size_t(d)] = static_cast<Real>(u[d]);
            s.k = Real(1e-2), s.dissipation = Real(0.1);
            return s;
          };
        faces[1].kind = BoundaryKind::open;
      }
      IncompressibleSetup setup;
      if (turbulent) setup.turbulence = TwoEquationModel::k_epsilon;
      Bodies b(Grid(even(0, 1, 20), even(0, 1, 20), even(0, 1, 18)), faces, setup,
               {body_of(make_sphere(0.32), {0.3, 0.7, 0.31}, u),
                turned(body_of(make_box({0.3, 0.25, 0.2}), {0.31, 0.35, 0.7}, u), 0.5, {1, 2, 3})},
               u);
      const double area = 0.08, scale = 0.5 * kDensity * u.squaredNorm() * area;
      for (int n = 0; n < (periodic ? 40 : 12); ++n) {
        b.step(b.flow.stable_dt(0.8));
        expect_uniform(b, u, n);
        if (testing::Test::HasFatalFailure()) return;
        for (const Load& l : b.loads) {
          EXPECT_LT(l.force.norm(), 1e-3 * scale) << periodic << turbulent << " " << n;
        }
      }
    }
}

/// A square bar carried through air at rest, 10 cells across: its drag must not tell in which part of a cell
/// its walls are, however short the step is. (An impulse that does not fade with the step makes the force
/// go with 1 / step: 10 times the drag in single steps.)
TEST(BodiesInLiquid, ABodyThatCrossesCellsIsPushedEvenly) {
  std::array<Boundary, 6> faces = all(BoundaryKind::mirror);
  faces[0].kind = faces[1].kind = BoundaryKind::open;
  IncompressibleSetup setup;
  setup.viscosity = 0.01;
  for (const double angle : {0.0, 0.4})
    for (const double dt : {0.02, 0.005}) {
      Bodies b(Grid(even(-2, 2, 40), even(-0.5, 0.5, 1), even(-1.5, 1.5, 30)), faces, setup,
               {turned(body_of(make_box({1.03, 4, 1}), {1.3, 0, 0}, {-1, 0, 0}), angle, Vec3::UnitY())},
               Vec3::Zero());
      double sum = 0.0, least = 1e300, most = 0.0;
      int steps = 0;
      while (b.time < 1.2) {
        b.step(dt);
        if (b.time < 0.7) continue;  // the start
        const double push = b.loads[0].force.x();
        sum += push, ++steps;
        least = std::min(least, push);
        most = std::max(most, push);
      }
      EXPECT_LT(most, 1.6 * sum / steps) << angle << " " << dt;
      EXPECT_GT(least, 0.5 * sum / steps) << angle << " " << dt;
    }
}

/// The tail of a bar that stands on its edge enters a box of long cells through an open face: cells on either
/// side of the edge are cut alike, and what passes between them must not feed on itself.
TEST(BodiesInLiquid, ATailThatEntersDrawsNoMoreThanItLeaves) {
  std::array<Boundary, 6> faces = all(BoundaryKind::mirror);
  faces[0].kind = faces[1].kind = BoundaryKind::open;
  IncompressibleSetup setup;
  setup.viscosity = 0.01;
  for (const double angle : {0.785398, 0.7}) {
    Bodies b(Grid(even(-2, 2, 10), even(-0.5, 0.5, 1), even(-1.5, 1.5, 30)), faces, setup,
             {turned(body_of(make_box({1, 4, 1}), {-1.7, 0, 0}, {1, 0, 0}), angle, Vec3::UnitY())},
             Vec3::Zero());
    double most = 0.0;
    while (b.time < 1.0) {
      b.step(0.001);  // many while the tail is in one cell
      if (b.time > 0.2) most = std::max(most, b.loads[0].force.norm());
    }
    EXPECT_LT(most, 10.0) << angle;  // N; 0.6 N is the drag, cells four times as long as wide ring
  }
}

/// A box slips into a box of long cells through an open face, aslant: beside the face a cell carries several
/// small ones, each with an open end. What enters through one and leaves through the next has no pressure
/// against it, so nothing may drive it.
TEST(BodiesInLiquid, NothingCirclesThroughTheOpenEndsOfOneCell) {
  std::array<Boundary, 6> faces = all(BoundaryKind::mirror);
  faces[0].kind = faces[1].kind = BoundaryKind::open;
  IncompressibleSetup setup;
  setup.viscosity = 1e-3;
  for (const double angle : {0.62, 0.4, 0.9, 0.0, 0.05}) {
    Bodies b(Grid(even(-2, 2, 10), even(-0.5, 0.5, 1), even(-1.5, 1.5, 43)), faces, setup,
             {turned(body_of(make_box({1.2, 4, 1.2}), {-2.6, 0, 0}, {1, 0, 0}), angle, Vec3::UnitY())},
             Vec3::Zero());
    double most = 0.0;
    while (b.time < 1.5) {
      b.step(0.002);
      const auto u = b.flow.velocity();
      for (int k = 0; k < b.grid.nz(); ++k) most = std::max(most, std::abs(double(u[0](0, 0, k))));
    }
    EXPECT_LT(most, 10.0) << angle;  // m/s; the box comes at 1 m/s
  }
}

std::array<Boundary, 6> channel(double u) {
  std::array<Boundary, 6> faces = all(BoundaryKind::mirror);
  faces[0].kind = BoundaryKind::inflow;
  faces[0].state = [u](const Vec3&, double) {
    BoundaryState s;
    s.velocity[0] = static_cast<Real>(u);
    return s;
  };
  faces[1].kind = BoundaryKind::open;
  return faces;
}

/// Two blocks that leave a gap of a tenth of a cell, through which everything must go. What that takes is of
/// the size of a plane gap's pressure, 12 nu u length / gap^2 (Poiseuille): the gap has the pressures of its
/// two ends, so more is not to be had; but it must not grow from step to step.
TEST(BodiesInLiquid, AGapThinnerThanACellResistsAsAGapDoes) {
  const double gap = 0.01, length = 0.5, inflow = 0.1, nu = 0.05;
  IncompressibleSetup setup;
  setup.viscosity = nu;
  const auto block = [&](double side) {
    return body_of(make_box({length, 4, 1}), {0, 0, side * 0.5 * (1.0 + gap)});
  };
  Bodies b(Grid(even(-1, 1, 20), even(-0.5, 0.5, 1), even(-1, 1, 20)), channel(inflow), setup,
           {block(1), block(-1)}, {inflow, 0, 0});
  const auto run_to = [&b](double time) {
    while (b.time < time) b.step(1e-3);
    return b.loads[0].force.x();
  };
  const double early = run_to(0.1), late = run_to(0.2);
  EXPECT_NEAR(late, early, 0.02 * early);
  const double through = 2.0 * inflow / gap;
  const double push = kDensity * 12.0 * nu * through * length / (gap * gap) * (1.0 - 0.5 * gap);
  EXPECT_GT(late, push / 3);
  EXPECT_LT(late, push * 3);
}

TEST(BodiesInLiquid, APlugInAChannelIsRefused) {
  Bodies b(Grid(even(-1, 1, 20), even(-1, 1, 8), even(-1, 1, 8)), channel(1.0), {},
           {body_of(make_box({0.5, 2, 2}), Vec3::Zero())}, {1, 0, 0});
  EXPECT_THROW(b.step(1e-2), DivergedError);
}

TEST(BodiesInLiquid, MomentumOfAPeriodicBoxAndItsBodiesIsKept) {
  for (const bool turbulent : {false, true}) {
    IncompressibleSetup setup;
    if (turbulent) setup.turbulence = TwoEquationModel::k_omega_sst;
    Bodies b(Grid(even(0, 1, 20), even(0, 1, 16), even(0, 1, 18)), all(BoundaryKind::periodic), setup,
             {body_of(make_sphere(0.32), {0.95, 0.03, 0.93}, {2, 0, 1}),
              turned(body_of(make_box({0.3, 0.25, 0.2}), {0.05, 0.5, 0.5}, {-3, 0, 0}), 0.5, {1, 2, 3})},
             {20, 5, -8});
    b.bodies[1].angular_velocity = {0, 20, 10};
    const Vec3 start = b.flow.momentum();
    for (int n = 0; n < 25; ++n) b.step(b.flow.stable_dt(0.8));
    const double moved = b.flow.ledger().impulse_on_solids.norm();
    EXPECT_GT(moved, 0.01 * start.norm()) << "the bodies must have done something";
    // The two ends of the box see the same face cut by two images of a body: the same up to single precision.
    EXPECT_LT(b.lost(start), (kSingle ? 1e-4 : 1e-7) * moved);
    EXPECT_LT(b.flow.largest_divergence(b.mask), 2e-3);
  }
}

TEST(BodiesInLiquid, ABodyLeavesThroughAnOpenFaceWithWideCells) {
  const Axis along = make_axis({0, 0.4, 0.8}, {20, 5}, {1, 6}), across = even(0, 0.8, 40);
  std::vector<Ball> balls;
  for (int j = -1; j <= 1; ++j)
    for (int k = -1; k <= 1; ++k) balls.push_back({{0, 0.12 * j, 0.12 * k}, 0.11});
  Bodies b(Grid(along, across, across), all(BoundaryKind::open), {},
           {body_of(make_multisphere(balls), {0.5, 0.4, 0.4}, {3, 0, 0})}, Vec3::Zero());
  const Vec3 start = b.flow.momentum();
  // What pushes the air in the last gap out, many times over.
  const double largest = 40.0 * 0.5 * kDensity * 9.0 * 0.36 * 0.36;
  for (int n = 0; b.bodies[0].position.x() < 1.0; ++n) {
    b.step(std::min(b.flow.stable_dt(0.8), 2e-3));
    if (n < 5) continue;  // the start takes the air along at once
    ASSERT_LT(b.loads[0].force.norm(), largest) << "at " << b.bodies[0].position.x() << " in step " << n;
  }
  // Parts of faces are known to single precision.
  EXPECT_LT(b.lost(start), (kSingle ? 1e-5 : 1e-7) * b.flow.ledger().momentum_through_boundaries.norm());
}

/// A rock: the hull of points near a sphere.
Shape rock(unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<Vec3> points;
  while (points.size() < 14) {
    const Vec3 x(part(random), part(random), part(random));
    if (x.norm() > 0.3 && x.norm() < 1.0)
      points.push_back(0.5 * size * (0.8 + 0.2 * part(random)) * x.normalized());
  }
  return make_polyhedron(points);
}

/// Bodies in contact, all of them moving, in millimetres of a jet's box.
std::vector<Body> two_cubes() {
  const Shape cube = make_box({6e-3, 6e-3, 6e-3});
  return {body_of(cube, {-3.05e-3, 0.3e-3, 14e-3}, {4, 1, 8}),
          body_of(cube, {2.95e-3, -0.2e-3, 14.4e-3}, {4, 1, 8})};
}
std::vector<Body> cube_on_an_edge() {
  const Shape cube = make_box({6e-3, 6e-3, 6e-3});
  Body above = turned(body_of(cube, {0.7e-3, 0.1e-3, 13e-3 + 3e-3 + std::sqrt(18.0) * 1e-3}, {5, 1, 7}),
                      std::numbers::pi / 4, {0, 1, 0});
  above.angular_velocity = {0, 100, 30};
  return {body_of(cube, {0.1e-3, 0.3e-3, 13e-3}, {4, 1, 8}), above};
}
std::vector<Body> three_rocks() {
  std::vector<Body> rocks{body_of(rock(1, 7e-3), {-3.1e-3, 0.2e-3, 13e-3}, {4, 1, 8}),
                          body_of(rock(2, 7e-3), {2.6e-3, -0.4e-3, 13.4e-3}, {3, 1, 8}),
                          body_of(rock(3, 7e-3), {-0.2e-3, 0.3e-3, 18.2e-3}, {4, 0, 7})};
  for (std::size_t n = 0; n < 3; ++n) rocks[n].angular_velocity = Vec3(100, -50, 30) * double(n + 1);
  return rocks;
}

struct Jet : Bodies {
  explicit Jet(std::vector<Body> them) : Bodies(box(), faces(), turbulent(), std::move(them), Vec3::Zero()) {}
  static Grid box() { return {even(-13e-3, 13e-3, 22), even(-12e-3, 12e-3, 20), even(0, 28e-3, 24)}; }
  static IncompressibleSetup turbulent() {
    IncompressibleSetup s;
    s.turbulence = TwoEquationModel::k_epsilon;
    return s;
  }
  static std::array<Boundary, 6> faces() {
    std::array<Boundary, 6> f = all(BoundaryKind::open);
    f[4].kind = BoundaryKind::inflow;
    f[4].state = [](const Vec3& x, double) {
      BoundaryState s;
      const double u = 100.0 * std::exp(-(x.x() * x.x() + x.y() * x.y()) / (0.005 * 0.005));
      s.velocity[2] = static_cast<Real>(u);
      s.k = static_cast<Real>(0.02 * u * u + 1e-3);
      s.dissipation = static_cast<Real>(0.09 * s.k * s.k / 0.01);
      return s;
    };
    return f;
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n) step(std::min(flow.stable_dt(0.9), 2e-5));
  }
  /// Largest component of velocity, m/s; knows nothing of what is no number.
  double fastest() const {
    double most = 0.0;
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < grid.nz(); ++k)
        for (int j = 0; j < grid.ny(); ++j)
          for (int i = 0; i < grid.nx(); ++i)
            most = std::max(most, std::abs(double(flow.velocity_field(c)(i, j, k))));
    return most;
  }
};

using Scene = std::vector<Body> (*)();
const std::array<Scene, 3> kHeaps{two_cubes, cube_on_an_edge, three_rocks};

TEST(BodiesInLiquid, BodiesInContactGiveTheSameBitsForAnyNumberOfThreads) {
  const int threads = thread_count();
  for (const Scene scene : kHeaps) {
    set_thread_count(1);
    Jet one(scene());
    one.run(8);
    int shared = 0;
    for (const CutCell& c : one.mask.cells) shared += c.walls > 1;
    EXPECT_GT(shared, 0) << "bodies must share cells";
    for (const int n : {2, 3, 4, 2, 2, 2, 2, 2}) {
      set_thread_count(n);
      Jet more(scene());
      more.run(8);
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < one.grid.nz(); ++k)
          for (int j = 0; j < one.grid.ny(); ++j)
            for (int i = 0; i < one.grid.nx(); ++i)
              ASSERT_EQ(one.flow.velocity_field(c)(i, j, k), more.flow.velocity_field(c)(i, j, k))
                  << n << " threads";
      for (std::size_t b = 0; b < one.loads.size(); ++b) {
        ASSERT_EQ(one.loads[b].force, more.loads[b].force) << n << " threads";
        ASSERT_EQ(one.loads[b].torque, more.loads[b].torque) << n << " threads";
      }
    }
  }
  set_thread_count(threads);
}

TEST(BodiesInLiquid, BodiesInContactKeepMomentumAsOneDoes) {
  for (const Scene scene : kHeaps) {
    Jet jet(scene());
    const Vec3 start = jet.flow.momentum();
    jet.run(40);
    const FlowLedger& l = jet.flow.ledger();
    const double given = std::abs(l.momentum_through_boundaries.z()) + l.impulse_on_solids.norm();
    EXPECT_LT(jet.lost(start), (kSingle ? 1e-4 : 1e-8) * given);
    EXPECT_LT(jet.flow.largest_divergence(jet.mask), 2e-3);
    EXPECT_TRUE(jet.flow.finite());
    EXPECT_LT(jet.fastest(), 130.0) << "nothing is much faster than the jet";
    for (const Load& load : jet.loads) EXPECT_LT(load.force.norm(), kDensity * 1e4 * 49e-6 * 4);
  }
}

/// Rocks and boxes that keep their places to each other while cells pass over them: in contact, in each
/// other, with gaps of every width.
std::vector<Body> random_heap(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<Body> heap;
  const int count = 2 + static_cast<int>(seed % 3);
  for (int n = 0; n < count; ++n) {
    const double size = (6.5 + 1.5 * part(random)) * 1e-3;
    const Vec3 at(5.5e-3 * part(random), 5e-3 * part(random), 14e-3 + 4.5e-3 * part(random));
    const Vec3 axis(part(random), part(random), part(random) + 1.5);
    heap.push_back(turned(
        body_of(n % 2 ? make_box({size, 0.8 * size, size}) : rock(seed + unsigned(n), size), at, {4, 1, 8}),
        3.0 * part(random), axis));
  }
  return heap;
}

TEST(BodiesInLiquid, HeapsOfRocksDriveTheAirNoFasterThanTheJet) {
  const char* asked = std::getenv("EJECTA_HEAPS");
  const unsigned heaps = asked ? static_cast<unsigned>(std::atoi(asked)) : 12;
  for (unsigned seed = 1; seed <= heaps; ++seed) {
    Jet jet(random_heap(seed));
    for (int n = 0; n < 60; ++n) {
      jet.run(1);
      ASSERT_TRUE(jet.flow.finite()) << "heap " << seed << ", step " << n;
      ASSERT_LT(jet.fastest(), 200.0) << "heap " << seed << ", step " << n;
    }
  }
}

/// Drag coefficient of a cube in a stream at Re = 100 once it has settled.
double settled_drag(double courant) {
  std::array<Boundary, 6> faces = all(BoundaryKind::mirror);
  faces[0].kind = BoundaryKind::inflow;
  faces[0].state = [](const Vec3&, double) {
    BoundaryState s;
    s.velocity[0] = 1;
    return s;
  };
  faces[1].kind = BoundaryKind::open;
  IncompressibleSetup setup;
  setup.viscosity = 0.004;
  Bodies b(Grid(even(-1, 1.4, 24), even(-1, 1, 20), even(-1, 1, 20)), faces, setup,
           {body_of(make_box({0.4, 0.4, 0.4}), {0.01, 0.02, -0.03})}, {1, 0, 0});
  const double end = 4.0;
  while (b.time < end - 1e-9) {
    // stable_dt() leaves room for viscosity, hardly any here
    const double dt = courant / b.flow.courant(1.0);
    const int left = static_cast<int>(std::ceil((end - b.time) / dt - 1e-9));
    b.step((end - b.time) / left);
  }
  return b.loads[0].force.x() / (0.5 * kDensity * 0.16);
}

TEST(BodiesInLiquid, DragDoesNotDependOnTheStep) {
  const double large = settled_drag(0.9), small = settled_drag(0.45);
  EXPECT_NEAR(large / small, 1.0, 0.01) << large << " " << small;
  EXPECT_NEAR(large, 1.3, 0.4);  // of free cubes 1.1 (Saha 2004); a fifth of the box's width here
}

TEST(BodiesInLiquid, AFluidAtRestPushesUpByItsWeightAndStaysAtRest) {
  const Vec3 g(3, -2, -9.81);
  for (const Vec3& at :
       {Vec3(0, 0, 0), Vec3(0.012, 0.021, -0.017), Vec3(0.031, -0.029, 0.005), Vec3(0.0249, 0.04, -0.051)})
    for (const Body& body :
         {body_of(make_box({0.7, 0.6, 0.8}), at),
          turned(body_of(make_box({0.7, 0.6, 0.8}), at), 0.4, {1, 2, 3}), body_of(make_sphere(0.8), at)}) {
      IncompressibleSetup setup;
      setup.acceleration = g;
      Bodies b(Grid(even(-1, 1, 32), even(-1, 1, 32), even(-1, 1, 32)), all(BoundaryKind::wall), setup,
               {body}, Vec3::Zero());
      for (int n = 0; n < 8; ++n) b.step(0.01);
      const Vec3 weight = kDensity * body.shape.mass_properties().volume * g;
      EXPECT_LT((b.coupling.parts()[0].pressure + weight).norm(), 0.01 * weight.norm()) << at.transpose();
      EXPECT_LT(b.coupling.parts()[0].friction.norm(), 1e-3 * weight.norm());
      EXPECT_LT(b.loads[0].torque.norm(), 1e-2 * weight.norm() * 0.4);
      // A fluid that is let go has the energy of its weight times a fraction of the depth.
      EXPECT_LT(b.flow.kinetic_energy(), 1e-6 * kDensity * 8 * g.norm() * 2) << at.transpose();
    }
}

}  // namespace
}  // namespace ejecta
