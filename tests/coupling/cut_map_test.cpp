#include "coupling/resolved/cut_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "base/parallel.hpp"

/// What bodies leave of cells and faces: volumes, areas and who carries whose momentum.
namespace ejecta {
namespace {

Body body_of(Shape shape, const Vec3& position, const Quat& turn = Quat::Identity()) {
  Body b{.name = "body", .shape = std::move(shape), .enters_at = {}};
  b.mass = 1.0;
  b.position = position;
  b.orientation = turn;
  return b;
}

Quat turned(double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis.normalized())); }

/// [-1, 1]^3.
Grid uniform(int n) {
  const Axis a = make_axis({-1.0, 1.0}, {n}, {});
  return Grid(a, a, a);
}
Grid graded(int n) {
  return Grid(make_axis({-1.0, 1.0}, {n}, {1.7}), make_axis({-1.0, 1.0}, {n + 3}, {0.6}),
              make_axis({-1.0, 0.0, 1.0}, {n / 2, n / 2}, {0.7, 1.4}));
}

CutCells mapped(const Grid& grid, const std::vector<Body>& bodies, const std::array<bool, 3>& periodic = {}) {
  CutMap map(grid, periodic);
  CutCells cut;
  map.map(bodies, {}, cut);
  return cut;
}

const CutCell* cell_at(const CutCells& cut, int i, int j, int k) {
  const int n = cut.index(i, j, k);
  return n > 0 ? &cut.cells[static_cast<std::size_t>(n - 1)] : nullptr;
}

double volume_removed(const Grid& grid, const CutCells& cut) {
  double sum = 0.0;
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        const CutCell* c = cell_at(cut, i, j, k);
        if (c || cut.index(i, j, k) < 0) sum += (c ? 1.0 - double(c->fluid) : 1.0) * grid.volume(i, j, k);
      }
  return sum;
}

Vec3 area_of(const CutWall& w) { return {w.area[0], w.area[1], w.area[2]}; }

/// Two cubes face to face, a third on an edge of theirs, a ball that touches two of them; moving.
std::vector<Body> heap() {
  std::vector<Body> bodies{
      body_of(make_box({0.5, 0.5, 0.5}), {-0.237, 0.013, -0.211}),
      body_of(make_box({0.5, 0.5, 0.5}), {0.263, 0.041, -0.195}),
      body_of(make_box({0.4, 0.4, 0.4}), {0.02, 0.03, 0.317}, turned(std::numbers::pi / 4, {0, 1, 0})),
      body_of(make_sphere(0.44), {0.013, -0.455, -0.203})};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].velocity = Vec3(0.1, -0.2, 0.05) * double(b + 1);
    bodies[b].angular_velocity = Vec3(1, 2, -1) * double(b);
  }
  return bodies;
}

TEST(CutMap, TakesTheVolumeOfASphereAwayAtSecondOrder) {
  const Body ball = body_of(make_sphere(0.9), {0.11, -0.07, 0.03});
  const double volume = std::numbers::pi / 6 * std::pow(0.9, 3);
  double error[2];
  for (int n : {0, 1}) {
    const Grid grid = uniform(n ? 60 : 30);
    error[n] = std::abs(volume_removed(grid, mapped(grid, {ball})) / volume - 1.0);
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_LT(error[1], error[0] / 3);
}

TEST(CutMap, TakesTheVolumeOfABoxAway) {
  const Grid grid = uniform(40);  // 16 x 12 x 20 cells, whose edges are cut off by a fraction of a cell
  for (const Vec3& at :
       {Vec3(0, 0, 0), Vec3(0.013, 0.021, -0.017), Vec3(0.025, -0.0249, 0.001), Vec3(0.04, 0.01, 0.03)}) {
    const std::vector<Body> box{body_of(make_box({0.8, 0.6, 1.0}), at)};
    EXPECT_NEAR(volume_removed(grid, mapped(grid, box)) / (0.8 * 0.6), 1.0, 0.01) << at.transpose();
  }
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 2, 3), Vec3(1, 1, 0)})
    for (const double angle : {0.2, 0.7}) {
      const std::vector<Body> box{
          body_of(make_box({0.8, 0.6, 1.0}), {0.013, 0.021, -0.017}, turned(angle, axis))};
      EXPECT_NEAR(volume_removed(grid, mapped(grid, box)) / (0.8 * 0.6), 1.0, 0.01)
          << angle << " " << axis.transpose();
    }
}

