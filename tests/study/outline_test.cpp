#include "study/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "study/random_margins.hpp"

namespace ejecta {
namespace {

constexpr Window kWindow{-0.06, 0.06, -0.03, 0.03};

MapSettings half_plane() {
  MapSettings s;
  s.window = kWindow;
  s.symmetric = true;
  s.area_error = 0.0;  // all runs, so that kinds can be compared
  return s;
}

OutlineFinder mapped(const MapSettings& settings, const Margin& fine, const Margin& coarse = {},
                     int side_by_side = 3) {
  OutlineFinder finder(settings);
  while (true) {
    const auto places = finder.ask(side_by_side);
    if (places.empty()) return finder;
    for (const Proposal& p : places) {
      const Margin& margin = p.fidelity == Fidelity::fine ? fine : coarse;
      finder.tell({p.at, margin(p.at.x, p.at.y), p.fidelity});
    }
  }
}

double egg(double x, double y) {
  const double u = x + 0.005, length = u > 0.0 ? 0.032 : 0.020, width = 0.014 * std::sqrt(1.0 + 4.0 * u);
  return 0.02 * (1.0 - std::hypot(u / length, y / width));
}
/// Flat sides that meet in corners, a floor where no air comes, half the slope high above the plate.
double kinked(double x, double y) {
  const double u = x + 0.005, v = std::abs(y);
  const double m =
      std::min({0.9 * (0.030 - u), 1.3 * (u + 0.022), 1.5 * (0.015 - v), 0.7 * (0.045 - u - 2.0 * v)});
  return std::clamp(m > 0.006 ? 0.006 + 0.4 * (m - 0.006) : m, -0.012, 0.014);
}
double noise(double x, double y) {
  return 1e-3 * CounterRandom(11, 0).normal(
                    static_cast<std::uint64_t>(std::llround(x * 1e6) * 1000003 + std::llround(y * 1e6)));
}
double ripple(double x, double y) { return 1e-3 * std::sin(700.0 * x) * std::cos(800.0 * y); }
double ellipse(double x, double y, double x0, double a, double b) {
  return 1.0 - std::hypot((x - x0) / a, y / b);
}

struct Kind {
  std::string name;
  Margin margin;
  double truth;  // of the undisturbed margin, m2; 0: counted
};

std::vector<Kind> kinds() {
  return {
      {"smooth", egg, 0.0},
      {"kinked and saturated", kinked, 0.0},
      {"noise of 1 mm", [](double x, double y) { return 2.0 * kinked(x, y) + noise(x, y); },
       counted_area(kinked, kWindow)},
      {"ripples of 1 mm", [](double x, double y) { return 2.0 * egg(x, y) + ripple(x, y); }, 0.0},
      {"everything",
       [](double x, double y) { return 0.012 + 0.003 * std::cos(30.0 * x) * std::cos(50.0 * y); }, 0.0072},
      {"two islands",
       [](double x, double y) {
         return 0.015 * std::max(ellipse(x, y, -0.03, 0.016, 0.012), ellipse(x, y, 0.025, 0.02, 0.016));
       },
       0.0},
      {"a hole",
       [](double x, double y) {
         return 0.015 * std::min(ellipse(x, y, 0.0, 0.04, 0.022), -ellipse(x, y, 0.005, 0.014, 0.009));
       },
       0.0},
  };
}

/// A run is asked for once, however little the margins around it say of its own: it would only give the same.
TEST(Outline, AsksForNoRunTwice) {
  const Margin wild = [](double x, double y) { return 8.0 * noise(x, y); };
  for (const bool two : {false, true}) {
    MapSettings s = half_plane();
    s.window = {-0.015, 0.010, -0.009, 0.009};
    s.coarse_cost = two ? 0.1 : 0.0;
    s.max_runs = 60;
    OutlineFinder finder(s);
    std::set<std::tuple<double, double, Fidelity>> asked;
    for (auto places = finder.ask(4); !places.empty(); places = finder.ask(4))
      for (const Proposal& p : places) {
        EXPECT_TRUE(asked.insert({p.at.x, p.at.y, p.fidelity}).second) << p.at.x << " " << p.at.y;
        finder.tell({p.at, wild(p.at.x, p.at.y + (p.fidelity == Fidelity::fine ? 0.0 : 1.0)), p.fidelity});
      }
    EXPECT_GE(asked.size(), 40u);
  }
}

/// 1 mm of noise on a margin of slope 1 moves the edge by 1 mm, and 35 runs then leave 2 to 3.5 % of this
/// area; the disturbed kinds have slopes of about 2. Noise still misses 2 % (docs/theory/maps.md): it is held
/// to 4 %.
TEST(Outline, AreaOfEveryKindWithinTwoPercentIn35Runs) {
  for (const Kind& kind : kinds()) {
    const Outline o = mapped(half_plane(), kind.margin).outline();
    const double truth = kind.truth > 0.0 ? kind.truth : counted_area(kind.margin, kWindow);
    EXPECT_NEAR(o.area.value, truth, (kind.name == "noise of 1 mm" ? 0.04 : 0.02) * truth) << kind.name;
    EXPECT_NEAR(o.area.value, truth, o.area.error + 1e-9 * truth) << kind.name;
    RecordProperty(kind.name, std::to_string(100.0 * (o.area.value / truth - 1.0)) + " % off, stated " +
                                  std::to_string(100.0 * o.area.error / truth) + " %");
  }
}

TEST(Outline, NothingIsFoundWhereNothingIs) {
  const Margin still = [](double, double) { return -0.015; };
  const Margin uneven = [](double x, double y) {
    return -0.012 - 0.003 * std::cos(30.0 * x) * std::cos(50.0 * y);
  };
  for (const Margin& margin : {still, uneven}) {
    const Outline o = mapped(half_plane(), margin).outline();
    EXPECT_EQ(o.area.value, 0.0);
    EXPECT_LT(o.area.error, 1e-6);
    EXPECT_TRUE(o.outline.empty());
    EXPECT_TRUE(o.possible.empty());
    EXPECT_EQ(o.half_width.value, 0.0);
  }
}

TEST(Outline, IslandsAndHolesAreOutlinesOfTheirOwn) {
  const auto all = kinds();
  const Outline islands = mapped(half_plane(), all[5].margin).outline();
  ASSERT_EQ(islands.outline.size(), 2U);
  EXPECT_GT(signed_area(islands.outline[1]), 0.0);
  const Outline hole = mapped(half_plane(), all[6].margin).outline();
  ASSERT_EQ(hole.outline.size(), 2U);
  EXPECT_LT(signed_area(hole.outline[1]), 0.0);
}

TEST(Outline, LengthsWithinTheirErrors) {
  const Outline o = mapped(half_plane(), egg).outline();
  EXPECT_NEAR(o.length_behind.value, 0.027, o.length_behind.error + 2e-4);
  EXPECT_NEAR(o.length_before.value, 0.025, o.length_before.error + 2e-4);
  double width = 0.0;
  for (double y = 0.010; y < 0.02; y += 1e-5)
    for (double x = -0.01; x < 0.01; x += 1e-4)
      if (egg(x, y) > 0.0) width = y;
  EXPECT_NEAR(o.half_width.value, width, o.half_width.error + 2e-4);
  EXPECT_LT(o.half_width.error, 1e-3);
}

TEST(Outline, AWholePlaneWithoutSymmetry) {
  MapSettings s = half_plane();
  s.symmetric = false;
  s.max_runs = 50;
  const Margin leaning = [](double x, double y) { return egg(x, y - 0.2 * x); };
  const Outline o = mapped(s, leaning).outline();
  const double truth = counted_area(leaning, kWindow);
  EXPECT_NEAR(o.area.value, truth, 0.02 * truth);
  EXPECT_NEAR(o.area.value, truth, o.area.error);
}

TEST(Outline, TheOrderOfRunsAndThreadsLeaveNoTrace) {
  std::vector<MapRun> runs;
  OutlineFinder first(half_plane());
  for (int n = 0; n < 6; ++n)
    for (const Proposal& p : first.ask(3)) {
      runs.push_back({p.at, egg(p.at.x, p.at.y), p.fidelity});
      first.tell(runs.back());
    }
  OutlineFinder second(half_plane());
  std::reverse(runs.begin(), runs.end());
  for (const MapRun& r : runs) second.tell(r);

  const int threads = thread_count();
  set_thread_count(1);
  const Outline a = first.outline();
  const auto next = first.ask(3);
  set_thread_count(3);
  const Outline b = second.outline();
  const auto again = second.ask(3);
  set_thread_count(threads);
  EXPECT_EQ(a.area.value, b.area.value);
  EXPECT_EQ(a.area.error, b.area.error);
  EXPECT_EQ(a.half_width.value, b.half_width.value);
  ASSERT_EQ(next.size(), again.size());
  for (std::size_t n = 0; n < next.size(); ++n) {
    EXPECT_EQ(next[n].at.x, again[n].at.x);
    EXPECT_EQ(next[n].at.y, again[n].at.y);
  }
}

/// Bodies of a class: margins at one place differ by a normal deviation of 3 mm, whichever fidelity; the
/// chance of ejection is then a function, and its integral is known.
TEST(Outline, OfAClassTheAreaIsTheIntegralOfTheChance) {
  MapSettings s = half_plane();
  s.of_class = true;
  s.max_runs = 60;
  const double deviation = 3e-3;
  double truth = 0.0;
  const double step = 2.5e-4;
  for (double x = kWindow.x_low + 0.5 * step; x < kWindow.x_high; x += step)
    for (double y = 0.5 * step; y < kWindow.y_high; y += step)
      truth += 2.0 * step * step * 0.5 * std::erfc(-egg(x, y) / deviation / std::numbers::sqrt2);
  const double of_usual_body = counted_area(egg, kWindow);
  EXPECT_GT(std::abs(truth / of_usual_body - 1.0), 0.01);  // else nothing is tested
  double square = 0.0;
  int covered = 0;
  constexpr int kSeeds = 6;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Margin member = [&](double x, double y) {
      const auto number = static_cast<std::uint64_t>(std::llround(x * 1e6) * 1000003 + std::llround(y * 1e6));
      return egg(x, y) + deviation * CounterRandom(static_cast<std::uint64_t>(seed), 5).normal(number);
    };
    const OutlineFinder finder = mapped(s, member, {}, 6);
    const Outline o = finder.outline();
    square += std::pow(o.area.value / truth - 1.0, 2);
    covered += std::abs(o.area.value - truth) < o.area.error;
    const Point2 middle{-0.005, 0.0}, far{0.055, 0.028};
    const auto chance = finder.chances(std::array{middle, far});
    EXPECT_GT(chance[0], 0.95);
    EXPECT_LT(chance[1], 0.05);
  }
  // A run of slope 0.7 to 1.4 tells the edge within 3 mm, the 48 after the first within 0.4 mm: some 6 %.
  EXPECT_LT(std::sqrt(square / kSeeds), 0.08);
  EXPECT_GE(covered, kSeeds - 1);
}

TEST(Outline, AnErrorOfArrivalSmoothesTheChanceAndKeepsItsIntegral) {
  const OutlineFinder finder = mapped(half_plane(), egg);
  const RasterValues sharp = *finder.chance_map({0.0, 0.0}), smooth = *finder.chance_map({4e-3, 2e-3});
  ASSERT_EQ(sharp.values.size(), smooth.values.size());
  const auto sum = [](const RasterValues& v) {
    return std::accumulate(v.values.begin(), v.values.end(), 0.0);
  };
  EXPECT_NEAR(sum(smooth), sum(sharp), 0.01 * sum(sharp));
  const auto unsure = [](const RasterValues& v) {
    return std::count_if(v.values.begin(), v.values.end(), [](double p) { return p > 0.1 && p < 0.9; });
  };
  EXPECT_GT(unsure(smooth), 2 * unsure(sharp));
  // Even in y, over the whole window.
  const Raster& r = smooth.raster;
  EXPECT_NEAR(r.y0, kWindow.y_low, 1e-9);
  for (int i = 0; i <= r.cells_x; ++i)
    EXPECT_EQ(smooth.values[static_cast<std::size_t>(r.node(i, 0))],
              smooth.values[static_cast<std::size_t>(r.node(i, r.cells_y))]);
}

TEST(Outline, RunsSideBySideAreNotTheSameRun) {
  OutlineFinder finder(half_plane());
  for (const Proposal& p : finder.ask(12)) finder.tell({p.at, egg(p.at.x, p.at.y), p.fidelity});
  const auto a = finder.ask(3), b = finder.ask(3);
  for (const Proposal& p : a)
    for (const Proposal& q : b) EXPECT_GT(std::hypot(p.at.x - q.at.x, p.at.y - q.at.y), 1e-3);
  EXPECT_EQ(finder.ask(100).size(), 17U);  // what is left of 35
  EXPECT_TRUE(finder.ask(1).empty());
}

TEST(Outline, ACoarseMarginFindsTheShapeAndFineRunsCorrectIt) {
  MapSettings s = half_plane();
  s.coarse_cost = 0.1;
  s.max_runs = 40;
  // The coarse jet reaches less far and is blind to a corner of the outline.
  const Margin coarse = [](double x, double y) {
    return 0.85 * egg(x - 0.003, 1.1 * y) - 0.001 + 0.3 * ripple(x, y);
  };
  const auto finder = mapped(s, egg, coarse);
  const Outline o = finder.outline();
  const double truth = counted_area(egg, kWindow), of_coarse = counted_area(coarse, kWindow);
  EXPECT_LT(of_coarse, 0.85 * truth);
  EXPECT_NEAR(o.area.value, truth, 0.02 * truth);
  EXPECT_NEAR(o.area.value, truth, o.area.error);
}

TEST(Outline, AVerdictAgainstAllOthersIsReported) {
  auto finder = mapped(half_plane(), egg);
  EXPECT_TRUE(finder.contradictions().empty());
  finder.tell({{-0.005, 0.003}, -0.01, Fidelity::fine});
  const auto found = finder.contradictions();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].run.at.y, 0.003);
}

