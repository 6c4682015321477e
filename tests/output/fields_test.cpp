#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "output/output_file.hpp"
#include "output/pvd_series.hpp"
#include "output/slice_sampler.hpp"
#include "output/vtk_bodies.hpp"
#include "output/vtk_rectilinear.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using testing::HasSubstr;

namespace {

Grid small_grid() {
  return {make_axis({0, 1}, {4}, {3.0}), make_axis({0, 1}, {3}, {}), make_axis({-1, 1}, {5}, {})};
}

void fill(Field& f, const Grid& grid, const auto& function) {
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) f(i, j, k) = static_cast<Real>(function(grid.centre(i, j, k)));
}

/// Array `name` of a file written by VtkAppended.
template <class T>
std::vector<T> appended(const std::string& file, const std::string& name) {
  const std::size_t tag = file.find("Name=\"" + name + "\"");
  const std::size_t offset = std::stoul(file.substr(file.find("offset=\"", tag) + 8));
  const char* data = file.data() + file.find("encoding=\"raw\">\n_") + 17 + offset;
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, data, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), data + sizeof bytes, bytes);
  return values;
}

}  // namespace

TEST(VtkRectilinear, HoldsTheCellsInOrderWithoutGhosts) {
  const ScratchDirectory dir;
  const Grid grid = small_grid();
  Field a = grid.make_field(), b = grid.make_field();
  a.fill(-99);  // ghosts must not appear
  fill(a, grid, [](const Vec3& c) { return c.x() + 10 * c.y() + 100 * c.z(); });
  fill(b, grid, [](const Vec3& c) { return c.z(); });
  RectilinearWriter(grid).write(
      dir / "a.vtr", 0.125,
      std::vector{scalar_field("s", a.view()), vector_field("v", a.view(), b.view(), b.view())});
  const std::string file = read_file(dir / "a.vtr");
  EXPECT_THAT(file, HasSubstr("Extent=\"0 4 0 3 0 5\""));
  EXPECT_THAT(file, HasSubstr(">0.125</DataArray>"));
  EXPECT_EQ(appended<double>(file, "x"), grid.axis(0).face);
  const auto s = appended<float>(file, "s"), v = appended<float>(file, "v");
  ASSERT_EQ(s.size(), 60u);
  ASSERT_EQ(v.size(), 180u);
  EXPECT_EQ(s[1], static_cast<float>(a(1, 0, 0)));
  EXPECT_EQ(s[4 * 2 + 12 * 3 + 3], static_cast<float>(a(3, 2, 3)));
  EXPECT_EQ(v[3 * 59], static_cast<float>(a(3, 2, 4)));
  EXPECT_EQ(v[3 * 59 + 2], static_cast<float>(b(3, 2, 4)));
}

TEST(VtkRectilinear, SliceIsOneLayerOfCells) {
  const ScratchDirectory dir;
  const Grid grid = small_grid();
  Field a = grid.make_field();
  fill(a, grid, [](const Vec3& c) { return c.y(); });
  const Range3 r = slice_range(grid, 1, 0.5);
  EXPECT_EQ(r.j0, 1);
  EXPECT_EQ(r.j1, 2);
  RectilinearWriter(grid).write(dir / "a.vtr", 0.0, std::vector{scalar_field("s", a.view())}, r);
  const auto s = appended<float>(read_file(dir / "a.vtr"), "s");
  ASSERT_EQ(s.size(), 20u);
  for (const float value : s) EXPECT_FLOAT_EQ(value, 0.5f);
}

TEST(VtkBodies, TrianglesStandInTheWorld) {
  const ScratchDirectory dir;
  BodySurface triangle{"t", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  BodiesWriter writer({triangle, triangle});
  const BodyPose turned{Vec3(0, 0, 5), Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()))};
  writer.write(dir / "b.vtp", 0.0, std::vector{BodyPose{}, turned},
               std::vector{BodyArray{"speed", 1, {3.0, 4.0}}});
  const std::string file = read_file(dir / "b.vtp");
  const auto points = appended<float>(file, "points");
  EXPECT_NEAR(points[9], 0.0, 1e-6);  // x axis of the second body points along y
  EXPECT_NEAR(points[10], 1.0, 1e-6);
  EXPECT_NEAR(points[11], 5.0, 1e-6);
  EXPECT_EQ(appended<std::int64_t>(file, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(appended<float>(file, "speed"), (std::vector<float>{3, 4}));
}

TEST(PvdSeries, ValidAfterEachAdditionAndShortenedOnResume) {
  const ScratchDirectory dir;
  PvdSeries series(dir.path(), "air");
  EXPECT_THAT(read_file(dir / "air.pvd"), HasSubstr("</VTKFile>"));
  for (const double t : {0.0, 0.1, 0.2}) series.add(t, series.next(".vtr"));
  const std::string whole = read_file(dir / "air.pvd");
  EXPECT_THAT(whole, HasSubstr("timestep=\"0.2\" part=\"0\" file=\"air-000002.vtr\""));
  PvdSeries resumed(dir.path(), "air", 0.1);
  EXPECT_EQ(resumed.next(".vtr").filename(), "air-000002.vtr");
  resumed.add(0.2, resumed.next(".vtr"));
  EXPECT_EQ(read_file(dir / "air.pvd"), whole);
}

TEST(SliceSampler, LinearFieldIsExactOnAGradedGrid) {
  const Grid grid = small_grid();
  Field u = grid.make_field(), zero = grid.make_field();
  fill(u, grid, [](const Vec3& c) { return 1 + c.x() + 2 * c.z(); });
  const SliceRaster raster{"r", 1, 0.5, {0.3, -0.5}, {0.6, 0.5}, {6, 10}, false, false};
  SliceFrame frame;
  SliceSampler(grid, raster).sample(u.view(), zero.view(), zero.view(), frame);
  ASSERT_EQ(frame.speed.size(), 60u);
  for (int q = 0; q < 10; ++q)
    for (int p = 0; p < 6; ++p) {
      const double expected = std::abs(1 + (0.3 + 0.05 * (p + 0.5)) + 2 * (-0.5 + 0.1 * (q + 0.5)));
      EXPECT_NEAR(frame.speed[static_cast<std::size_t>(q * 6 + p)] / 255.0 * frame.full_scale, expected,
                  frame.full_scale / 500);
    }
}

TEST(SliceSampler, MirrorsAcrossASymmetryPlaneAndIsZeroOutside) {
  const Grid grid = small_grid();
  Field u = grid.make_field(), zero = grid.make_field();
  fill(u, grid, [](const Vec3& c) { return 1 + c.x(); });
  const SliceRaster raster{"r", 1, 0.5, {-2, -1}, {2, 1}, {40, 4}, true, false};
  SliceFrame frame;
  SliceSampler(grid, raster).sample(u.view(), zero.view(), zero.view(), frame);
  for (std::size_t p = 0; p < 20; ++p) EXPECT_EQ(frame.speed[p], frame.speed[39 - p]);
  EXPECT_EQ(frame.speed[0], 0);
  EXPECT_GT(frame.speed[20], 0);
}

TEST(SliceSampler, NanIsRefused) {
  const Grid grid = small_grid();
  Field u = grid.make_field();
  u.fill(NAN);
  SliceFrame frame;
  SliceSampler sampler(grid, {"r", 1, 0.5, {0, -1}, {1, 1}, {4, 4}, false, false});
  EXPECT_THROW(sampler.sample(u.view(), u.view(), u.view(), frame), DivergedError);
}