/// Part of [low, high] that lies in [from, to].
double overlap(double low, double high, double from, double to) {
  return std::max(std::min(high, to) - std::max(low, from), 0.0) / (high - low);
}

TEST(CutMap, CellsThatAPlaneCutsAreExact) {
  const Grid grid = graded(24);
  const Vec3 half(0.55, 0.5, 0.45);
  for (const Vec3& at : {Vec3(0.031, -0.017, 0.023), Vec3(-0.02, 0.04, 0.011)}) {
    const CutCells cut = mapped(grid, {body_of(make_box(2 * half), at)});
    int seen = 0;
    for (const CutCell& c : cut.cells) {
      const int index[3] = {c.i, c.j, c.k};
      double solid = 1.0;
      bool plane = true;  // no edge of the box is near
      for (int e = 0; e < 3; ++e) {
        const std::size_t n = static_cast<std::size_t>(index[e]);
        const double low = grid.axis(e).face[n], high = grid.axis(e).face[n + 1], from = at[e] - half[e],
                     to = at[e] + half[e];
        solid *= overlap(low, high, from, to);
        const double beyond = 0.5 * (1.0 - std::abs(Vec3(c.normal[0], c.normal[1], c.normal[2])[e])) * 0.2;
        plane = plane && (std::abs(c.normal[static_cast<std::size_t>(e)]) > Real(0.999) ||
                          (low > from + beyond && high < to - beyond));
      }
      if (!plane || c.walls == 0) continue;
      ++seen;
      ASSERT_NEAR(c.fluid, 1.0 - solid, 1e-5);
    }
    EXPECT_GT(seen, 300);
  }
}

TEST(CutMap, TakesTheVolumeOfAClusterAwayOnce) {
  const Grid grid = uniform(48);
  const Shape cluster = make_cluster({1, 1, 1}, {3, 3, 3}, 0.5);
  const double volume = volume_removed(grid, mapped(grid, {body_of(cluster, {0.01, 0.02, -0.013})}));
  EXPECT_NEAR(volume / cluster.mass_properties().volume, 1.0, 0.01);
}

/// Largest sum over the closed surface of a cell's fluid, parts of its faces. Parts of a face below 1e-5
/// count as nothing.
double largest_gap(const Grid& grid, const CutCells& cut) {
  double worst = 0.0;
  for (const CutCell& c : cut.cells) {
    Vec3 sum = Vec3::Zero();
    const int at[3] = {c.i, c.j, c.k};
    double largest = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double area =
          grid.volume(c.i, c.j, c.k) / grid.axis(int(d)).width[static_cast<std::size_t>(at[d])];
      int up[3] = {c.i, c.j, c.k};
      ++up[d];
      sum[int(d)] +=
          area * (double(cut.closed[d](c.i, c.j, c.k)) - double(cut.closed[d](up[0], up[1], up[2])));
      largest = std::max(largest, area);
    }
    for (int w = c.first_wall; w < c.first_wall + c.walls; ++w)
      sum += area_of(cut.walls[static_cast<std::size_t>(w)]);
    worst = std::max(worst, sum.norm() / largest);
  }
  return worst;
}

TEST(CutMap, TheSurfaceOfTheFluidInEveryCellIsClosed) {
  for (const Grid& grid : {uniform(31), graded(30)}) {
    double gap = largest_gap(grid, mapped(grid, {body_of(make_sphere(0.9), {0.11, -0.07, 0.03})}));
    EXPECT_LT(gap, 3e-5);
    gap = largest_gap(
        grid, mapped(grid, {body_of(make_box({0.8, 0.6, 1.0}), {0.01, 0, 0}, turned(0.4, {1, 2, 3}))}));
    EXPECT_LT(gap, 3e-5);
    gap = largest_gap(grid, mapped(grid, heap()));
    EXPECT_LT(gap, 3e-5);
  }
}