TEST(Outline, ChancesAreYesAndNoAwayFromTheOutline) {
  const auto finder = mapped(half_plane(), egg);
  const std::vector<Point2> places{{0.0, 0.0}, {0.0, 0.025}, {0.01, -0.005}, {-0.05, 0.0}};
  const auto chance = finder.chances(places);
  EXPECT_GT(chance[0], 0.999);
  EXPECT_LT(chance[1], 0.001);
  EXPECT_GT(chance[2], 0.999);
  EXPECT_LT(chance[3], 0.001);
}

TEST(Outline, RefusesWhatIsNoMap) {
  MapSettings s = half_plane();
  s.window.x_high = s.window.x_low;
  EXPECT_THROW(OutlineFinder{s}, InputError);
  s = half_plane();
  s.max_runs = 3;
  EXPECT_THROW(OutlineFinder{s}, InputError);
  OutlineFinder finder(half_plane());
  EXPECT_THROW(finder.outline(), InputError);
  EXPECT_THROW(finder.tell({{0.0, 0.0}, std::nan(""), Fidelity::fine}), DivergedError);
}

/// The stated error of the area covers the truth in at least 90 of 100 random margins (EJECTA_MARGINS=100;
/// fewer by default, of which one more may fail by chance).
TEST(OutlineCoverage, OfRandomMargins) {
  const char* asked = std::getenv("EJECTA_MARGINS");
  const int count = asked ? std::atoi(asked) : 12;
  int covered = 0, within = 0;
  for (int n = 0; n < count; ++n) {
    const Margin margin = random_margin(n);
    const Outline o = mapped(half_plane(), margin, {}, 4).outline();
    const double truth = counted_area(margin, kWindow, 300);
    covered += std::abs(o.area.value - truth) <= o.area.error;
    within += std::abs(o.area.value - truth) <= 0.02 * truth;
  }
  RecordProperty("covered", covered);
  RecordProperty("within_2_percent", within);
  EXPECT_GE(covered, static_cast<int>(0.9 * count) - (count < 100 ? 1 : 0));
}

}  // namespace
}  // namespace ejecta
