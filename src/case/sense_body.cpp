#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/text.hpp"
#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/names.hpp"
#include "case/words.hpp"

/// Materials, shapes, walls.
namespace ejecta {
namespace {

constexpr double kLevel = 1e-9;  // part of a normal that is round-off

void require_material(const Case& c, const std::string& key, const std::string& name, Findings& found) {
  if (name.empty()) return;
  std::vector<std::string> known;
  for (const MaterialSpec& m : c.materials) known.push_back(m.name);
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  found.error(key, fmt::format("there is no material \"{}\"", name),
              known.empty() ? "a [[material]] of that name" : fmt::format("one of {}", joined(known)),
              fmt::format("[[material]] name = \"{}\"", name));
  found.list.back().nearest = nearest(name, known);
}

constexpr const char* kMesh = "file = \"lump.stl\"";
constexpr std::int64_t kMostSpheres = 4096;  ///< of a cluster: what they overlap is found pair by pair

/// Spheres in a row that touch or overlap fill the length; gaps would make the cluster fall apart.
bool falls_apart(const BodySpec& b) {
  for (int a = 0; a < 3; ++a) {
    const int n = b.cluster[static_cast<std::size_t>(a)];
    if (n > 1 && (b.size[a] - b.sphere_diameter) / (n - 1) > b.sphere_diameter * (1 + 1e-9)) return true;
  }
  return false;
}

void check_shape(const Case& c, const BodySpec& b, const std::string& key, Findings& found) {
  switch (b.shape) {
    case ShapeKind::sphere:
      if (b.diameter <= 0.0)
        found.error(key + ".diameter", "a sphere needs its diameter", "a length, more than 0",
                    "diameter = \"10 mm\"");
      break;
    case ShapeKind::box:
    case ShapeKind::superquadric:
      if (b.size.minCoeff() <= 0.0)
        found.error(key + ".size", "this shape needs three edge lengths",
                    "a list of 3 lengths, each more than 0", R"(size = ["20 mm", "20 mm", "10 mm"])");
      break;
    case ShapeKind::cluster:
      if (b.size.minCoeff() <= 0.0 || b.sphere_diameter <= 0.0)
        found.error(key + (b.size.minCoeff() <= 0.0 ? ".size" : ".sphere_diameter"),
                    "a cluster needs size and sphere_diameter", "lengths, each more than 0",
                    R"(size = ["10 mm", "10 mm", "10 mm"], sphere_diameter = "5 mm")");
      else if (b.sphere_diameter > b.size.minCoeff() * (1 + 1e-9))
        found.error(key + ".sphere_diameter", "the spheres are larger than the box they stand for",
                    "at most the shortest edge", "sphere_diameter = \"5 mm\"");
      else if (std::int64_t{b.cluster[0]} * b.cluster[1] * b.cluster[2] > kMostSpheres)
        found.error(
            key + ".cluster",
            fmt::format("a cluster of {} spheres", std::int64_t{b.cluster[0]} * b.cluster[1] * b.cluster[2]),
            fmt::format("at most {}; a shape with faces has more detail for less", kMostSpheres),
            "cluster = [5, 5, 5]");
      else if (falls_apart(b))
        found.error(key + ".cluster", "the spheres do not touch each other", "more or larger spheres",
                    "cluster = [3, 3, 3]");
      break;
    case ShapeKind::multisphere:
      if (b.fit_error > 0.0) {
        require_file(c, key + ".file", b.file, "a multisphere that is fitted needs its file", kMesh, found);
        break;
      }
      if (b.spheres.empty())
        found.error(key + ".spheres", "a multisphere needs its spheres", "a list of [x, y, z, radius]",
                    R"(spheres = [["0 mm", "0 mm", "0 mm", "5 mm"]])");
      if (std::any_of(b.spheres.begin(), b.spheres.end(), [](const auto& s) { return s[3] <= 0.0; }))
        found.error(key + ".spheres", "a sphere without radius", "[x, y, z, radius], the radius more than 0",
                    R"(spheres = [["0 mm", "0 mm", "0 mm", "5 mm"]])");
      break;
    case ShapeKind::polyhedron:
      if (b.vertices.size() < 4 || half_extent(b).minCoeff() <= 0.0)
        found.error(
            key + ".vertices", "these points span no volume", "at least 4 points, not in one plane",
            R"(vertices = [["0 mm", "0 mm", "0 mm"], ["9 mm", "0 mm", "0 mm"], ["0 mm", "9 mm", "0 mm"], )"
            R"(["0 mm", "0 mm", "9 mm"]])");
      break;
    case ShapeKind::mesh:
      if (b.files.empty()) require_file(c, key + ".file", b.file, "a mesh needs its file", kMesh, found);
      if (!b.files.empty() && !b.file.empty())
        found.error(key + ".files", "a mesh has either `file` or `files`", "one of them",
                    fmt::format("file = \"{}\"", b.files.front()));
      for (std::size_t n = 0; n < b.files.size(); ++n) {
        require_file(c, key + ".files", b.files[n], "a mesh needs its files", kMesh, found);
        if (std::find(b.files.begin(), b.files.begin() + static_cast<std::ptrdiff_t>(n), b.files[n]) !=
            b.files.begin() + static_cast<std::ptrdiff_t>(n))
          found.error(key + ".files",
                      fmt::format("\"{}\" stands twice: parts may not share space", b.files[n]),
                      "each part once", fmt::format("files = [\"{}\"]", b.files[n]));
      }
      break;
  }
}

/// Walls have images across periodic sides; a plane is its own there, or has none.
void require_images(const Case& c, const WallSpec& w, const std::string& key, Findings& found) {
  for (const std::string& axis : c.domain.periodic) {
    const std::size_t a = std::string("xyz").find(axis);
    if (a > 2 || std::abs(w.normal[static_cast<Eigen::Index>(a)]) <= kLevel * w.normal.norm()) continue;
    found.error(
        key + ".normal",
        fmt::format("{} is periodic, and a plane that is not parallel to it does not go on beyond the "
                    "sides",
                    axis),
        fmt::format("a normal without a part along {}, or a wall of kind \"box\" or \"plate\"", axis),
        "kind = \"plate\"");
  }
}

}  // namespace

void sense_materials(const Case& c, Findings& found) {
  check_names(c.materials, "material", found);
  for (std::size_t n = 0; n < c.material_pairs.size(); ++n) {
    require_material(c, fmt::format("material_pair.{}.a", n), c.material_pairs[n].a, found);
    require_material(c, fmt::format("material_pair.{}.b", n), c.material_pairs[n].b, found);
    const MaterialPairSpec& q = c.material_pairs[n];
    const auto is_pair = [&](const std::string& other) {
      const auto earlier = c.material_pairs.begin() + static_cast<std::ptrdiff_t>(n);
      return std::any_of(c.material_pairs.begin(), earlier, [&](const MaterialPairSpec& p) {
        return (p.a == q.a && p.b == other) || (p.a == other && p.b == q.a);
      });
    };
    if (!is_pair(q.b)) continue;
    std::string example = "no second [[material_pair]] of the two: all their keys in one";
    for (const MaterialSpec& m : c.materials)
      if (!is_pair(m.name)) example = fmt::format("b = \"{}\"", m.name);
    found.error(fmt::format("material_pair.{}.b", n),
                fmt::format("\"{}\" and \"{}\" are a pair already", q.a, q.b),
                "each two materials once, in either order", example);
  }
  if (c.contact.law == ContactLaw::linear && c.contact.linear_stiffness <= 0.0)
    found.error("contact.linear_stiffness", "the linear law needs its stiffness", "a stiffness, more than 0",
                "linear_stiffness = \"10000 N/m\"");
}

void sense_shapes(const Case& c, Findings& found) {
  check_file_names(c.bodies, "body", found);
  for (std::size_t n = 0; n < c.bodies.size(); ++n) {
    const BodySpec& b = c.bodies[n];
    const std::string key = fmt::format("body.{}", n);
    check_shape(c, b, key, found);
    require_material(c, key + ".material", b.material, found);
    if (b.rotation_axis.norm() == 0.0)
      found.error(key + ".rotation_axis", "an axis without direction", "a list of 3 numbers, not all 0",
                  "rotation_axis = [0, 0, 1]");
    if (b.on_belt && !c.launch.enabled)
      found.error(key + ".on_belt", "on the belt, but there is no [launch]", "a section [launch]",
                  "[launch]");
    if (b.on_belt && b.motion != Motion::free)
      found.error(key + ".motion", fmt::format("a body from the belt cannot be \"{}\"", word(b.motion)),
                  "\"free\"", "motion = \"free\"");
    if (b.true_box_mass && b.shape != ShapeKind::cluster)
      found.error(key + ".true_box_mass", "only a cluster stands for a box", "false, or shape = \"cluster\"",
                  "shape = \"cluster\"");
    if (b.copies > 1 && (b.on_belt || b.motion == Motion::fixed))
      found.error(key + ".copies", "copies of a body that stays where it is would be inside each other",
                  "copies = 1, or a free body that is not on_belt", "copies = 1");
    if ((b.copies > 1 || b.enters_at) && c.flow.solver != FlowSolver::none)
      found.error(key + (b.copies > 1 ? ".copies" : ".enters_at"),
                  "bodies can only enter where nothing flows",
                  "flow.solver = \"none\", or bodies that are there from the start", "solver = \"none\"");
    const std::vector<double>* sides[] = {&c.domain.x, &c.domain.y, &c.domain.z};
    for (int d = 0; d < 3 && !b.on_belt && b.motion != Motion::fixed; ++d) {
      const std::string axis(1, "xyz"[d]);
      Vec3 within = b.position;
      if (sides[d]->size() != 2 || std::count(c.domain.periodic.begin(), c.domain.periodic.end(), axis))
        continue;
      if (b.position[d] >= sides[d]->front() && b.position[d] < sides[d]->back()) continue;
      within[d] = 0.5 * (sides[d]->front() + sides[d]->back());
      found.error(
          key + ".position",
          fmt::format("the body starts outside of the domain, whose {} goes from {:.4g} to {:.4g} mm: it "
                      "would be taken away at once",
                      axis, 1e3 * sides[d]->front(), 1e3 * sides[d]->back()),
          "a place within domain." + axis, place_line("position", within));
    }
    if (b.enters_at.value_or(0.0) >= c.run.end_time)
      found.warning(key + ".enters_at", "the body never comes in: the run ends before",
                    "a time before run.end_time", "enters_at = \"0 ms\"");
    if (b.release_at > c.run.end_time)
      found.warning(key + ".release_at", "the body is never released: the run ends before",
                    "a time before run.end_time");
  }
}

void sense_domain(const Case& c, Findings& found) {
  const std::vector<double>* extents[] = {&c.domain.x, &c.domain.y, &c.domain.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& e = *extents[a];
    const std::string axis(1, "xyz"[a]), key = "domain." + axis;
    if (!e.empty() && (e.size() != 2 || !(e[0] < e[1])))
      found.error(key, "an extent is a lower and an upper end", "2 lengths, the first the smaller",
                  axis + " = [\"0 mm\", \"200 mm\"]");
    const auto& p = c.domain.periodic;
    if (e.empty() && std::find(p.begin(), p.end(), axis) != p.end())
      found.error("domain.periodic", fmt::format("periodic in {}, but without ends there", axis),
                  fmt::format("[domain] {} = [lower, upper]", axis), axis + " = [\"0 mm\", \"200 mm\"]");
  }
  for (const std::string& name : c.domain.periodic)
    if (name != "x" && name != "y" && name != "z")
      found.error("domain.periodic", fmt::format("there is no direction \"{}\"", name),
                  "\"x\", \"y\" or \"z\"", "periodic = [\"y\"]");
  if (!c.domain.periodic.empty() && c.flow.solver != FlowSolver::none && !c.bodies.empty())
    found.error("domain.periodic", "bodies cannot cross periodic sides where something flows",
                "flow.solver = \"none\"", "solver = \"none\"");
}

void sense_walls(const Case& c, Findings& found) {
  check_names(c.walls, "wall", found);
  require_material(c, "splitter.material", c.splitter.material, found);  // the plate is one too
  for (std::size_t n = 0; n < c.walls.size(); ++n) {
    const WallSpec& w = c.walls[n];
    const std::string key = fmt::format("wall.{}", n);
    require_material(c, key + ".material", w.material, found);
    if (w.normal.norm() == 0.0)
      found.error(key + ".normal", "a wall without direction", "a list of 3 numbers, not all 0",
                  "normal = [0, 0, 1]");
    if (w.kind == WallKind::mesh)
      require_file(c, key + ".file", w.file, "a mesh needs its file", kMesh, found);
    const Vec3 normal = w.normal.normalized(), across = w.velocity.dot(normal) * normal;
    if (w.kind != WallKind::mesh && w.kind != WallKind::box && across.norm() > kLevel * w.velocity.norm()) {
      const Vec3 along = w.velocity - across;
      found.error(key + ".velocity",
                  fmt::format("the surface would move by {:.4g} m/s across itself: a wall stays where it is, "
                              "its surface runs along it",
                              across.norm()),
                  "a velocity along the wall; what comes nearer is a body with motion = \"prescribed\"",
                  fmt::format("velocity = [\"{:.4g} m/s\", \"{:.4g} m/s\", \"{:.4g} m/s\"]", along.x() + 0.0,
                              along.y() + 0.0, along.z() + 0.0));
    }
    const bool endless = w.kind == WallKind::belt && w.size.isZero();
    if (w.kind == WallKind::plane || endless) require_images(c, w, key, found);
    const bool bounded =
        w.kind == WallKind::box || w.kind == WallKind::plate || (w.kind == WallKind::belt && !endless);
    if (bounded && w.size.minCoeff() <= 0.0)
      found.error(key + ".size", fmt::format("a wall of kind \"{}\" needs its extents", word(w.kind)),
                  "a list of 3 lengths", R"(size = ["100 mm", "100 mm", "2 mm"])");
  }
}

}  // namespace ejecta
