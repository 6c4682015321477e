#include "output/vtk_grains.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scratch_directory.hpp"

namespace ejecta {
namespace {

/// One vertex a grain, and its numbers in the appended block in their order: position first.
TEST(GrainFile, HoldsEveryGrainAsAPoint) {
  const ScratchDirectory scratch;
  const auto path = scratch.path() / "grains.vtp";
  const std::vector<output::GrainPoint> grains{{{1, 2, 3}, 0.5, {4, 5, 6}, {7, 8, 9}, 11},
                                               {{-1, -2, -3}, 0.25, {0, 0, 0}, {0, 0, 0}, 12}};
  output::write_grains(path, 0.5, grains);
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(text.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  for (const char* name : {"points", "connectivity", "offsets", "id", "diameter", "velocity", "force"})
    EXPECT_NE(text.find(std::string("Name=\"") + name + "\""), std::string::npos) << name;
  const std::size_t block = text.find('_', text.find("<AppendedData"));
  ASSERT_NE(block, std::string::npos);
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text.data() + block + 1, 8);
  std::vector<float> points(6);
  // The time stands before the points.
  std::size_t at = block + 1;
  while (bytes != 6 * sizeof(float)) {
    at += 8 + bytes;
    ASSERT_LT(at + 8, text.size());
    std::memcpy(&bytes, text.data() + at, 8);
  }
  std::memcpy(points.data(), text.data() + at + 8, bytes);
  EXPECT_EQ(points, (std::vector<float>{1, 2, 3, -1, -2, -3}));
}

}  // namespace
}  // namespace ejecta
