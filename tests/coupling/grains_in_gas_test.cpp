#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/unresolved/unresolved.hpp"
#include "flow/piso/compressible.hpp"

/// Grains smaller than a cell in compressible flow: what both give each other closes.
namespace ejecta {
namespace {

constexpr double kRest = 101325.0, kAir = 1.2, kEdge = 0.012;
constexpr double kClosed = sizeof(Real) == 4 ? 2e-5 : 1e-11;

/// Gas and free grains in a periodic box, without contacts and gravity.
struct DustyGas {
  Grid grid;
  gas::Compressible flow;
  UnresolvedCoupling coupling;
  FluidFraction f;
  std::vector<Body> grains;
  std::vector<Load> loads;

  static gas::Options options() {
    gas::Options o;
    o.reference_pressure = kRest;
    o.viscosity = 1.8e-5;
    return o;
  }
  static UnresolvedSetup setup(void (*drag)(const drag::Step&, drag::Batch&)) {
    UnresolvedSetup s;
    s.fluid_density = kAir;
    s.viscosity = 1.5e-5;
    s.works = true;
    for (auto& axis : s.beyond) axis = {Beyond::periodic, Beyond::periodic};
    s.drag = drag;
    return s;
  }
  DustyGas(int cells, int count, double diameter, void (*drag)(const drag::Step&, drag::Batch&))
      : grid(make_axis({0, kEdge}, {cells}, {}), make_axis({0, kEdge}, {cells}, {}),
             make_axis({0, kEdge}, {cells}, {})),
        flow(grid, options()),
        coupling(grid, setup(drag)),
        f(grid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(0.0, kEdge);
    for (int n = 0; n < count; ++n) {
      Body b{.name = "grain", .shape = make_sphere(diameter), .enters_at = {}};
      b.mass = 2650.0 * b.shape.mass_properties().volume;
      b.position = {any(random), any(random), any(random)};
      b.motion = Motion::free;
      grains.push_back(b);
    }
    loads.resize(grains.size());
    for (int face = 0; face < 6; ++face) {
      gas::Condition c;
      c.type = BoundaryType::periodic;
      flow.boundaries().set_face(face, c);
    }
    flow.expect_grains(kAir);
    flow.keep_ledger();
  }
  void fill(const Vec3& velocity) {
    for (int k = 0; k < grid.nz(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i) flow.set(i, j, k, {kAir, velocity, kRest});
  }
  void advance(double dt) {
    CutCells none;
    const auto& w = flow.primitive();
    coupling.map(grains, std::vector<char>(grains.size(), 1),
                 {.velocity = {w[gas::kU].view(), w[gas::kV].view(), w[gas::kW].view()},
                  .density = w[gas::kRho].view()},
                 none, dt, f);
    flow.advance(dt, none, f);
    coupling.collect(grains, std::vector<char>(grains.size(), 1), f, loads);
    for (std::size_t n = 0; n < grains.size(); ++n) {
      Body& b = grains[n];
      const Vec3 before = b.velocity;
      b.velocity += dt / b.mass * loads[n].force;
      b.position += 0.5 * dt * (before + b.velocity);
      for (int d = 0; d < 3; ++d) b.position[d] -= kEdge * std::floor(b.position[d] / kEdge);
    }
  }
  Vec3 momentum_of_grains() const {
    Vec3 sum(0, 0, 0);
    for (const Body& b : grains) sum += b.mass * b.velocity;
    return sum;
  }
  double energy_of_grains() const {
    double sum = 0;
    for (const Body& b : grains) sum += 0.5 * b.mass * b.velocity.squaredNorm();
    return sum;
  }
};

/// U2 8 in gas: both come to one velocity, however long the step; momentum to round-off. What is lost of the
/// motion warms the gas.
TEST(GrainsInGas, ComeToOneVelocityWithTheGas) {
  const drag::Law& stokes = drag::kLaws[1];
  for (const double dt : {1e-4, 2.4}) {
    DustyGas s(4, 12 * 12 * 12, 0.26e-3, stokes.find);
    for (int n = 0; n < 12 * 12 * 12; ++n)  // evenly, so that only drag moves the gas
      s.grains[static_cast<std::size_t>(n)].position =
          kEdge / 12 * Vec3(n % 12 + 0.5, n / 12 % 12 + 0.5, n / 144 + 0.5);
    s.fill({10, 0, 0});
    const double volume = std::pow(kEdge, 3);
    double solids = 0;
    for (const Body& b : s.grains) solids += b.shape.mass_properties().volume / volume;
    for (int n = 0; n < (dt < 0.01 ? 20 : 2); ++n) s.advance(dt);
    const gas::Contents there = s.flow.contents();
    const Vec3 momentum = there.momentum + s.momentum_of_grains();
    EXPECT_NEAR(momentum.x() / (kAir * volume * (1 - solids) * 10), 1.0, kClosed) << dt;
    const double mixed = kAir * (1 - solids) * 10 / (kAir * (1 - solids) + 2650 * solids);
    if (dt > 0.01) {
      EXPECT_NEAR(s.momentum_of_grains().x() / (2650 * solids * volume) / mixed, 1.0, 0.005);
    }
    // energy: of the gas, of the grains, and of what drag of the last step has yet to take
    double owed = 0;
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) owed += double(s.f.work(i, j, k)) * s.grid.volume(i, j, k);
    const double start = 0.5 * kAir * (1 - solids) * volume * 100;
    EXPECT_NEAR((there.energy - owed + s.energy_of_grains()) / start, 1.0, 0.01) << dt;
  }
}

/// The ledger of the gas knows what grains took: mass, momentum and energy close with it.
TEST(GrainsInGas, LedgerOfTheGasCloses) {
  DustyGas s(8, 400, 0.4e-3, drag::kLaws[3].find);
  s.fill({40, 5, 0});
  s.advance(1e-5);  // the gas makes room
  const gas::Contents before = s.flow.contents();
  const Vec3 given = s.flow.ledger().momentum_of_solids, grains = s.momentum_of_grains();
  const double worked = s.flow.ledger().work_of_solids;
  for (int n = 0; n < 50; ++n) s.advance(1e-5);
  const gas::Contents change = s.flow.contents() - before;
  const double size = before.mass * 40;
  EXPECT_NEAR(change.mass / before.mass, 0.0, kClosed);
  EXPECT_LT((change.momentum - (s.flow.ledger().momentum_of_solids - given)).norm() / size, kClosed);
  EXPECT_LT((change.momentum + s.momentum_of_grains() - grains).norm() / size, kClosed);
  EXPECT_NEAR((change.energy - (s.flow.ledger().work_of_solids - worked)) / (0.5 * size * 40), 0.0,
              10 * kClosed);
}

TEST(GrainsInGas, AnyNumberOfThreadsGivesTheSameBits) {
  const int before = thread_count();
  std::vector<Vec3> last;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    DustyGas s(8, 300, 0.4e-3, drag::kLaws[3].find);
    s.fill({40, 5, 0});
    for (int n = 0; n < 10; ++n) s.advance(1e-5);
    last.push_back(s.momentum_of_grains());
  }
  set_thread_count(before);
  EXPECT_EQ(last[0], last[1]);
  EXPECT_EQ(last[0], last[2]);
}

/// Drag goes with the density of the gas where a grain is, not with that at rest.
TEST(GrainsInGas, FeelTheDensityAroundThem) {
  double force[2];
  for (const int twice : {0, 1}) {
    DustyGas s(4, 1, 0.4e-3, drag::kLaws[3].find);
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) s.flow.set(i, j, k, {twice ? 2 * kAir : kAir, {200, 0, 0}, kRest});
    s.advance(1e-7);
    force[twice] = s.coupling.drag_forces()[0].norm();
  }
  EXPECT_GT(force[1] / force[0], 1.7);  // 2 but for Reynolds' number
  EXPECT_LT(force[1] / force[0], 2.0);
}

}  // namespace
}  // namespace ejecta
