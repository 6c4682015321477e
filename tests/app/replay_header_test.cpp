#include "simulation/replay_header.hpp"

#include <gtest/gtest.h>

#include "case/load.hpp"

using namespace ejecta;

namespace {

/// A box of 40 mm that a jet enters from below, or its half or quarter beyond planes of symmetry.
output::ReplayHeader header_of(bool half_x, bool half_y) {
  std::string text = "[run]\nend_time = \"1 ms\"\n";
  for (const char axis : {'x', 'y', 'z'}) {
    const bool half = (axis == 'x' && half_x) || (axis == 'y' && half_y);
    const std::string points = axis == 'z' ? "[\"40 mm\", \"80 mm\"]"
                               : half      ? "[\"0 mm\", \"20 mm\"]"
                                           : "[\"-20 mm\", \"20 mm\"]";
    text += std::string("[grid.") + axis + "]\npoints = " + points + "\ncells = 8\n";
    if (half) text += std::string("[boundary.") + axis + "_min]\ntype = \"symmetry\"\n";
  }
  text +=
      "[boundary.z_min]\ntype = \"jet\"\n[boundary.z_max]\ntype = \"pressure-outlet\"\n[launch]\nstand_off = "
      "\"60 mm\"\n";
  const Case c = parse_case(text, "box.toml");
  const CoupledModel model(c);
  return replay_header(c, model);
}

}  // namespace

TEST(ReplayHeader, AWholeBoxIsShownAsItIs) {
  const auto h = header_of(false, false);
  ASSERT_EQ(h.rasters.size(), 2u);
  EXPECT_EQ(h.rasters[0].axis, 1);
  EXPECT_EQ(h.rasters[0].position, 0.0);
  EXPECT_EQ(h.rasters[1].axis, 2);
  EXPECT_DOUBLE_EQ(h.rasters[1].position, 0.06);
  for (const auto& r : h.rasters) EXPECT_FALSE(r.mirror_x || r.mirror_y);
}

TEST(ReplayHeader, HalvesAreMirroredIntoTheWhole) {
  const auto h = header_of(true, true);
  const auto& side = h.rasters.at(0);
  EXPECT_TRUE(side.mirror_x);
  EXPECT_EQ(side.lower[0], -side.upper[0]);
  EXPECT_EQ(side.position, 0.0);
  const auto& above = h.rasters.at(1);
  EXPECT_TRUE(above.mirror_x && above.mirror_y);
  EXPECT_EQ(above.lower[1], -above.upper[1]);
  EXPECT_FALSE(header_of(true, false).rasters[1].mirror_y);
}