TEST(CutMap, TheWallsOfABodyAreItsSurface) {
  const auto check = [](const Grid& grid, const Body& body, double surface, double tolerance) {
    const CutCells cut = mapped(grid, {body});
    Vec3 sum = Vec3::Zero();
    double area = 0.0, volume = 0.0;
    for (const CutWall& w : cut.walls) {
      sum += area_of(w);
      area += area_of(w).norm();
      volume += area_of(w).dot(body.position - w.point) / 3.0;
    }
    EXPECT_LT(sum.norm(), 1e-5 * surface);
    EXPECT_NEAR(volume / body.shape.mass_properties().volume, 1.0, tolerance)
        << "walls point out of the fluid";
    EXPECT_NEAR(area / surface, 1.0, tolerance);
  };
  check(uniform(40), body_of(make_sphere(0.9), {0.11, -0.07, 0.03}), std::numbers::pi * 0.81, 0.02);
  check(graded(40), body_of(make_sphere(0.9), {0.11, -0.07, 0.03}), std::numbers::pi * 0.81, 0.02);
  check(uniform(60), body_of(make_box({1, 0.8, 0.9}), {0.011, 0.007, 0.003}), 4.84, 0.03);
  check(uniform(60), body_of(make_box({1, 0.8, 0.9}), {0.011, 0.007, 0.003}, turned(0.5, {1, 2, 3})), 4.84,
        0.03);
}

