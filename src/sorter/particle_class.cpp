#include "sorter/particle_class.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "shape/polytope.hpp"
#include "shape/stl.hpp"
#include "sorter/plan_view.hpp"

namespace ejecta {
namespace {

constexpr int kRocks = 32;       ///< different shapes of a class of rocks
constexpr int kRockPoints = 24;  ///< of which each is the hull
/// Longest edge of a piece of surface: beside the smallest dimension, and beside the jet, whose velocity
/// falls to a half within 6.5 mm where bodies cross it, m. The faces of thin flakes need no pieces as small
/// as their rims: beside the sphere around the body.
constexpr double kPieceOverSize = 0.71, kPiece = 7.1e-3, kPieceOverSphere = 0.14;

/// Divides a triangle until its edges are short; curved shapes come as small triangles already.
void add_pieces(const Vec3& a, const Vec3& b, const Vec3& c, double edge,
                std::vector<Prototype::Piece>& out) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  const double longest = std::max({ab, bc, ca});
  if (longest <= edge * edge) {
    out.push_back({(a + b + c) / 3.0, 0.5 * (b - a).cross(c - a)});
    return;
  }
  if (longest == ab) {
    const Vec3 m = 0.5 * (a + b);
    add_pieces(a, m, c, edge, out);
    add_pieces(m, b, c, edge, out);
  } else if (longest == bc) {
    const Vec3 m = 0.5 * (b + c);
    add_pieces(a, b, m, edge, out);
    add_pieces(a, m, c, edge, out);
  } else {
    const Vec3 m = 0.5 * (c + a);
    add_pieces(a, b, m, edge, out);
    add_pieces(m, b, c, edge, out);
  }
}

/// As it comes to rest: its smallest principal dimension stands up.
Quat lying(const Shape& shape) {
  double least = 1e300;
  Vec3 up = Vec3::UnitZ();
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0)}) {
    const double height = axis.dot(shape.support(axis)) - axis.dot(shape.support(-axis));
    if (height < (1.0 - 1e-9) * least) {
      least = height;
      up = axis;
    }
  }
  return Quat::FromTwoVectors(up, Vec3::UnitZ());
}

Prototype make_prototype(Shape shape, double size, bool sharp, double tolerance) {
  const MassProperties mass = shape.mass_properties();
  Prototype p{.shape = shape,
              .size = size,
              .resting = lying(shape),
              .sharp = sharp,
              .volume = mass.volume,
              .inertia = mass.inertia.diagonal()};
  const TriangleMesh mesh = shape.surface(tolerance);
  p.corners = mesh.vertices;
  double low = 0.0, high = 0.0;
  std::vector<Vec3> plan;
  for (const Vec3& v : mesh.vertices) {
    const Vec3 at = p.resting * v;
    low = std::min(low, at.z());
    high = std::max(high, at.z());
    plan.push_back({at.x(), at.y(), 0.0});
  }
  p.height = high - low;
  p.outline = convex_outline(std::move(plan));
  p.area = area_of_outline(p.outline);
  p.perimeter = perimeter_of_outline(p.outline);
  const double edge = std::min(kPiece, std::max(kPieceOverSize * shape.smallest_feature(),
                                                kPieceOverSphere * 2.0 * shape.bounding_radius()));
  for (const auto& t : mesh.triangles)
    add_pieces(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])],
               mesh.vertices[static_cast<std::size_t>(t[2])], edge, p.surface);
  return p;
}

/// The hull of points at random on an ellipsoid with these semi-axes.
Shape random_rock(const Vec3& half, const CounterRandom& random) {
  std::vector<Vec3> points;
  for (std::uint64_t n = 0; n < kRockPoints; ++n) {
    const auto xy = random.normals(2 * n), z = random.normals(2 * n + 1);
    points.push_back(Vec3(xy[0], xy[1], z[0]).normalized().cwiseProduct(half));
  }
  return make_polyhedron(points);
}

double middle_dimension(const Shape& shape) {
  std::array<double, 3> d{};
  for (int a = 0; a < 3; ++a)
    d[static_cast<std::size_t>(a)] = shape.support(Vec3::Unit(a))[a] - shape.support(-Vec3::Unit(a))[a];
  std::sort(d.begin(), d.end());
  return d[1];
}

