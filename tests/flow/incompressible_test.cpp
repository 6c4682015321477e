#include "flow/piso/incompressible.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <numbers>

#include "coupling/resolved/resolved.hpp"

namespace {
long allocations = 0;  // counted by the operators below while a test asks for it
bool counting = false;
}  // namespace

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace ejecta {
namespace {

constexpr bool kSingle = sizeof(Real) == 4;

/// A jet of air through a graded box with a solid in it that moves across the jet and turns.
struct JetBox {
  Grid grid{make_axis({-0.04, -0.01, 0.01, 0.04}, {6, 16, 6}, {0.2, 1, 5}),
            make_axis({-0.04, -0.01, 0.01, 0.04}, {6, 16, 6}, {0.2, 1, 5}),
            make_axis({0.04, 0.12}, {32}, {2})};
  ResolvedCoupling coupling{grid, {}};
  std::vector<Body> bodies{
      Body{.name = "cube", .shape = make_box({7.5e-3, 7.5e-3, 7.5e-3}), .enters_at = {}}};
  CutCells solids;
  std::unique_ptr<Incompressible> flow;
  double time = 0.0;

  enum class Inlet { inflow, open };  // open: the velocity is prescribed on an open face
  explicit JetBox(bool turbulent = true, Inlet inlet = Inlet::inflow) {
    std::array<Boundary, 6> faces;
    for (Boundary& b : faces) b.kind = BoundaryKind::open;
    faces[4].kind = inlet == Inlet::open ? BoundaryKind::open : BoundaryKind::inflow;
    faces[4].discs = inlet == Inlet::open;
    faces[4].state = [=](const Vec3& x, double) {
      BoundaryState s;
      const double u = 100.0 * std::exp(-(x.x() * x.x() + x.y() * x.y()) / (0.005 * 0.005));
      s.velocity[2] = static_cast<Real>(u);
      s.k = static_cast<Real>(0.05 * u * u + 1e-3);
      s.dissipation = static_cast<Real>(0.09 * s.k * s.k / 0.01);
      s.prescribed = inlet == Inlet::open;
      return s;
    };
    IncompressibleSetup setup;
    if (turbulent) setup.turbulence = TwoEquationModel::k_epsilon;
    flow = std::make_unique<Incompressible>(grid, faces, setup);
    if (turbulent) flow->turbulence()->initialise(1e-3, 0.05);
    flow->initialise([](const Vec3&) { return Vec3::Zero(); }, [](const Vec3&) { return 0.0; }, 0.0);
    bodies[0].position = {0.2e-3, 0.1e-3, 0.075};
    bodies[0].orientation = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
    bodies[0].velocity = {10, 0, 0};
    bodies[0].angular_velocity = {100, 300, -200};
    coupling.map(bodies, solids);
  }
  void step(double dt) {
    coupling.map(bodies, solids);
    flow->advance(time, dt, solids);
    Body& b = bodies[0];
    b.position += dt * b.velocity;
    b.orientation = Quat(Eigen::AngleAxisd(dt * b.angular_velocity.norm(), b.angular_velocity.normalized())) *
                    b.orientation;
    time += dt;
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n) step(std::min(flow->stable_dt(0.9), 1e-4));
  }
};

void expect_same_bits(const Incompressible& a, const Incompressible& b) {
  const Grid& grid = a.grid();
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < grid.nz(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i)
          ASSERT_EQ(a.velocity_field(c)(i, j, k), b.velocity_field(c)(i, j, k))
              << c << " " << i << " " << j << " " << k;
}

TEST(Incompressible, GivesTheSameBitsForAnyNumberOfThreads) {
  const int threads = thread_count();
  JetBox one;
  set_thread_count(1);
  one.run(12);
  for (int n : {2, 3, 4}) {
    JetBox more;
    set_thread_count(n);
    more.run(12);
    expect_same_bits(*one.flow, *more.flow);
    EXPECT_EQ(one.solids.pressure_impulse, more.solids.pressure_impulse);
    EXPECT_EQ(one.solids.friction_impulse, more.solids.friction_impulse);
  }
  set_thread_count(threads);
}

TEST(Incompressible, ConservesMomentumOfAirSolidsAndBoundaries) {
  for (bool turbulent : {false, true}) {
    JetBox box(turbulent);
    const Vec3 start = box.flow->momentum();
    box.run(60);
    const FlowLedger& l = box.flow->ledger();
    const Vec3 lost =
        box.flow->momentum() - start - l.momentum_through_boundaries + l.impulse_on_solids - l.displaced;
    const double jet = std::abs(l.momentum_through_boundaries.z()) + l.impulse_on_solids.norm();
    EXPECT_LT(lost.norm(), (kSingle ? 1e-4 : 1e-8) * jet);
    EXPECT_GT(l.impulse_on_solids.z(), 0.0);
    EXPECT_LT(l.displaced.norm(), 0.05 * jet) << "an error in time, not a force";
  }
}

TEST(Incompressible, IsFreeOfDivergenceAfterAStep) {
  JetBox empty, box;
  empty.bodies.clear();
  empty.run(10);
  EXPECT_LT(empty.flow->largest_divergence(empty.solids), kSingle ? 1e-5 : 1e-13);
  // What a correction leaves beside closed faces is met again in the next one: it must not add up.
  box.run(10);
  EXPECT_LT(box.flow->largest_divergence(box.solids), 1e-3);
  box.run(40);
  EXPECT_LT(box.flow->largest_divergence(box.solids), 1e-3);
}

TEST(Incompressible, AnOpenFaceWithAPrescribedVelocityIsAnInflow) {
  JetBox inflow(true), open(true, JetBox::Inlet::open);
  for (int n = 0; n < 20; ++n) {
    inflow.step(1e-5);
    open.step(1e-5);
  }
  double largest = 0.0;
  for (int k = 0; k < inflow.grid.nz(); ++k)
    for (int j = 0; j < inflow.grid.ny(); ++j)
      for (int i = 0; i < inflow.grid.nx(); ++i)
        largest = std::max(largest, double(std::abs(inflow.flow->velocity_field(2)(i, j, k) -
                                                    open.flow->velocity_field(2)(i, j, k))));
  EXPECT_LT(largest, 0.5) << "of 100 m/s";
  EXPECT_NEAR(open.flow->ledger().mass_in, inflow.flow->ledger().mass_in,
              0.01 * inflow.flow->ledger().mass_in);
}

TEST(Incompressible, StepsAllocateNothing) {
  JetBox box;
  const int threads = thread_count();
  set_thread_count(1);  // the runtime's own threads may allocate
  box.run(3);
  allocations = 0;
  for (int n = 0; n < 3; ++n) {
    const double dt = box.flow->stable_dt(0.9);
    counting = true;
    box.flow->advance(box.time, dt, box.solids);
    counting = false;
  }
  set_thread_count(threads);
  EXPECT_EQ(allocations, 0);
}

TEST(Incompressible, KeepsStillAirStill) {
  JetBox box;
  std::array<Boundary, 6> faces;
  for (Boundary& b : faces) b.kind = BoundaryKind::wall;
  faces[1].kind = BoundaryKind::open;
  IncompressibleSetup setup;
  setup.turbulence = TwoEquationModel::k_omega_sst;
  Incompressible flow(box.grid, faces, setup);
  flow.turbulence()->initialise(1e-4, 10.0);
  flow.initialise([](const Vec3&) { return Vec3::Zero(); }, [](const Vec3&) { return 0.0; }, 0.0);
  CutCells none;
  for (int n = 0; n < 5; ++n) flow.advance(n * 1e-4, 1e-4, none);
  EXPECT_EQ(flow.kinetic_energy(), 0.0);
}

TEST(Incompressible, StateAndResumeGiveTheSameBits) {
  JetBox whole, first, second;
  const auto steps = [](JetBox& b, int n) {
    for (int s = 0; s < n; ++s) {
      b.flow->stable_dt(0.9);
      b.step(8e-6);
    }
  };
  steps(whole, 12);
  steps(first, 6);
  const auto from = first.flow->state(), to = second.flow->state();
  for (std::size_t f = 0; f < from.size(); ++f) *to[f].field = *from[f].field;
  second.bodies = first.bodies;
  second.time = first.time;
  second.flow->resume(second.time);
  steps(second, 6);
  expect_same_bits(*whole.flow, *second.flow);
  EXPECT_EQ(whole.flow->momentum(), second.flow->momentum());
}

/// u = -cos x sin y exp(-2 nu t) in [0, 2 pi]^2.
double taylor_green_error(int n) {
  const double length = 2.0 * std::numbers::pi, nu = 0.01;
  const Grid grid(make_axis({0, length}, {n}, {}), make_axis({0, length}, {n}, {}),
                  make_axis({0, 1}, {1}, {}));
  std::array<Boundary, 6> faces;
  for (Boundary& b : faces) b.kind = BoundaryKind::periodic;
  IncompressibleSetup setup;
  setup.viscosity = nu;
  Incompressible flow(grid, faces, setup);
  flow.initialise(
      [](const Vec3& x) {
        return Vec3(-std::cos(x[0]) * std::sin(x[1]), std::sin(x[0]) * std::cos(x[1]), 0);
      },
      [](const Vec3& x) { return -0.25 * (std::cos(2 * x[0]) + std::cos(2 * x[1])); }, 0);
  CutCells none;
  const int steps = n / 2;
  for (int s = 0; s < steps; ++s) flow.advance(double(s) / steps, 1.0 / steps, none);
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec3 x = grid.centre(i, j, 0);
      const double e = flow.velocity()[0](i, j, 0) + std::cos(x[0]) * std::sin(x[1]) * std::exp(-2 * nu);
      sum += e * e / (double(n) * n);
    }
  return std::sqrt(sum);
}

TEST(Incompressible, TaylorGreenConvergesAtSecondOrderOrBetter) {
  const double coarse = taylor_green_error(16), middle = taylor_green_error(32),
               fine = taylor_green_error(64);
  EXPECT_GT(std::log2(coarse / middle), 1.9);
  EXPECT_GT(std::log2(middle / fine), 1.9);
}

}  // namespace
}  // namespace ejecta
