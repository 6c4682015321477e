#include "dem/overlap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ejecta {
namespace {

const Mat3 kNoTurn = Mat3::Identity();

Mat3 turn(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

TEST(Overlap, BoxOnPlane) {
  const Overlap o = overlap_half_space(polytope_box(Vec3(1, 2, 3)), Vec3(0, 0, 1), -2.9);
  EXPECT_NEAR(o.volume, 8 * 0.1, 1e-12);
  EXPECT_NEAR((o.area - Vec3(0, 0, 8)).norm(), 0, 1e-12);
  EXPECT_NEAR((o.centroid - Vec3(0, 0, -2.95)).norm(), 0, 1e-12);
  EXPECT_NEAR(o.depth, 0.05, 1e-12);
}

TEST(Overlap, CornerOnPlaneIsATetrahedron) {
  const Vec3 n = Vec3(1, 1, 1).normalized();
  const double h = 0.1;
  const Overlap o = overlap_half_space(polytope_box(Vec3(1, 1, 1)), n, -std::sqrt(3.0) + h);
  EXPECT_NEAR(o.volume, std::sqrt(3.0) / 2 * h * h * h, 1e-12);
  EXPECT_NEAR(o.area.norm(), 1.5 * std::sqrt(3.0) * h * h, 1e-12);
  EXPECT_NEAR(o.depth, h / 4, 1e-12);
}

/// Boxes that share side planes exactly, as in a stack.
TEST(Overlap, AlignedBoxes) {
  const Polytope box = polytope_box(Vec3(1, 1, 1));
  const Overlap o = overlap_polytopes(box, box, kNoTurn, Vec3(0, 0, -1.99));
  EXPECT_NEAR(o.volume, 4 * 0.01, 1e-8);
  EXPECT_NEAR((o.area - Vec3(0, 0, 4)).norm(), 0, 1e-8);
  EXPECT_NEAR((o.centroid - Vec3(0, 0, -0.995)).norm(), 0, 1e-8);
}

TEST(Overlap, CrossedEdges) {
  const Polytope box = polytope_box(Vec3(1, 1, 1));
  // a stands on an edge along y, b below it on an edge along x; edges overlap by h.
  const double h = 0.1;
  const Mat3 a_turn = turn(M_PI / 4, Vec3(0, 1, 0)), b_turn = turn(M_PI / 4, Vec3(1, 0, 0));
  const Vec3 apart = a_turn.transpose() * Vec3(0, 0, -2 * std::sqrt(2.0) + h);
  const Overlap o = overlap_polytopes(box, box, a_turn.transpose() * b_turn, apart);
  EXPECT_NEAR(o.volume, 2.0 / 3.0 * h * h * h,
              1e-9);  // of the wedges |x| < z, |y| < h - z: int 4 z (h - z) dz
  EXPECT_NEAR((a_turn * o.area.normalized() - Vec3(0, 0, 1)).norm(), 0, 1e-7);
}

TEST(Overlap, ApartIsEmpty) {
  const Polytope box = polytope_box(Vec3(1, 1, 1));
  EXPECT_EQ(overlap_polytopes(box, box, turn(0.3, Vec3(1, 2, 3)), Vec3(3, 0, 0)).volume, 0.0);
  EXPECT_EQ(overlap_half_space(box, Vec3(0, 0, 1), -1.1).volume, 0.0);
}

/// As seen from b the overlap is the same region and pushes the other way.
TEST(Overlap, IsMutual) {
  const Polytope a = polytope_box(Vec3(1, 0.8, 0.6)), b = convex_hull(icosphere(1).vertices);
  const Mat3 r = turn(0.7, Vec3(1, -2, 0.5));
  const Vec3 t(0.9, 0.6, 1.1);
  const Overlap o = overlap_polytopes(a, b, r, t),
                p = overlap_polytopes(b, a, r.transpose(), -(r.transpose() * t));
  ASSERT_GT(o.volume, 0.01);
  EXPECT_NEAR(o.volume, p.volume, 1e-8);
  EXPECT_NEAR((o.area + r * p.area).norm(), 0, 1e-8);
  EXPECT_NEAR((o.centroid - (r * p.centroid + t)).norm(), 0, 1e-7);
}

/// No jumps: V and the vector area vary smoothly while a cube rolls from face to edge to corner; the change
/// of V with the plane's height is the area.
TEST(Overlap, AreaIsTheSlopeOfTheVolume) {
  const Polytope box = polytope_box(Vec3(1, 1, 1));
  const double d = 1e-6;
  for (double angle = 0; angle < 1.6; angle += 0.01) {
    const Vec3 n = turn(angle, Vec3(1, 0.3, 0)) * Vec3(0, 0, 1);
    const double lowest = n.dot(support_polytope(box, -n)), offset = lowest + 0.05;
    const double slope =
        (overlap_half_space(box, n, offset + d).volume - overlap_half_space(box, n, offset - d).volume) /
        (2 * d);
    EXPECT_NEAR(slope, overlap_half_space(box, n, offset).area.norm(), 1e-4);
  }
}

/// A cell is cut out another way than what two solids share.
TEST(Overlap, OfACellIsThatOfTheSolidWithItsPlanes) {
  const Polytope b = polytope_box(Vec3(0.5, 0.4, 0.3));
  for (const int level : {0, 2})
    for (int n = 0; n < 200; ++n) {
      const Polytope a = level == 0 ? polytope_box(Vec3(0.3, 0.6, 0.2)) : convex_hull(icosphere(1).vertices);
      const Mat3 rotation = turn(0.37 * n, Vec3(std::sin(n), std::cos(3 * n), std::sin(5 * n + 1)));
      const Vec3 at = 0.9 * Vec3(std::cos(7 * n), std::sin(2 * n), std::cos(11 * n));
      std::vector<HalfSpace> planes;
      for (const Polytope::Face& f : b.faces) {
        const Vec3 normal = rotation * f.normal;
        planes.push_back({normal, f.offset + normal.dot(at)});
      }
      const Overlap o = overlap_cell(a, planes), right = overlap_polytopes(a, b, rotation, at);
      ASSERT_NEAR(o.volume, right.volume, 1e-9) << n;
      if (right.volume < 1e-6) continue;
      EXPECT_LT((o.centroid - right.centroid).norm(), 1e-6) << n;
      EXPECT_LT((o.area - right.area).norm(), 1e-8) << n;
    }
}

/// Cells that fill a space share it out, but for the hair by which each is smaller.
TEST(Overlap, CellsSideBySideHoldWhatOneHolds) {
  const Polytope a = moved(polytope_box(Vec3(0.3, 0.6, 0.2)), turn(0.4, Vec3(1, 2, 3)), Vec3(0.1, 0.2, 0.05));
  const HalfSpace floor{Vec3::UnitZ(), 0.0};
  const Overlap whole = overlap_cell(a, std::vector{floor});
  double volume = 0.0, area = 0.0;
  for (int i = -5; i < 5; ++i)
    for (int j = -5; j < 5; ++j) {
      const double x = 0.2 * i, y = 0.2 * j;
      const std::vector<HalfSpace> cell{floor,
                                        {Vec3::UnitX(), x + 0.2},
                                        {-Vec3::UnitX(), -x},
                                        {Vec3::UnitY(), y + 0.2},
                                        {-Vec3::UnitY(), -y}};
      const Overlap part = overlap_cell(a, cell);
      volume += part.volume;
      area += part.first;
    }
  EXPECT_NEAR(volume, whole.volume, 1e-8);
  EXPECT_NEAR(area, whole.first, 1e-8);
  EXPECT_NEAR(whole.volume, overlap_half_space(a, floor.normal, floor.offset).volume, 1e-9);
}

}  // namespace
}  // namespace ejecta
