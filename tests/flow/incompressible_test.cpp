#include "flow/piso/incompressible.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <numbers>

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

/// A jet of air through a graded box with a moving solid in it, k-epsilon.
struct JetBox {
  Grid grid{make_axis({-0.04, -0.01, 0.01, 0.04}, {6, 16, 6}, {0.2, 1, 5}),
            make_axis({-0.04, -0.01, 0.01, 0.04}, {6, 16, 6}, {0.2, 1, 5}),
            make_axis({0.04, 0.12}, {32}, {2})};
  SolidMask solids;
  std::unique_ptr<Incompressible> flow;

  explicit JetBox(bool turbulent = true) {
    std::array<Boundary, 6> faces;
    for (Boundary& b : faces) b.kind = BoundaryKind::open;
    faces[4].kind = BoundaryKind::inflow;
    faces[4].state = [](const Vec3& x, double) {
      BoundaryState s;
      const double u = 100.0 * std::exp(-(x.x() * x.x() + x.y() * x.y()) / (0.005 * 0.005));
      s.velocity[2] = static_cast<Real>(u);
      s.k = static_cast<Real>(0.05 * u * u + 1e-3);
      s.second = static_cast<Real>(0.09 * s.k * s.k / 0.01);
      return s;
    };
    IncompressibleSetup setup;
    if (turbulent) setup.turbulence = TwoEquationModel::k_epsilon;
    flow = std::make_unique<Incompressible>(grid, faces, setup);
    if (turbulent) flow->turbulence()->initialise(1e-3, 0.05);
    flow->initialise([](const Vec3&) { return Vec3::Zero(); }, [](const Vec3&) { return 0.0; }, 0.0);
    for (int k = 12; k < 18; ++k)
      for (int j = 11; j < 17; ++j)
        for (int i = 11; i < 17; ++i) {
          SolidCell c;
          c.i = i, c.j = j, c.k = k;
          c.solid = {Real(3), Real(0), Real(0)};
          solids.cells.push_back(c);
        }
    solids.resize_scratch();
  }
  void run(int steps) {
    double time = 0.0;
    for (int n = 0; n < steps; ++n) {
      const double dt = std::min(flow->stable_dt(0.9), 1e-4);
      flow->advance(time, dt, solids);
      time += dt;
    }
  }
};

TEST(Incompressible, GivesTheSameBitsForAnyNumberOfThreads) {
  const int threads = thread_count();
  JetBox one, two;
  set_thread_count(1);
  one.run(12);
  set_thread_count(2);
  two.run(12);
  set_thread_count(threads);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < one.grid.nz(); ++k)
      for (int j = 0; j < one.grid.ny(); ++j)
        for (int i = 0; i < one.grid.nx(); ++i)
          ASSERT_EQ(one.flow->velocity_field(c)(i, j, k), two.flow->velocity_field(c)(i, j, k));
  EXPECT_EQ(one.solids.impulse, two.solids.impulse);
}

TEST(Incompressible, ConservesMomentumOfAirSolidsAndBoundaries) {
  for (bool turbulent : {false, true}) {
    JetBox box(turbulent);
    const Vec3 start = box.flow->momentum();
    box.run(30);
    const FlowLedger& l = box.flow->ledger();
    const Vec3 lost = box.flow->momentum() - start - l.momentum_through_boundaries + l.impulse_on_solids;
    const double jet = std::abs(l.momentum_through_boundaries.z()) + l.impulse_on_solids.norm();
    EXPECT_LT(lost.norm(), (kSingle ? 1e-4 : 1e-8) * jet);
    EXPECT_GT(l.impulse_on_solids.z(), 0.0);
  }
}

TEST(Incompressible, IsFreeOfDivergenceAfterAStep) {
  JetBox box;
  box.run(10);
  EXPECT_LT(box.flow->largest_divergence(), kSingle ? 1e-5 : 1e-13);
}

TEST(Incompressible, StepsAllocateNothing) {
  JetBox box;
  const int threads = thread_count();
  set_thread_count(1);  // the runtime's own threads may allocate
  box.run(3);
  allocations = 0;
  counting = true;
  box.run(3);
  counting = false;
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
  SolidMask none;
  for (int n = 0; n < 5; ++n) flow.advance(n * 1e-4, 1e-4, none);
  EXPECT_EQ(flow.kinetic_energy(), 0.0);
}

TEST(Incompressible, StateAndResumeGiveTheSameBits) {
  JetBox whole, first, second;
  const auto steps = [](JetBox& b, int n) {
    for (int s = 0; s < n; ++s) {
      b.flow->stable_dt(0.9);
      b.flow->advance(s * 2e-6, 2e-6, b.solids);
    }
  };
  steps(whole, 8);
  steps(first, 4);
  const auto from = first.flow->state(), to = second.flow->state();
  for (std::size_t f = 0; f < from.size(); ++f) *to[f] = *from[f];
  second.flow->resume(0.0);
  steps(second, 4);
  for (int k = 0; k < whole.grid.nz(); ++k)
    for (int j = 0; j < whole.grid.ny(); ++j)
      for (int i = 0; i < whole.grid.nx(); ++i)
        ASSERT_EQ(whole.flow->velocity_field(2)(i, j, k), second.flow->velocity_field(2)(i, j, k));
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
  SolidMask none;
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
