#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "flow/piso/compressible.hpp"
#include "godunov_case.hpp"

/// The compressible PISO: what it must keep, how sound goes through it, and its order on a vortex carried by
/// a wind.
namespace ejecta {
namespace {

using gas::Compressible;
using gas::GasState;
using test::even_axis;
using test::make_tube;
using Tube = test::TubeOf<Compressible>;

constexpr double kPi = std::numbers::pi;
constexpr double kAmbient = 101325.0, kDensity = 1.184;
const double kSound = std::sqrt(1.4 * kAmbient / kDensity);

gas::Options air(TurbulenceModel model = TurbulenceModel::laminar) {
  gas::Options o;
  o.reference_pressure = kAmbient;
  o.viscosity = model == TurbulenceModel::laminar ? 0.0 : 1.85e-5;
  o.turbulence = model;
  return o;
}

TEST(CompressiblePiso, StillAirOnAGradedAxisymmetricGridStaysStill) {
  for (const auto model :
       {TurbulenceModel::laminar, TurbulenceModel::k_epsilon, TurbulenceModel::k_omega_sst}) {
    Tube t(make_axis({0, 1e-3, 4e-2}, {6, 20}, {1, 20}), even_axis(0, 1, 1), make_axis({0, 0.1}, {30}, {40}),
           true, air(model));
    const GasState still{kDensity, {0, 0, 0}, kAmbient, 1e-4, 1e-2};
    t.boundary(1, BoundaryType::free_stream, still);
    t.boundary(4, BoundaryType::wall);
    t.boundary(5, BoundaryType::wave_transmissive, still);
    t.fill([&](const Vec3&) { return still; });
    for (int n = 0; n < 20; ++n) t.solver.advance(1e-5);
    for (int k = 0; k < t.grid.nz(); ++k)
      for (int i = 0; i < t.grid.nx(); ++i) {
        ASSERT_EQ(t.solver.at(i, 0, k).velocity.norm(), 0.0) << i << " " << k;
        ASSERT_EQ(t.solver.at(i, 0, k).pressure, kAmbient) << i << " " << k;
      }
  }
}

TEST(CompressiblePiso, AUniformWindStaysUniformOnGradedGrids) {
  const GasState wind{kDensity, {30, -20, 50}, kAmbient};
  Tube box(make_axis({0, 1}, {20}, {30}), make_axis({0, 1}, {8}, {0.2}), make_axis({0, 1}, {20}, {0.05}),
           false, air());
  box.all_boundaries(BoundaryType::periodic);
  box.fill([&](const Vec3&) { return wind; });
  for (int n = 0; n < 20; ++n) box.solver.advance(box.solver.stable_dt(0.8));
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 20; ++i)
        ASSERT_LT((box.solver.at(i, j, k).velocity - wind.velocity).norm(), sizeof(Real) == 4 ? 2e-3 : 1e-9);

