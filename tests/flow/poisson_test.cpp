#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "flow/poisson/fast_diagonal.hpp"

namespace ejecta {
namespace {

using B = PoissonBoundary;

/// Applies the discrete operator the solver promises to invert.
double laplacian(const Grid& g, const std::array<B, 6>& b, const Field& p, int i, int j, int k) {
  const int at[3] = {i, j, k};
  double sum = 0.0;
  for (int d = 0; d < 3; ++d) {
    const Axis& a = g.axis(d);
    if (a.n == 1 && b[2 * d] != B::dirichlet) continue;
    for (int side = 0; side < 2; ++side) {
      int next[3] = {i, j, k};
      next[d] += side ? 1 : -1;
      const int face = at[d] + side;
      double distance, other;
      if (next[d] < 0 || next[d] >= a.n) {
        const B kind = b[2 * d + side];
        if (kind == B::neumann) continue;
        if (kind == B::dirichlet) {
          distance = 0.5 * a.width[at[d]];
          other = 0.0;
        } else {
          next[d] = (next[d] + a.n) % a.n;
          distance = 0.5 * (a.width.front() + a.width.back());
          other = p(next[0], next[1], next[2]);
        }
      } else {
        distance = std::abs(a.centre[next[d]] - a.centre[at[d]]);
        other = p(next[0], next[1], next[2]);
      }
      const double lines = g.axisymmetric() && d == 0 ? a.face[face] * g.axis(2).width[k] / g.volume(i, j, k)
                                                      : 1.0 / a.width[at[d]];
      sum += lines * g.volume(i, j, k) * (other - p(i, j, k)) / distance;
    }
  }
  return sum;
}

double residual(const Grid& g, const std::array<B, 6>& b) {
  bool open = false;
  for (B kind : b) open = open || kind == B::dirichlet;
  Field rhs = g.make_field(), phi = g.make_field();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double sum = 0.0, largest = 0.0, worst = 0.0;
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i) {
        rhs(i, j, k) = static_cast<Real>(uniform(random));
        sum += rhs(i, j, k);
      }
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i) {
        if (!open) rhs(i, j, k) -= static_cast<Real>(sum / double(g.cells()));
        largest = std::max(largest, std::abs(double(rhs(i, j, k))));
      }
  FastDiagonalPoisson solver(g, b);
  solver.solve(rhs.view(), phi.view());
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i)
        worst = std::max(worst, std::abs(laplacian(g, b, phi, i, j, k) - rhs(i, j, k)));
  return worst / largest;
}

constexpr double kRoundOff = sizeof(Real) == 4 ? 3e-4 : 1e-11;

Grid graded(int nx, int ny, int nz) {
  return Grid(make_axis({-1, 0.2, 1}, {nx / 2, nx - nx / 2}, {0.3, 3}), make_axis({0, 1}, {ny}, {4}),
              make_axis({0, 2}, {nz}, {0.25}));
}

TEST(FastDiagonalPoisson, InvertsTheOperatorOnAGradedGridForEveryKindOfBoundary) {
  const B n = B::neumann, d = B::dirichlet, p = B::periodic;
  for (const auto& b : {std::array<B, 6>{n, n, n, n, n, d},
                        {d, d, d, d, d, d},
                        {p, p, n, n, n, d},
                        {p, p, p, p, d, n},
                        {n, n, n, n, n, n},
                        {p, p, p, p, p, p},
                        {n, d, p, p, p, p}})
    EXPECT_LT(residual(graded(19, 14, 23), b), kRoundOff);
}

TEST(FastDiagonalPoisson, InvertsTheAxisymmetricOperator) {
  const B n = B::neumann, d = B::dirichlet, p = B::periodic;
  const Grid g(make_axis({0, 0.01, 0.05}, {16, 20}, {1, 5}), make_axis({0, 1}, {1}, {}),
               make_axis({0, 0.2}, {40}, {3}), true);
  for (const auto& b : {std::array<B, 6>{n, d, p, p, n, d}, {n, n, n, n, n, d}, {n, n, n, n, n, n}})
    EXPECT_LT(residual(g, b), kRoundOff);
}

TEST(FastDiagonalPoisson, WorksInTwoDimensionsAndOne) {
  const B n = B::neumann, d = B::dirichlet, p = B::periodic;
  EXPECT_LT(residual(graded(32, 17, 1), {p, p, p, p, p, p}), kRoundOff);
  EXPECT_LT(residual(graded(32, 1, 20), {n, d, n, n, n, n}), kRoundOff);
  EXPECT_LT(residual(graded(2, 1, 40), {n, n, n, n, n, d}), kRoundOff);
}

TEST(FastDiagonalPoisson, GivesTheSameBitsForAnyNumberOfThreads) {
  const Grid g = graded(33, 20, 18);
  Field rhs = g.make_field(), one = g.make_field(), two = g.make_field();
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i) rhs(i, j, k) = std::sin(Real(i * 3 + j * j + 7 * k));
  FastDiagonalPoisson solver(g, {B::neumann, B::neumann, B::neumann, B::neumann, B::neumann, B::dirichlet});
  const int threads = thread_count();
  set_thread_count(1);
  solver.solve(rhs.view(), one.view());
  set_thread_count(2);
  solver.solve(rhs.view(), two.view());
  set_thread_count(threads);
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i) ASSERT_EQ(one(i, j, k), two(i, j, k));
}

}  // namespace
}  // namespace ejecta
