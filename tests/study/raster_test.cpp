#include "study/raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace ejecta {
namespace {

constexpr Raster kSquare{-1.0, -1.0, 0.05, 0.05, 40, 40};

std::vector<double> sampled(const Raster& r, const std::function<double(double, double)>& f) {
  std::vector<double> values;
  for (int n = 0; n < r.nodes(); ++n) values.push_back(f(r.x(n), r.y(n)));
  return values;
}

double enclosed(const std::vector<Polygon>& outlines) {
  double sum = 0.0;
  for (const Polygon& p : outlines) sum += signed_area(p);
  return sum;
}

TEST(Raster, AreaOfAHalfPlaneIsExact) {
  for (const double angle : {0.0, 0.3, 1.0, 2.0}) {
    const auto values =
        sampled(kSquare, [&](double x, double y) { return x * std::cos(angle) + y * std::sin(angle); });
    EXPECT_NEAR(positive_area(kSquare, values), 2.0, 1e-12) << angle;
  }
}

TEST(Raster, AreaOfADiscIsOfSecondOrder) {
  const double area = std::numbers::pi * 0.49;
  double before = 0.0;
  for (const int cells : {20, 40, 80}) {
    const Raster r{-1.0, -1.0, 2.0 / cells, 2.0 / cells, cells, cells};
    const auto values = sampled(r, [](double x, double y) { return 0.7 - std::hypot(x, y); });
    const double error = std::abs(positive_area(r, values) - area);
    EXPECT_LT(error, 3.0 / (cells * cells));
    if (before > 0.0) EXPECT_LT(error, before / 3.0);
    before = error;
  }
}

TEST(Raster, OutlinesEncloseTheAreaAndKeepTheInsideToTheLeft) {
  // A ring beside an island that runs over the side.
  const auto f = [](double x, double y) {
    const double ring = 0.2 - std::abs(std::hypot(x + 0.4, y) - 0.35),
                 island = 0.3 - std::hypot(x - 0.9, y - 0.9);
    return std::max(ring, island);
  };
  const auto values = sampled(kSquare, f);
  const auto outlines = positive_outlines(kSquare, values);
  ASSERT_EQ(outlines.size(), 3U);
  EXPECT_GT(signed_area(outlines[0]), 0.0);
  EXPECT_GT(signed_area(outlines[1]), 0.0);
  EXPECT_LT(signed_area(outlines[2]), 0.0);  // the hole
  EXPECT_NEAR(enclosed(outlines), positive_area(kSquare, values), 1e-12);
  EXPECT_TRUE(is_inside(outlines, {-0.4, 0.35}));
  EXPECT_FALSE(is_inside(outlines, {-0.4, 0.0}));
  EXPECT_FALSE(is_inside(outlines, {0.5, -0.5}));
  EXPECT_TRUE(is_inside(outlines, {0.95, 0.95}));
}

TEST(Raster, EverythingAndNothing) {
  const auto full = sampled(kSquare, [](double, double) { return 1.0; });
  const auto outlines = positive_outlines(kSquare, full);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_NEAR(signed_area(outlines[0]), 4.0, 1e-12);
  EXPECT_NEAR(positive_area(kSquare, full), 4.0, 1e-12);

  const auto empty = sampled(kSquare, [](double, double) { return -1.0; });
  EXPECT_TRUE(positive_outlines(kSquare, empty).empty());
  EXPECT_EQ(positive_area(kSquare, empty), 0.0);
}

TEST(Raster, ExtentEndsAtTheZeros) {
  const auto values =
      sampled(kSquare, [](double x, double y) { return 0.52 - std::abs(x - 0.1) - std::abs(y); });
  const Extent e = positive_extent(kSquare, values);
  EXPECT_NEAR(e.low_x, -0.42, 1e-12);
  EXPECT_NEAR(e.high_x, 0.62, 1e-12);
  EXPECT_NEAR(e.low_y, -0.52, 1e-12);
  EXPECT_NEAR(e.high_y, 0.52, 1e-12);
}

}  // namespace
}  // namespace ejecta
