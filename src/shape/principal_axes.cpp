#include "shape/principal_axes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

namespace ejecta {
namespace {

/// Columns permuted so that each lies near its own axis, then signed; right-handed.
Mat3 nearest_to_identity(const Mat3& axes) {
  std::array<int, 3> order{0, 1, 2}, best = order;
  double score = -1.0;
  do {
    double s = 0.0;
    for (int c = 0; c < 3; ++c) s += std::abs(axes(c, order[static_cast<std::size_t>(c)]));
    if (s > score + 1e-12) {
      score = s;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  Mat3 result;
  for (int c = 0; c < 3; ++c) {
    const Vec3 column = axes.col(best[static_cast<std::size_t>(c)]);
    result.col(c) = column[c] < 0 ? Vec3(-column) : column;
  }
  if (result.determinant() < 0) result.col(2) *= -1.0;
  return result;
}

}  // namespace

BodyFrame to_principal_axes(MassProperties& mass) {
  BodyFrame frame{mass.centre, Quat::Identity()};
  mass.centre.setZero();
  Mat3 products = mass.inertia;
  products.diagonal().setZero();
  if (products.cwiseAbs().maxCoeff() > 1e-9 * mass.inertia.trace()) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(mass.inertia);
    const Mat3 axes = nearest_to_identity(solver.eigenvectors());
    mass.inertia = axes.transpose() * mass.inertia * axes;
    frame.rotation = Quat(axes);
  }
  mass.inertia = Mat3(mass.inertia.diagonal().asDiagonal());
  return frame;
}

}  // namespace ejecta