  // Along the axis of a can, in through one end and out through the other
  const GasState along{kDensity, {0, 0, 50}, kAmbient};
  Tube can(make_axis({0, 1e-2}, {12}, {8}), even_axis(0, 1, 1), make_axis({0, 0.1}, {20}, {10}), true, air());
  can.all_boundaries(BoundaryType::slip);
  can.boundary(4, BoundaryType::velocity, along);
  can.boundary(5, BoundaryType::pressure_outlet, along);
  can.fill([&](const Vec3&) { return along; });
  for (int n = 0; n < 50; ++n) can.solver.advance(can.solver.stable_dt(0.8));
  for (int k = 0; k < 20; ++k)
    for (int i = 0; i < 12; ++i)
      ASSERT_LT((can.solver.at(i, 0, k).velocity - along.velocity).norm(), sizeof(Real) == 4 ? 2e-3 : 1e-9);
}

/// Puff of hot, fast gas in a closed box, Mach 0.5 and below.
std::unique_ptr<Tube> puff(bool axisymmetric, TurbulenceModel model) {
  auto t = std::make_unique<Tube>(even_axis(0, 0.1, 24), even_axis(0, 1, 1), even_axis(0, 0.1, 33),
                                  axisymmetric, air(model));
  t->all_boundaries(BoundaryType::slip);
  t->fill([](const Vec3& x) {
    const double f = std::exp(-(x.x() * x.x() + std::pow(x.z() - 0.03, 2)) / 2e-4);
    return GasState{
        kDensity * (1 - 0.3 * f), {0, 0, 200 * f}, kAmbient * (1 + 0.02 * f), 1e-2 + 100 * f, 1 + 1e5 * f};
  });
  return t;
}

TEST(CompressiblePiso, AClosedBoxKeepsMassAndEnergy) {
  for (const bool axisymmetric : {false, true}) {
    auto t = puff(axisymmetric, TurbulenceModel::laminar);
    const double mass = t->solver.total(gas::kRho), energy = t->solver.total(gas::kP);
    double kinetic = 0.0;  // what the energy is measured against: that of the gas at rest is left out of it
    for (int k = 0; k < t->grid.nz(); ++k)
      for (int i = 0; i < t->grid.nx(); ++i)
        kinetic += 0.5 * t->solver.at(i, 0, k).density * t->solver.at(i, 0, k).velocity.squaredNorm() *
                   t->grid.volume(i, 0, k) * (axisymmetric ? 2.0 * kPi : 1.0);
    t->run(1e-3, 0.8);
    EXPECT_NEAR(t->solver.total(gas::kRho) / mass, 1.0, sizeof(Real) == 4 ? 1e-6 : 1e-13);
    EXPECT_NEAR((t->solver.total(gas::kP) - energy) / kinetic, 0.0, sizeof(Real) == 4 ? 1e-5 : 1e-12);
  }
}

TEST(CompressiblePiso, SameBitsForAnyNumberOfThreads) {
  const int before = thread_count();
  std::vector<std::vector<Real>> energy;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    auto t = puff(true, TurbulenceModel::k_epsilon);
    for (int n = 0; n < 20; ++n) t->solver.advance(t->solver.stable_dt(0.8));
    const Field& f = t->solver.primitive()[gas::kP];
    std::vector<Real>& cells = energy.emplace_back();
    for (int k = 0; k < f.nz(); ++k)
      for (int j = 0; j < f.ny(); ++j) cells.insert(cells.end(), &f(0, j, k), &f(0, j, k) + f.nx());
  }
  set_thread_count(before);
  EXPECT_EQ(energy[0], energy[1]);
  EXPECT_EQ(energy[0], energy[2]);
}

/// A weak pulse of sound that runs to the right for half the tube: where its crest is and how high.
struct Pulse {
  double speed, height;
};
Pulse sound_pulse(double courant) {
  constexpr int kCells = 400;
  auto t = make_tube<Compressible>(2, kCells, air());
  t->all_boundaries(BoundaryType::periodic);
  const double height = 100.0, width = 0.05;
  t->fill([&](const Vec3& x) {
    const double p = height * std::exp(-std::pow((x.z() - 0.25) / width, 2));
    return GasState{kDensity + p / (kSound * kSound), {0, 0, p / (kDensity * kSound)}, kAmbient + p};
  });
  const double end = 0.5 / kSound, dt = courant / (kCells * kSound);
  const int steps = int(std::lround(end / dt));
  for (int n = 0; n < steps; ++n) t->solver.advance(dt);
  double sum = 0.0, first = 0.0, most = 0.0;
  for (int k = 0; k < kCells; ++k) {
    const double p = t->solver.at(0, 0, k).pressure - kAmbient;
    sum += p;
    first += p * t->grid.centre(0, 0, k).z();
    most = std::max(most, p);
  }
  return {(first / sum - 0.25) / (steps * dt) / kSound, most / height};
}

TEST(CompressiblePiso, SoundRunsAtItsSpeedAndIsDamped) {
  const Pulse fine = sound_pulse(0.5), coarse = sound_pulse(5.0);
  EXPECT_NEAR(fine.speed, 1.0, 0.01);
  EXPECT_NEAR(coarse.speed, 1.0, 0.02);
  EXPECT_GT(fine.height, 0.8);
  EXPECT_LT(fine.height, 1.0);
  EXPECT_GT(coarse.height, 0.2);
  EXPECT_LT(coarse.height, fine.height);
}

