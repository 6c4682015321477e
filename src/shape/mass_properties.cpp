#include "shape/mass_properties.hpp"

#include <cmath>
#include <numbers>

namespace ejecta {

Moments& Moments::operator+=(const Moments& other) {
  volume += other.volume;
  first += other.first;
  second += other.second;
  return *this;
}

MassProperties Moments::mass_properties() const {
  MassProperties m;
  m.volume = volume;
  m.centre = first / volume;
  const Mat3 central = second - volume * m.centre * m.centre.transpose();
  m.inertia = central.trace() * Mat3::Identity() - central;
  return m;
}

MassProperties mass_sphere(double radius) {
  MassProperties m;
  m.volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  m.inertia = 0.4 * m.volume * radius * radius * Mat3::Identity();
  return m;
}

MassProperties mass_box(const Vec3& size) {
  MassProperties m;
  m.volume = size.prod();
  const Vec3 square = size.cwiseAbs2();
  m.inertia = (m.volume / 12.0 * (Vec3::Constant(square.sum()) - square)).asDiagonal();
  return m;
}

MassProperties mass_mesh(const TriangleMesh& mesh) {
  const Vec3 origin = mesh.vertices.empty() ? Vec3(0, 0, 0) : mesh.vertices.front();
  Moments sum;
  for (const auto& t : mesh.triangles) {
    Mat3 corners;
    for (int c = 0; c < 3; ++c) corners.col(c) = mesh.vertices[static_cast<std::size_t>(t[c])] - origin;
    const double volume = corners.determinant() / 6.0;
    const Vec3 total = corners.rowwise().sum();
    // Tetrahedron with one corner at the origin: integral of r r^T = V/20 (sum c c^T + total total^T).
    sum += {volume, 0.25 * volume * total,
            volume / 20.0 * (corners * corners.transpose() + total * total.transpose())};
  }
  MassProperties m = sum.mass_properties();
  m.centre += origin;
  return m;
}

}  // namespace ejecta