TEST(CutMap, FacesThatAPlaneCutsAreExact) {
  const Grid grid = graded(20);
  const Vec3 half(0.55, 0.5, 0.45), at(0.031, -0.017, 0.023);
  const CutCells cut = mapped(grid, {body_of(make_box(2 * half), at)});
  /// Whether an edge of the box runs through a cell: its faces are closed where they lead nowhere.
  const auto has_edge = [&](int i, int j, int k) {
    const int index[3] = {i, j, k};
    int axes = 0;
    for (int e = 0; e < 3; ++e) {
      const std::size_t n = static_cast<std::size_t>(std::clamp(index[e], 0, grid.n(e) - 1));
      const double low = grid.axis(e).face[n], high = grid.axis(e).face[n + 1];
      axes += (at[e] - half[e] > low && at[e] - half[e] < high) ||
              (at[e] + half[e] > low && at[e] + half[e] < high);
    }
    return axes > 1;
  };
  int seen = 0;
  for (int d = 0; d < 3; ++d)
    for (int k = 0; k < grid.nz(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i) {
          const int index[3] = {i, j, k};
          double closed = 1.0;
          int planes = 0;  // of the box that cut this face
          for (int e = 0; e < 3; ++e) {
            const std::size_t n = static_cast<std::size_t>(index[e]);
            const Axis& axis = grid.axis(e);
            const double low = axis.face[n], high = axis.face[n + 1], from = at[e] - half[e],
                         to = at[e] + half[e];
            if (e == d) {
              closed *= low > from && low < to;
              continue;
            }
            planes += (from > low && from < high) + (to > low && to < high);
            closed *= overlap(low, high, from, to);
          }
          if (planes != 1) continue;  // the corner of a box is no plane
          if (has_edge(i, j, k) || has_edge(i - (d == 0), j - (d == 1), k - (d == 2))) continue;
          seen += planes && closed > 0.0;
          ASSERT_NEAR(cut.closed[static_cast<std::size_t>(d)](i, j, k), closed, 5e-3)
              << d << i << " " << j << " " << k;
        }
  EXPECT_GT(seen, 500);
}

TEST(CutMap, EveryCellAndFaceAppearsOnceAndIsFound) {
  for (const Grid& grid : {uniform(32), graded(32)}) {
    const CutCells cut = mapped(grid, heap());
    std::set<std::array<int, 3>> cells, ghosts;
    std::set<std::array<int, 4>> faces;
    std::size_t shared = 0;
    for (std::size_t n = 0; n < cut.cells.size(); ++n) {
      const CutCell& c = cut.cells[n];
      EXPECT_TRUE(cells.insert({c.i, c.j, c.k}).second);
      EXPECT_EQ(cut.index(c.i, c.j, c.k), static_cast<int>(n) + 1);
      EXPECT_GE(c.fluid, Real(0));
      EXPECT_LE(c.fluid, Real(1));
      shared += c.walls > 1;
      for (int w = c.first_wall; w < c.first_wall + c.walls; ++w)
        EXPECT_EQ(cut.walls[static_cast<std::size_t>(w)].cell, static_cast<int>(n));
    }
    EXPECT_GT(shared, 30u) << "bodies must share cells";
    for (std::size_t n = 0; n < cut.ghosts.size(); ++n) {
      const GhostCell& g = cut.ghosts[n];
      EXPECT_TRUE(ghosts.insert({g.i, g.j, g.k}).second);
      const CutCell* c = cell_at(cut, g.i, g.j, g.k);
      if (c) {
        EXPECT_NE(c->carrier, cut.index(g.i, g.j, g.k) - 1) << "a carrier is no ghost";
      } else {
        EXPECT_EQ(cut.index(g.i, g.j, g.k), -1 - static_cast<int>(n));
      }
    }
    std::size_t marked = 0, listed = cells.size();
    for (const auto& g : ghosts) listed += !cells.contains(g);
    for (int k = 0; k < grid.nz(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i) marked += cut.index(i, j, k) != 0;
    EXPECT_EQ(marked, listed);
    for (const CutFace& f : cut.faces) {
      EXPECT_TRUE(faces.insert({f.d, f.i, f.j, f.k}).second);
      EXPECT_EQ(cut.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k), f.closed);
      EXPECT_GT(f.closed, Real(0));
      EXPECT_LE(f.closed, Real(1));
      int below[3] = {f.i, f.j, f.k};
      --below[f.d];
      EXPECT_NE(cut.index(f.i, f.j, f.k), 0);
      EXPECT_NE(cut.index(below[0], below[1], below[2]), 0);
    }
    std::size_t closed = 0;
    for (std::size_t d = 0; d < 3; ++d)
      for (int k = 0; k < grid.nz(); ++k)
        for (int j = 0; j < grid.ny(); ++j)
          for (int i = 0; i < grid.nx(); ++i) closed += cut.closed[d](i, j, k) != Real(0);
    EXPECT_EQ(closed, cut.faces.size());
  }
}

TEST(CutMap, SmallCellsAreCarriedByCellsThatKeepTheirOwnMomentum) {
  const Grid grid = graded(32);
  const CutCells cut = mapped(grid, heap());
  double fluid = 0.0, carried = 0.0, orphaned = 0.0;
  std::vector<int> seen(cut.cells.size(), 0);
  for (std::size_t n = 0; n < cut.cells.size(); ++n) {
    const CutCell& c = cut.cells[n];
    const double volume = grid.volume(c.i, c.j, c.k);
    fluid += double(c.fluid) * volume;
    if (c.carrier < 0) {
      orphaned += double(c.fluid) * volume;
      continue;
    }
    const CutCell& carrier = cut.cells[static_cast<std::size_t>(c.carrier)];
    EXPECT_EQ(carrier.carrier, c.carrier);
    EXPECT_GE(carrier.fluid, Real(0.5));
    EXPECT_LE(std::abs(carrier.i - c.i) + std::abs(carrier.j - c.j) + std::abs(carrier.k - c.k), 4);
    if (c.carrier != static_cast<int>(n)) {
      EXPECT_EQ(c.members, 0);
      EXPECT_EQ(c.carried, Real(0));
      continue;
    }
    carried += double(c.carried) * volume;
    ASSERT_GT(c.members, 0);
    EXPECT_EQ(cut.members[static_cast<std::size_t>(c.first_member)], static_cast<int>(n));
    double own = 0.0;
    for (int m = c.first_member; m < c.first_member + c.members; ++m) {
      const std::size_t member = static_cast<std::size_t>(cut.members[static_cast<std::size_t>(m)]);
      ++seen[member];
      EXPECT_EQ(cut.cells[member].carrier, static_cast<int>(n));
      own += double(cut.cells[member].fluid) *
             grid.volume(cut.cells[member].i, cut.cells[member].j, cut.cells[member].k);
    }
    EXPECT_NEAR(double(c.carried) * volume, own, 1e-5 * volume);
  }
  for (std::size_t n = 0; n < cut.cells.size(); ++n) EXPECT_EQ(seen[n], cut.cells[n].carrier >= 0);
  EXPECT_NEAR(carried + orphaned, fluid, 1e-5 * fluid);
  EXPECT_LT(orphaned, 0.02 * fluid);
}

// What passes between a cell that keeps momentum and one whose momentum nobody keeps would be lost.
TEST(CutMap, FluidThatNobodyCarriesIsLockedIn) {
  for (const std::vector<Body>& bodies :
       {heap(),
        {body_of(make_sphere(0.5), {0.013, 0.021, -0.017})},
        {body_of(make_box({0.7, 0.6, 0.5}), {0.01, 0.02, 0.03}, turned(0.4, {1, 2, 3}))}}) {
    const Grid grid = uniform(26);
    const CutCells cut = mapped(grid, bodies);
    const auto nobodys = [&](int i, int j, int k) {
      const CutCell* c = cell_at(cut, i, j, k);
      return (c && c->carrier < 0) || (!c && cut.index(i, j, k) < 0);
    };
    int open = 0;
    for (int d = 0; d < 3; ++d)
      for (int k = 1; k < 26; ++k)
        for (int j = 1; j < 26; ++j)
          for (int i = 1; i < 26; ++i) {
            const int below[3] = {i - (d == 0), j - (d == 1), k - (d == 2)};
            if (cut.closed[static_cast<std::size_t>(d)](i, j, k) >= Real(1)) continue;
            open += nobodys(i, j, k) != nobodys(below[0], below[1], below[2]);
          }
    EXPECT_EQ(open, 0);
  }
}

TEST(CutMap, GhostsAskCellsInTheFluidThatKeepTheirOwnMomentum) {
  const Grid grid = uniform(32);
  const std::vector<Body> bodies = heap();
  const CutCells cut = mapped(grid, bodies);
  const Field& f = cut.closed[0];
  std::map<const Real*, std::array<int, 3>> places;
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) places[&f(i, j, k)] = {i, j, k};
  int with_donors = 0;
  for (const GhostCell& g : cut.ghosts) {
    if (g.donors == 0) continue;
    ++with_donors;
    EXPECT_GT(g.image, Real(0));
    EXPECT_LT(g.ratio, Real(1.5));
    double sum = 0.0;
    for (std::size_t m = 0; m < static_cast<std::size_t>(g.donors); ++m) {
      sum += double(g.weight[m]);
      const auto at = places.find(&f(g.i, g.j, g.k) + g.donor[m]);
      ASSERT_NE(at, places.end());
      const auto [i, j, k] = at->second;
      const int index = cut.index(i, j, k);
      ASSERT_GE(index, 0);
      if (index > 0) {
        EXPECT_EQ(cut.cells[static_cast<std::size_t>(index - 1)].carrier, index - 1);
      }
      for (const Body& b : bodies) EXPECT_GT(b.signed_distance(grid.centre(i, j, k)), -1e-3);
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
  }
  EXPECT_GT(with_donors, 1000);
}

TEST(CutMap, WallsAndFacesMoveWithTheirBody) {
  const Grid grid = uniform(24);
  Body ball = body_of(make_sphere(0.9), {0.11, -0.07, 0.03});
  ball.velocity = {3, -1, 2};
  ball.angular_velocity = {1, -4, 2};
  CutCells cut;
  CutMap map(grid, {});
  map.map(std::vector<Body>{ball}, std::vector<double>{2e-3}, cut);
  ASSERT_FALSE(cut.walls.empty());
  for (const CutWall& w : cut.walls) {
    EXPECT_EQ(w.roughness, Real(2e-3));
    EXPECT_LT(std::abs(ball.signed_distance(w.point)), 1e-6);
    const Vec3 v = ball.velocity_at(w.point);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(w.velocity[static_cast<std::size_t>(d)], v[d], 1e-5);
  }
  for (const CutFace& f : cut.faces) {
    Vec3 x = grid.centre(std::min(f.i, 23), std::min(f.j, 23), std::min(f.k, 23));
    x[f.d] = grid.axis(f.d).face[static_cast<std::size_t>(f.d == 0 ? f.i : f.d == 1 ? f.j : f.k)];
    EXPECT_NEAR(f.velocity, ball.velocity_at(x)[f.d], 1e-5);
  }
}

TEST(CutMap, ABodyAcrossTheCornerOfAPeriodicBoxIsTheSameAsInTheMiddle) {
  constexpr int n = 24, half = n / 2;
  const Grid grid = uniform(n);
  const Vec3 at(0.031, -0.017, 0.023), shift(1, 1, 1);
  Body ball = body_of(make_box({0.7, 0.6, 0.5}), at, turned(0.4, {1, 2, 3}));
  ball.angular_velocity = {1, -4, 2};
  Body corner = ball;
  corner.position += shift;
  const CutCells middle = mapped(grid, {ball}, {true, true, true}),
                 across = mapped(grid, {corner}, {true, true, true});
  int seen = 0;
  for (std::size_t d = 0; d < 3; ++d)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const double here = middle.closed[d](i, j, k);
          const int to[3] = {(i + half) % n, (j + half) % n, (k + half) % n};
          seen += here > 0.0 && here < 1.0;
          ASSERT_NEAR(across.closed[d](to[0], to[1], to[2]), here, 2e-4);
          // The upper end of the box is its lower one.
          if (to[d] != 0) continue;
          int end[3] = {to[0], to[1], to[2]};
          end[d] = n;
          ASSERT_NEAR(across.closed[d](end[0], end[1], end[2]), here, 2e-4);
        }
  EXPECT_GT(seen, 300);
  EXPECT_NEAR(volume_removed(grid, across), volume_removed(grid, middle), 1e-4);
  Vec3 moment[2] = {Vec3::Zero(), Vec3::Zero()};
  for (const CutWall& w : middle.walls) moment[0] += area_of(w).cwiseProduct(w.point - ball.position);
  for (const CutWall& w : across.walls) moment[1] += area_of(w).cwiseProduct(w.point - corner.position);
  EXPECT_LT((moment[0] - moment[1]).norm(), 1e-3 * moment[0].norm())
      << "walls of images act where the body is";
}

