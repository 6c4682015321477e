#include "coupling/unresolved/drag_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

/// Drag laws against their formulas worked out elsewhere, against tables, and in the limits they must have.
namespace ejecta {
namespace {

using Law = double (*)(const drag::Surroundings&);
double alone_law(const drag::Surroundings& s) { return drag::schiller_naumann(s); }

struct Row {
  drag::Surroundings at;
  double di_felice, rong, koch_hill, gidaspow, schiller_naumann, stokes;  // kg/s
};

TEST(DragLaw, IsItsFormula) {
  const std::vector<Row> rows{{{1e-3, 0.01 / 0.451335, 0.451335, 10, 1.5e-4},
                               1.225118673921e-04,
                               1.372765836935e-04,
                               1.719948865777e-04,
                               1.434183085376e-04,
                               1.470711873958e-05,
                               1.413716694115e-05},
                              {{1e-3, 5.0, 0.9, 1.2, 1.5e-5},
                               2.222715241547e-06,
                               2.382233837638e-06,
                               3.021942974295e-06,
                               1.917353943291e-06,
                               1.546388092141e-06,
                               1.696460032938e-07},
                              {{5e-4, 0.3, 0.75, 1.2, 1.5e-5},
                               2.805673885765e-07,
                               3.001415481251e-07,
                               3.724081472162e-07,
                               3.180862561760e-07,
                               1.467107804611e-07,
                               8.482300164692e-08},
                              {{2e-3, 40, 0.55, 1.2, 1.5e-5},
                               1.017144871528e-04,
                               1.256837652373e-04,
                               9.665896280133e-05,
                               1.782425431914e-04,
                               3.317521842191e-05,
                               3.392920065877e-07}};
  for (const Row& r : rows) {
    const double is[] = {drag::di_felice(r.at), drag::rong(r.at), drag::koch_hill(r.at),
                         drag::gidaspow(r.at),  alone_law(r.at),  drag::stokes(r.at)};
    const double right[] = {r.di_felice, r.rong, r.koch_hill, r.gidaspow, r.schiller_naumann, r.stokes};
    for (int n = 0; n < 6; ++n) EXPECT_NEAR(is[n] / right[n], 1.0, 1e-9) << n << " at Re " << r.at.reynolds();
  }
}

/// dp = L n f_d / e of a bed, Pa; velocities superficial.
double bed_drop(Law law, double velocity) {
  const double d = 1e-3, e = 0.451335, length = 15.6e-3;
  const double slip = velocity / e, grains = (1 - e) / (std::numbers::pi / 6 * d * d * d);
  return length * grains * law({d, slip, e, 10, 1.5e-4}) * slip / e;
}

TEST(DragLaw, GivesTheDropOfAFixedBed) {
  const double velocity[] = {2e-3, 5e-3, 10e-3, 15e-3, 20e-3};
  const double di_felice[] = {19.20, 48.62, 98.31, 148.41, 198.72};
  const double ergun[] = {22.99, 57.50, 115.09, 172.76, 230.51};
  for (int n = 0; n < 5; ++n) {
    EXPECT_NEAR(bed_drop(drag::di_felice, velocity[n]), di_felice[n], 0.006);
    EXPECT_NEAR(bed_drop(drag::gidaspow, velocity[n]), ergun[n], 0.006);
  }
}

/// Slip at which a grain hangs in the fluid: e V_p (rho_p - rho) g = f_d (model A), by bisection.
double hanging_slip(Law law, drag::Surroundings s, double grain_density) {
  const double weight = s.fraction * s.volume() * (grain_density - s.density) * 9.81;
  double low = 0, high = 100;
  for (int n = 0; n < 200; ++n) {
    s.slip = 0.5 * (low + high);
    (law(s) * s.slip < weight ? low : high) = s.slip;
  }
  return s.slip;
}

TEST(DragLaw, GivesTerminalVelocities) {
  EXPECT_NEAR(hanging_slip(drag::di_felice, {1e-4, 0, 1, 10, 1e-5}, 3000), 0.128610, 1e-6);
  EXPECT_NEAR(hanging_slip(alone_law, {1e-4, 0, 1, 10, 1e-5}, 3000), 0.137337, 1e-6);
  EXPECT_NEAR(hanging_slip(drag::di_felice, {1e-3, 0, 1, 1.2, 1.5e-5}, 2650), 6.2046, 1e-4);
  EXPECT_NEAR(hanging_slip(drag::di_felice, {2e-3, 0, 1, 1.2, 1.5e-5}, 2650), 9.9776, 1e-4);
}

/// U/u_t = e^(chi + 1) in Stokes flow; model B's drag in model A's balance would show as e^(chi + 2).
TEST(DragLaw, HindersSettlingByItsExponent) {
  const drag::Surroundings alone{1e-6, 0, 1, 1000, 1e-5};
  const double terminal = hanging_slip(drag::di_felice, alone, 2650);
  const double fraction[] = {0.9, 0.8, 0.7, 0.6}, right[] = {0.6123, 0.3534, 0.1893, 0.0920};
  // The 0.63 sqrt(Re) left in C_D at Re 1e-8 is 1e-5 of it; chi is 3.7 to 1e-10.
  for (int n = 0; n < 4; ++n) {
    drag::Surroundings s = alone;
    s.fraction = fraction[n];
    const double superficial = fraction[n] * hanging_slip(drag::di_felice, s, 2650);
    EXPECT_NEAR(superficial / terminal, std::pow(fraction[n], 4.7), 2e-4);
    // The table's grain is not quite that slow: its exponents are 4.66 to 4.67.
    EXPECT_NEAR(std::log(superficial / terminal) / std::log(fraction[n]),
                std::log(right[n]) / std::log(fraction[n]), 0.05);
  }
}

TEST(DragLaw, IsFiniteAtRestAndOneGrainAloneWhereThereAreNone) {
  const drag::Surroundings rest{1e-4, 0, 0.6, 1.2, 1.5e-5}, few{1e-4, 1e-4, 1, 1.2, 1.5e-5};
  for (const Law law : {Law(drag::di_felice), Law(drag::rong), Law(drag::koch_hill), Law(drag::gidaspow)}) {
    EXPECT_TRUE(std::isfinite(law(rest)));
    EXPECT_GT(law(rest), 0.0);
  }
  // Koch & Hill and Wen & Yu become Stokes' law; Di Felice's C_D has 23.04/Re, 4 % less.
  EXPECT_NEAR(drag::koch_hill(few) / drag::stokes(few), 1.0, 1e-3);
  EXPECT_NEAR(drag::gidaspow(few) / drag::stokes(few), 1.0, 2e-2);
  EXPECT_NEAR(drag::di_felice(few) / drag::stokes(few), 0.96, 1e-2);
}

}  // namespace
}  // namespace ejecta
