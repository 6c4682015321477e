#include <gtest/gtest.h>

#include "base/error.hpp"
#include "grid/grid.hpp"

namespace ejecta {
namespace {

TEST(Axis, GradesGeometricallyFromFirstToLastCell) {
  const Axis a = make_axis({0.0, 1.0, 3.0}, {4, 8}, {2.0, 0.25});
  ASSERT_EQ(a.n, 12);
  EXPECT_DOUBLE_EQ(a.face[0], 0.0);
  EXPECT_DOUBLE_EQ(a.face[4], 1.0);
  EXPECT_DOUBLE_EQ(a.face[12], 3.0);
  EXPECT_NEAR(a.width[3] / a.width[0], 2.0, 1e-12);
  EXPECT_NEAR(a.width[11] / a.width[4], 0.25, 1e-12);
  EXPECT_NEAR(a.width[1] / a.width[0], a.width[2] / a.width[1], 1e-12);
}

TEST(Axis, FindsTheCellOfAPosition) {
  const Axis a = make_axis({0.0, 1.0}, {10}, {});
  EXPECT_EQ(a.cell_at(-1.0), 0);
  EXPECT_EQ(a.cell_at(0.55), 5);
  EXPECT_EQ(a.cell_at(2.0), 9);
}

TEST(Axis, RefusesWhatIsNoAxis) {
  EXPECT_THROW(make_axis({0.0}, {}, {}), InputError);
  EXPECT_THROW(make_axis({0.0, 1.0}, {0}, {}), InputError);
  EXPECT_THROW(make_axis({1.0, 0.0}, {4}, {}), InputError);
  EXPECT_THROW(make_axis({0.0, 1.0}, {4}, {-1.0}), InputError);
}

TEST(Grid, VolumesAddUpToTheBoxAndToTheWedge) {
  const Axis x = make_axis({0.0, 2.0}, {7}, {3.0}), one = make_axis({0.0, 1.0}, {1}, {}),
             z = make_axis({0.0, 3.0}, {5}, {});
  const Grid box(x, z, z), wedge(x, one, z, true);
  double sum_box = 0.0, sum_wedge = 0.0;
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 7; ++i) {
      sum_wedge += wedge.volume(i, 0, k);
      for (int j = 0; j < 5; ++j) sum_box += box.volume(i, j, k);
    }
  EXPECT_NEAR(sum_box, 18.0, 1e-12);
  EXPECT_NEAR(sum_wedge, 0.5 * 2.0 * 2.0 * 3.0, 1e-12);
}

}  // namespace
}  // namespace ejecta
