#pragma once
#include <vector>

#include "base/vec.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

struct Ball {
  Vec3 centre{0, 0, 0};
  double radius = 0.0;  ///< m
};

/// Of a body of unit density (1 kg/m3), in the axes of the input. The only owner of volume, centre and
/// inertia.
struct MassProperties {
  double volume = 0.0;          ///< m3
  Vec3 centre{0, 0, 0};         ///< m, centre of mass
  Mat3 inertia = Mat3::Zero();  ///< m5, about the centre of mass
};

/// Raw moments of a region: integrals of 1, r and r r^T.
struct Moments {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  Moments& operator+=(const Moments& other);
  MassProperties mass_properties() const;
};

MassProperties mass_sphere(double radius);
/// `size`: full edge lengths; centred on the origin.
MassProperties mass_box(const Vec3& size);
/// By the divergence theorem, exact: sums over the tetrahedra spanned by each triangle and a point near the
/// mesh (Mirtich 1996, J. Graphics Tools 1:31).
MassProperties mass_mesh(const TriangleMesh& mesh);
/// Of the union: space covered twice counts once. Slices normal to z are unions of discs, integrated along
/// their arcs by Green's theorem; Gauss-Legendre in z between the heights where the arcs change their number.
MassProperties mass_balls(const std::vector<Ball>& balls);
/// Area of a union of discs (x, y, radius) in the plane, m2.
double area_discs(const std::vector<std::array<double, 3>>& discs);

}  // namespace ejecta
