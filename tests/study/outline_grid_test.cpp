#include "study/outline_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "study/random_margins.hpp"

namespace ejecta {
namespace {

constexpr Window kGridWindow{-0.06, 0.06, -0.03, 0.03};

MapSettings on_grid(double step_x, double step_y, bool symmetric = true) {
  MapSettings s;
  s.window = kGridWindow;
  s.symmetric = symmetric;
  s.step_x = step_x;
  s.step_y = step_y;
  return s;
}

OutlineGrid mapped_on_grid(const MapSettings& settings, const Margin& margin) {
  OutlineGrid grid(settings);
  for (auto places = grid.ask(7); !places.empty(); places = grid.ask(7))
    for (const Proposal& p : places) grid.tell({p.at, margin(p.at.x, p.at.y), p.fidelity});
  return grid;
}

/// 0.02 (1 - r^2): half axes of 30 and 15 mm about (-5 mm, 0).
double bowl(double x, double y) {
  return 0.02 * (1.0 - std::pow((x + 0.005) / 0.030, 2) - std::pow(y / 0.015, 2));
}
constexpr double kBowl = std::numbers::pi * 0.030 * 0.015;

TEST(OutlineGrid, AreaOfASmoothMarginIsOfSecondOrderAndWithinItsError) {
  double last = 0.0;
  for (const double step : {8e-3, 4e-3, 2e-3}) {
    const Outline o = mapped_on_grid(on_grid(step, 0.5 * step), bowl).outline();
    const double error = std::abs(o.area.value - kBowl);
    EXPECT_LE(error, o.area.error);
    if (last > 0.0) {
      EXPECT_GT(last / error, 3.0) << step;
    }
    last = error;
    EXPECT_NEAR(o.half_width.value, 0.015, o.half_width.error + 1e-4);
    EXPECT_NEAR(o.length_before.value, 0.035, o.length_before.error + 1e-4);
    EXPECT_NEAR(o.length_behind.value, 0.025, o.length_behind.error + 1e-4);
  }
  EXPECT_LT(last, 0.01 * kBowl);
}

TEST(OutlineGrid, HalfAndWholePlaneAgree) {
  const Outline half = mapped_on_grid(on_grid(4e-3, 3e-3), bowl).outline(),
                whole = mapped_on_grid(on_grid(4e-3, 3e-3, false), bowl).outline();
  EXPECT_NEAR(half.area.value, whole.area.value, 1e-12);
  EXPECT_NEAR(half.area.error, whole.area.error, 1e-12);
  EXPECT_EQ(half.outline.size(), whole.outline.size());
}

/// Margins that jump at the boundary, where a smooth process is led astray: within a third of a step all
/// round.
TEST(OutlineGrid, AMarginThatJumpsIsNoWorseThanItsSteps) {
  const auto jump = [](double x, double y) { return bowl(x, y) > 0.0 ? 0.03 : -0.005; };
  const Outline o = mapped_on_grid(on_grid(3e-3, 2e-3), jump).outline();
  EXPECT_NEAR(o.area.value, kBowl, 0.1 * kBowl);
  EXPECT_GT(o.area.error, 0.0);
}

TEST(OutlineGrid, TheStatedErrorCoversRandomMargins) {
  int covered = 0;
  for (int n = 0; n < 100; ++n) {
    const Margin margin = random_margin(n);
    const Outline o = mapped_on_grid(on_grid(6e-3, 3e-3), margin).outline();
    covered += std::abs(o.area.value - counted_area(margin, kGridWindow, 200)) <= o.area.error;
  }
  EXPECT_GE(covered, 90);
}

TEST(OutlineGrid, NothingWhereNothingIsAndAllWhereEverythingIs) {
  const auto none = mapped_on_grid(on_grid(6e-3, 3e-3), [](double, double) { return -0.01; }).outline();
  EXPECT_EQ(none.area.value, 0.0);
  EXPECT_TRUE(none.outline.empty());
  const auto all = mapped_on_grid(on_grid(6e-3, 3e-3), [](double, double) { return 0.01; }).outline();
  EXPECT_NEAR(all.area.value, kGridWindow.width() * kGridWindow.depth(), 1e-9);
  EXPECT_TRUE(all.reaches_sides);
  EXPECT_FALSE(none.reaches_sides);
}

TEST(OutlineGrid, AFailedRunTakesTheMarginOfItsNeighbour) {
  OutlineGrid grid(on_grid(3e-3, 2e-3));
  for (const Proposal& p : grid.ask(grid.places()))
    if (std::hypot(p.at.x + 0.006, p.at.y) > 1e-6) grid.tell({p.at, bowl(p.at.x, p.at.y), p.fidelity});
  EXPECT_NEAR(grid.outline().area.value, kBowl, 0.03 * kBowl);
}

TEST(OutlineGrid, RefusesWhatIsNoGrid) {
  EXPECT_THROW(OutlineGrid(on_grid(0.07, 0.003)), InputError);
  OutlineGrid grid(on_grid(3e-3, 2e-3));
  EXPECT_THROW(grid.outline(), InputError);
  EXPECT_THROW(grid.tell({{1e-3, 0.0}, 1.0, Fidelity::fine}), InputError);
  EXPECT_THROW(grid.tell({{0.0, 0.0}, NAN, Fidelity::fine}), DivergedError);
}

}  // namespace
}  // namespace ejecta