/// A pulse of sound of half width `width` (to 1/e, cells) that meets the upper end of a tube of 400 cells:
/// its height there, and that of what comes back, both over its first height.
struct Echo {
  double arrives, returns;
};
Echo echo(BoundaryType type, double courant, int width) {
  constexpr int kCells = 400;
  const GasState still{kDensity, {0, 0, 0}, kAmbient};
  const double height = 100.0, h = 1.0 / kCells, dt = courant * h / kSound;
  // What comes back is what the tube holds beyond the same wave in a longer one.
  const auto tube = [&](int cells, BoundaryType end) {
    auto t = std::make_unique<Tube>(even_axis(0, 1, 1), even_axis(0, 1, 1), even_axis(0, cells * h, cells),
                                    false, air());
    t->all_boundaries(BoundaryType::slip);
    t->boundary(5, end, still);
    t->fill([&](const Vec3& x) {
      const double p = height * std::exp(-std::pow((x.z() - (kCells - 4 * width) * h) / (width * h), 2));
      return GasState{kDensity + p / (kSound * kSound), {0, 0, p / (kDensity * kSound)}, kAmbient + p};
    });
    return t;
  };
  const auto open = tube(kCells, type), endless = tube(kCells + 8 * width, BoundaryType::slip);
  const auto pressure = [&](Tube& t, int k) { return t.solver.at(0, 0, k).pressure - kAmbient; };
  Echo e{};
  const int steps = int(4 * width / courant);  // to the end, and the same again
  for (int n = 0; n < 2 * steps; ++n) {
    open->solver.advance(dt);
    endless->solver.advance(dt);
    if (n + 1 == steps)
      for (int k = 0; k < endless->grid.nz(); ++k)
        e.arrives = std::max(e.arrives, pressure(*endless, k) / height);
  }
  for (int k = 0; k < kCells; ++k)
    e.returns = std::max(e.returns, std::abs(pressure(*open, k) - pressure(*endless, k)) / height);
  return e;
}

TEST(CompressiblePiso, ATransmissiveEndReturnsLessThanTwoPercentOfASound) {
  for (const double courant : {0.2, 0.5, 1.0, 2.0, 5.0}) {
    const Echo e = echo(BoundaryType::wave_transmissive, courant, 10);
    EXPECT_LT(e.returns / e.arrives, 0.02) << "Courant number " << courant;
  }
  for (const double courant : {0.5, 5.0}) {
    const Echo e = echo(BoundaryType::wave_transmissive, courant, 20);
    EXPECT_LT(e.returns / e.arrives, 0.02) << "Courant number " << courant;
  }
  for (const auto type : {BoundaryType::wall, BoundaryType::free_stream}) {
    const Echo e = echo(type, 0.5, 20);
    EXPECT_GT(e.returns / e.arrives, 0.8);
  }
}

// A closed tube of compressed air empties through its open end to the pressure outside. In steps that sound
// crosses 50 cells in it takes far longer, but nothing grows.
TEST(CompressiblePiso, ATransmissiveEndHoldsTheFarPressureAtAnyStep) {
  constexpr int kCells = 40;
  const double excess = 1e-3 * kAmbient;
  for (const double courant : {0.5, 5.0, 50.0}) {
    auto t = make_tube<Compressible>(2, kCells, air());
    t->all_boundaries(BoundaryType::slip);
    t->boundary(5, BoundaryType::wave_transmissive, {kDensity, {0, 0, 0}, kAmbient});
    t->fill([&](const Vec3&) {
      return GasState{kDensity + excess / (kSound * kSound), {0, 0, 0}, kAmbient + excess};
    });
    for (int n = 0; n * courant < 50 * kCells; ++n) t->solver.advance(courant / (kCells * kSound));
    for (int k = 0; k < kCells; ++k)
      ASSERT_LT(std::abs(t->solver.at(0, 0, k).pressure - kAmbient), (courant < 10.0 ? 0.1 : 1.0) * excess)
          << k << ", Courant number " << courant;
  }
}

TEST(CompressiblePiso, AnInletTakesAStateForEachCell) {
  Tube t(even_axis(-0.02, 0.02, 20), even_axis(0, 1, 1), even_axis(0, 0.1, 40), false, air());
  const GasState still{kDensity, {0, 0, 0}, kAmbient};
  t.all_boundaries(BoundaryType::slip);
  t.boundary(4, BoundaryType::jet);
  t.boundary(5, BoundaryType::pressure_outlet, still);
  // A shear flow of uneven temperature and even pressure is a steady flow of gas without friction.
  const auto flow = [](const Vec3& x) {
    const double f = std::sin(kPi * x.x() / 0.04);
    return GasState{kDensity * (1 - 0.1 * f), {0, 0, 40 + 20 * f}, kAmbient};
  };
  t.solver.boundaries().set_states(4, flow);
  t.fill(flow);
  t.run(0.01, 0.8);
  for (int k = 0; k < 40; ++k)
    for (int i = 0; i < 20; ++i) {
      const GasState s = t.solver.at(i, 0, k), exact = flow(t.grid.centre(i, 0, k));
      ASSERT_NEAR(s.velocity.z(), exact.velocity.z(), 0.1) << i << " " << k;
      ASSERT_NEAR(s.density / exact.density, 1.0, 0.001) << i << " " << k;
    }
}