std::vector<Prototype> make_prototypes(const ParticleClassSpec& s, double size, const std::string& directory,
                                       std::int64_t seed) {
  const Vec3 dimensions(size / s.elongation, size, size * s.flatness);
  std::vector<Prototype> list;
  switch (s.form) {
    case ParticleForm::box:
      list.push_back(make_prototype(make_box(dimensions), size, true, 0.0));
      break;
    case ParticleForm::sphere:
      list.push_back(make_prototype(make_sphere(size), size, false, 0.05 * size));
      break;
    case ParticleForm::cluster: {
      const bool flat = s.flatness <= 0.5;
      const Shape spheres = make_cluster(dimensions, {3, 3, flat ? 1 : 3}, 0.5 * size);
      Prototype p = make_prototype(spheres, size, false, 0.05 * size);
      const MassProperties box =
          make_box(dimensions).mass_properties();  // as the paper's: that of the true box
      p.volume = box.volume;
      p.inertia = box.inertia.diagonal();
      list.push_back(std::move(p));
      break;
    }
    case ParticleForm::rock:
      for (std::uint64_t n = 0; n < kRocks; ++n) {
        const Shape rock = random_rock(0.5 * dimensions, CounterRandom(static_cast<std::uint64_t>(seed), n));
        list.push_back(make_prototype(rock, middle_dimension(rock), true, 0.0));
      }
      break;
    case ParticleForm::mesh: {
      const std::string path = (std::filesystem::path(directory) / s.file).string();
      const double scale = size / middle_dimension(make_mesh(read_stl(path, 1.0), s.file));
      list.push_back(make_prototype(make_mesh(read_stl(path, scale), s.file), size, true, 0.0));
      list.back().file_scale = scale;
    }
  }
  return list;
}

/// Of a particle at its own size.
Shape shape_of(const ParticleClassSpec& spec, const Prototype& p, double scale) {
  const double size = scale * p.size;
  const Vec3 dimensions(size / spec.elongation, size, size * spec.flatness);
  const auto scaled = [&](std::vector<Vec3> points) {
    for (Vec3& v : points) v *= scale;
    return points;
  };
  switch (spec.form) {
    case ParticleForm::box:
      return make_box(dimensions);
    case ParticleForm::sphere:
      return make_sphere(size);
    case ParticleForm::cluster:
      return make_cluster(dimensions, {3, 3, spec.flatness <= 0.5 ? 1 : 3}, 0.5 * size);
    case ParticleForm::rock:
      return make_polyhedron(scaled(p.shape.surface().vertices));
    case ParticleForm::mesh:
      break;
  }
  TriangleMesh mesh = p.shape.surface();
  mesh.vertices = scaled(mesh.vertices);
  return make_mesh(mesh, spec.file);
}

}  // namespace

ParticleClass::ParticleClass(const ParticleClassSpec& spec, const std::string& directory, std::int64_t seed)
    : spec_(spec), sizes_(size_distribution(spec, directory)) {
  const double typical = size_at(0.5);
  prototypes_ = make_prototypes(spec, typical, directory, seed);
  const double first = sizes_.mean_power(1), square = sizes_.mean_power(2), cube = sizes_.mean_power(3);
  for (const Prototype& p : prototypes_) {
    const double each = 1.0 / static_cast<double>(prototypes_.size());
    mean_mass_ += each * spec.density * p.volume * cube / std::pow(p.size, 3);
    mean_area_ += each * p.area * square / (p.size * p.size);
    mean_perimeter_ += each * p.perimeter * first / p.size;
  }
}

const Prototype& ParticleClass::prototype(double u) const {
  const auto n = static_cast<std::size_t>(u * static_cast<double>(prototypes_.size()));
  return prototypes_[std::min(n, prototypes_.size() - 1)];
}

Body body_of(const FeedParticle& p, const ParticleClassSpec& kind) {
  Body b{.name = fmt::format("{} {}", kind.name, p.id), .shape = shape_of(kind, *p.prototype, p.scale)};
  b.mass = p.mass;
  b.inertia = kind.density * std::pow(p.scale, 5) * p.prototype->inertia;
  b.orientation = orientation_of(p);
  return b;
}

}  // namespace ejecta