TEST(CutMap, GivesTheSameListsForAnyNumberOfThreads) {
  const Grid grid = graded(30);
  const int threads = thread_count();
  std::vector<CutCells> all;
  for (int n : {1, 2, 4}) {
    set_thread_count(n);
    all.push_back(mapped(grid, heap()));
  }
  set_thread_count(threads);
  for (std::size_t v = 1; v < all.size(); ++v) {
    const CutCells &a = all[0], &b = all[v];
    ASSERT_EQ(a.cells.size(), b.cells.size());
    ASSERT_EQ(a.walls.size(), b.walls.size());
    ASSERT_EQ(a.faces.size(), b.faces.size());
    ASSERT_EQ(a.ghosts.size(), b.ghosts.size());
    EXPECT_EQ(a.members, b.members);
    for (std::size_t n = 0; n < a.cells.size(); ++n) {
      const CutCell &c = a.cells[n], &d = b.cells[n];
      ASSERT_EQ(
          std::tie(c.i, c.j, c.k, c.fluid, c.distance, c.normal, c.carrier, c.carried, c.first_wall, c.walls),
          std::tie(d.i, d.j, d.k, d.fluid, d.distance, d.normal, d.carrier, d.carried, d.first_wall,
                   d.walls));
    }
    for (std::size_t n = 0; n < a.walls.size(); ++n) {
      ASSERT_EQ(std::tie(a.walls[n].cell, a.walls[n].body, a.walls[n].area, a.walls[n].velocity),
                std::tie(b.walls[n].cell, b.walls[n].body, b.walls[n].area, b.walls[n].velocity));
      ASSERT_EQ(a.walls[n].point, b.walls[n].point);
    }
    for (std::size_t n = 0; n < a.faces.size(); ++n) {
      const CutFace &c = a.faces[n], &d = b.faces[n];
      ASSERT_EQ(std::tie(c.d, c.i, c.j, c.k, c.closed, c.velocity),
                std::tie(d.d, d.i, d.j, d.k, d.closed, d.velocity));
    }
    for (std::size_t n = 0; n < a.ghosts.size(); ++n) {
      const GhostCell &c = a.ghosts[n], &d = b.ghosts[n];
      ASSERT_EQ(std::tie(c.i, c.j, c.k, c.donors, c.donor, c.weight, c.ratio, c.image, c.normal, c.solid),
                std::tie(d.i, d.j, d.k, d.donors, d.donor, d.weight, d.ratio, d.image, d.normal, d.solid));
    }
  }
}

TEST(CutMap, ForgetsWhatItMappedBefore) {
  const Grid grid = uniform(24);
  CutMap map(grid, {});
  CutCells again;
  map.map(heap(), {}, again);
  const std::vector<Body> ball{body_of(make_sphere(0.5), {0.4, 0.4, 0.4})};
  map.map(ball, {}, again);
  const CutCells fresh = mapped(grid, ball);
  EXPECT_EQ(again.cells.size(), fresh.cells.size());
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) {
        ASSERT_EQ(again.index(i, j, k), fresh.index(i, j, k));
        for (std::size_t d = 0; d < 3; ++d) ASSERT_EQ(again.closed[d](i, j, k), fresh.closed[d](i, j, k));
      }
  map.map(std::vector<Body>{}, {}, again);
  EXPECT_TRUE(again.empty());
  EXPECT_EQ(volume_removed(grid, again), 0.0);
}

}  // namespace
}  // namespace ejecta