/// At the edge of a starting jet omega jumps by orders of magnitude; taken in one cell, the cross-diffusion
/// of SST emptied cells of omega, and their eddies grew to the bound of the eddy viscosity.
TEST(CompressiblePiso, EddiesAtTheEdgeOfAStartingJetStayThoseOfTheJet) {
  gas::Options options = air(TurbulenceModel::k_omega_sst);
  Tube t(even_axis(0, 0.02, 32), even_axis(0, 1, 1), even_axis(0, 0.04, 64), true, options);
  const GasState still{kDensity, {0, 0, 0}, kAmbient, 1e-4, 1.0};
  t.boundary(1, BoundaryType::free_stream, still);
  t.boundary(4, BoundaryType::jet);
  t.boundary(5, BoundaryType::pressure_outlet, still);
  constexpr double width = 4e-3, fastest = 200.0, k = 1500.0, omega = 1e5;
  t.solver.boundaries().set_states(4, [&](const Vec3& x) {
    const double f = std::exp(-std::pow(x.x() / width, 2));
    return GasState{kDensity, {0, 0, fastest * f}, kAmbient, std::max(k * f, 1e-4), std::max(omega * f, 1.0)};
  });
  t.fill([&](const Vec3&) { return still; });
  t.run(2e-3, 0.9);
  double largest = 0.0;
  for (int n = 0; n < t.grid.nz(); ++n)
    for (int i = 0; i < t.grid.nx(); ++i)
      largest = std::max(largest, double(t.solver.eddy_viscosity()(i, 0, n)));
  EXPECT_LT(largest, kDensity * fastest * width) << "Pa s";
}

/// Mean error of the velocity, over the largest of the vortex, after an isentropic vortex (Yee, Sandham &
/// Djomehri 1999) was carried by a wind of Mach number `mach`; its own Mach number is a third of it.
double vortex(int cells, double mach) {
  gas::Options o;
  o.reference_pressure = 1.0;
  Tube t(even_axis(-7, 7, cells), even_axis(0, 1, 1), even_axis(-7, 7, cells), false, o);
  t.all_boundaries(BoundaryType::periodic);
  const double wind = mach * std::sqrt(1.4), strength = wind / 3.0, time = 2.0 / wind;
  const auto state = [&](const Vec3& x, double at) {
    const auto wrapped = [](double q) { return q - 14.0 * std::round(q / 14.0); };
    const double dx = wrapped(x.x() - wind * at), dz = wrapped(x.z() - wind * at), r2 = dx * dx + dz * dz;
    const double f = strength * std::exp(0.5 * (1 - r2));
    const double temperature = 1.0 - 0.2 / 1.4 * f * f;
    const double rho = std::pow(temperature, 2.5);
    return GasState{rho, {wind - dz * f, 0, wind + dx * f}, rho * temperature};
  };
  t.fill([&](const Vec3& x) { return state(x, 0.0); });
  t.run(time, 0.6);
  double sum = 0.0;
  for (int k = 0; k < cells; ++k)
    for (int i = 0; i < cells; ++i)
      sum += (t.solver.at(i, 0, k).velocity - state(t.grid.centre(i, 0, k), time).velocity).norm();
  return sum / (cells * cells) / strength;
}

TEST(CompressiblePiso, AVortexIsCarriedAtSecondOrder) {
  for (const double mach : {0.05, 0.3, 0.6}) {
    // In float on coarser grids, where the limiter still takes a part of the order off the extrema
    const bool in_double = sizeof(Real) == 8;
    const double coarse = vortex(in_double ? 80 : 40, mach), fine = vortex(in_double ? 160 : 80, mach);
    EXPECT_GT(std::log2(coarse / fine), in_double ? 1.8 : 1.5)
        << "Mach " << mach << ": " << coarse << " " << fine;
    EXPECT_LT(fine, 0.01) << "Mach " << mach;
  }
}

}  // namespace
}  // namespace ejecta
