#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "shape/mass_properties.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

struct Polytope;
struct ShapeData;

/// Where the body axes lie in the axes the user wrote the shape in: p_user = centre + rotation * p_body.
struct BodyFrame {
  Vec3 centre{0, 0, 0};
  Quat rotation = Quat::Identity();
};

/// How thick a part of a solid is along a direction.
struct Width {
  Vec3 direction{0, 0, 0};  ///< unit, body axes; zero: along any
  double size = 0.0;        ///< m
};

/// A rigid solid. A value, cheap to copy (the data are shared and never change). Body axes have their origin
/// in the centre of mass and are the principal axes; a shape whose axes are principal already keeps them.
/// Lengths in m.
class Shape {
 public:
  /// Distance to the surface, < 0 inside. Outside it is exact; inside it is exact for sphere, box and convex
  /// shapes and, for a union, a bound that is exact near the surface away from the seams. A union of parts is
  /// one solid.
  double signed_distance(const Vec3& p) const;
  /// Unit outward gradient of the signed distance.
  Vec3 gradient(const Vec3& p) const;
  /// The point of the shape farthest along `direction` (need not be a unit vector).
  Vec3 support(const Vec3& direction) const;
  /// Radius of the smallest sphere about the centre of mass that holds the shape.
  double bounding_radius() const;
  /// Diameter of the smallest sphere, shortest edge of a box, smallest width of anything else: what a grid
  /// must resolve.
  double smallest_feature() const;
  /// Its widths between parallel faces, each in its direction (of balls the smallest diameter): what a grid
  /// must resolve there.
  std::vector<Width> widths() const;
  /// Unit density, body axes: the centre is the origin, the inertia diagonal.
  const MassProperties& mass_properties() const;
  /// Area of the shadow along `direction`, m2.
  double projected_area(const Vec3& direction) const;
  /// Triangles of the true surface, body axes; chords of curved parts stay within `tolerance` of it
  /// (0: one hundredth of the bounding radius).
  TriangleMesh surface(double tolerance = 0.0) const;
  const BodyFrame& frame() const;
  /// The parts contact detection works on, body axes: a shape is a union of balls or of convex polytopes.
  std::span<const Ball> balls() const;
  std::span<const Polytope> polytopes() const;
  /// m3, of all polytopes: more than the solid's where they cover hollows.
  double parts_volume() const;

  /// Both are copies of one shape.
  bool is(const Shape& other) const { return data_ == other.data_; }

  explicit Shape(std::shared_ptr<const ShapeData> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const ShapeData> data_;
};

/// Factories throw InputError with the offending value.
Shape make_sphere(double diameter);
/// `size`: full edge lengths.
Shape make_box(const Vec3& size);
/// The union of the balls.
Shape make_multisphere(const std::vector<Ball>& balls);
/// Balls that stand for a solid with these mass properties (unit density, in the axes of the balls).
Shape make_multisphere(const std::vector<Ball>& balls, const MassProperties& mass);
/// The paper's clusters: count[0] x count[1] x count[2] spheres on a regular lattice whose outermost spheres
/// touch the faces of the box `size` (27 = 3x3x3, 9 = 3x3x1).
Shape make_cluster(const Vec3& size, const std::array<int, 3>& count, double sphere_diameter);
/// Convex hull of the points.
Shape make_polyhedron(const std::vector<Vec3>& points);
/// A closed mesh, outward normals, of one or more separate pieces. Mass properties are those of the mesh.
/// What is not convex is divided into convex parts, below whose surface that of the mesh lies nowhere deeper
/// than `fit_error` (m; 0: exactly). `name` appears in errors, which name the open edge, the inverted or
/// degenerate triangle, triangles that cross, or the fit_error it takes.
Shape make_mesh(const TriangleMesh& mesh, const std::string& name, double fit_error = 0.0);

/// ((|x|/a)^across + (|y|/b)^across)^(along/across) + (|z|/c)^along <= 1, `size` = (2a, 2b, 2c); 2, 2 is an
/// ellipsoid. Mass properties are exact, and so is where it meets planes and polytopes; its surface, its
/// distances, and where it meets balls are those of an inscribed polyhedron.
Shape make_superquadric(const Vec3& size, double across, double along);

}  // namespace ejecta
