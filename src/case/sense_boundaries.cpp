#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/units.hpp"
#include "case/expression.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/schema.hpp"

/// What the six faces of the box may be.
namespace ejecta {
namespace {

/// A jet enters through one face, into the box, and not at a grazing angle.
void check_jet_face(const Case& c, std::size_t f, const std::string& key, Findings& found) {
  if (const auto first = static_cast<std::size_t>(*jet_face(c)); first != f)
    found.error(key + ".type", fmt::format("the jet enters through {} already", face_names[first]),
                "one face of type \"jet\"; jet.more_nozzles for further orifices", "type = \"free-stream\"");
  const double length = c.jet.direction.norm();
  const double inward = (f % 2 ? -1.0 : 1.0) * c.jet.direction[static_cast<int>(f / 2)];
  if (inward >= 0.5 * length && length > 0.0) return;
  Vec3 normal = Vec3::Zero();
  normal[static_cast<int>(f / 2)] = f % 2 ? -1.0 : 1.0;
  found.error(key + ".type",
              fmt::format("the jet blows along ({:g}, {:g}, {:g}) and does not enter through {}",
                          c.jet.direction.x(), c.jet.direction.y(), c.jet.direction.z(), face_names[f]),
              "a jet.direction into the box, within 60 degrees of the face's normal",
              fmt::format("[jet] direction = [{:g}, {:g}, {:g}]", normal.x(), normal.y(), normal.z()));
}

/// Across a periodic face cells see each other: the first and the last must be alike.
void check_periodic_cells(const Case& c, std::size_t axis, Findings& found) {
  const AxisSpec& a = c.grid.axis[axis];
  if (a.points.size() < 2 || a.cells.size() + 1 != a.points.size()) return;
  const auto width = [&](std::size_t block, int cell) {
    return cell_width(a.points[block + 1] - a.points[block], a.cells[block],
                      a.grading.empty() ? 1.0 : a.grading[block], cell);
  };
  const double first = width(0, 0), last = width(a.cells.size() - 1, a.cells.back() - 1);
  if (std::abs(first - last) > 1e-9 * first)
    found.error(
        std::string("grid.") + axis_names[axis],
        fmt::format("periodic, but its first cell is {} wide and its last {}",
                    format_quantity(first, Dimension::length), format_quantity(last, Dimension::length)),
        "equal cells at both ends of a periodic axis", "grading = [1]");
}

void check_face(const Case& c, std::size_t f, const std::string& key, Findings& found) {
  const BoundarySpec& face = c.boundary[f];
  const BoundarySpec& opposite = c.boundary[f ^ 1u];
  if (face.type == BoundaryType::periodic && opposite.type != BoundaryType::periodic)
    found.error(key + ".type",
                fmt::format("periodic, but {} is \"{}\"", face_names[f ^ 1u], word(opposite.type)),
                "both faces of the axis periodic", "type = \"periodic\"");
  if (f % 2 == 0 && face.type == BoundaryType::periodic) check_periodic_cells(c, f / 2, found);
  if (face.type == BoundaryType::velocity && !face.state.velocity)
    found.error(key + ".velocity", "a velocity boundary needs its velocity",
                "a list of 3 velocities or formulas", "velocity = [\"3 m/s\", \"0 m/s\", \"0 m/s\"]");
  if (face.type == BoundaryType::moving_wall && !face.state.velocity)
    found.error(key + ".velocity", "a moving wall needs its velocity", "a list of 3 velocities or formulas",
                "velocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]");
  if (face.type == BoundaryType::wave_transmissive && is_incompressible(c))
    found.error(key + ".type", "there is no sound in incompressible flow for a wave-transmissive boundary",
                "\"pressure-outlet\" or \"free-stream\"", "type = \"free-stream\"");
  const bool holds_no_disc =
      face.type == BoundaryType::periodic ||
      (is_incompressible(c) && (face.type == BoundaryType::slip || face.type == BoundaryType::symmetry));
  if (!face.patches.empty() && holds_no_disc)
    found.error(key + ".patch", fmt::format("a face of type \"{}\" holds no disc", word(face.type)),
                "a face of type \"wall\", \"velocity\", \"free-stream\" or \"pressure-outlet\"",
                "type = \"wall\"");
  const bool jet_patch = std::any_of(face.patches.begin(), face.patches.end(),
                                     [](const PatchSpec& p) { return p.type == BoundaryType::jet; });
  if (jet_patch && f != 4)
    found.error(key + ".patch", "an orifice stands in z_min only", "[[boundary.z_min.patch]]",
                "[[boundary.z_min.patch]]");
  if (face.type == BoundaryType::jet || (jet_patch && f == 4)) check_jet_face(c, f, key, found);
  if (c.grid.geometry == Geometry::axisymmetric && f / 2 == 1 && face.type != BoundaryType::wall &&
      face.type != BoundaryType::symmetry)
    found.error(key + ".type", "the faces around the axis are cuts, not boundaries",
                "\"symmetry\" or nothing", "type = \"symmetry\"");
}

/// The keys of a state that are formulas in place or time.
std::vector<std::string> formulas_of(const StateSpec& s) {
  std::vector<std::string> keys;
  const auto look = [&](const char* key, const std::string& text) {
    if (!Expression(text).is_constant() && (keys.empty() || keys.back() != key)) keys.push_back(key);
  };
  if (s.velocity)
    for (const std::string& text : *s.velocity) look("velocity", text);
  if (s.pressure) look("pressure", *s.pressure);
  if (s.density) look("density", *s.density);
  if (s.temperature) look("temperature", *s.temperature);
  if (s.k) look("k", *s.k);
  if (s.epsilon) look("epsilon", *s.epsilon);
  return keys;
}

/// What bodies meet at a face, where one might expect something else.
void check_hold(const Case& c, std::size_t f, const std::string& key, Findings& found) {
  const BoundarySpec& face = c.boundary[f];
  const bool free = std::any_of(c.bodies.begin(), c.bodies.end(),
                                [](const BodySpec& b) { return b.motion == Motion::free && !b.on_belt; });
  if (!free || c.grid.geometry == Geometry::axisymmetric) return;
  const int axis = static_cast<int>(f / 2);
  const double down = (f % 2 ? 1.0 : -1.0) * c.environment.gravity[axis];
  if ((face.type == BoundaryType::slip || face.type == BoundaryType::symmetry) && c.walls.empty() &&
      down > 0.5 * c.environment.gravity.norm())
    found.warning(
        key + ".type",
        fmt::format("bodies fall through a face of type \"{}\": only fluid is held by it", word(face.type)),
        "\"wall\", or a [[wall]] there", "type = \"wall\"");
  const std::vector<std::string> formulas = formulas_of(face.state);
  if (face.type == BoundaryType::moving_wall &&
      std::find(formulas.begin(), formulas.end(), "velocity") != formulas.end())
    found.warning(key + ".velocity",
                  "the wall drags fluid by this formula, but bodies that touch it meet it at rest",
                  "a velocity that is the same everywhere and always");
}

void check_patch(const PatchSpec& patch, const Box& box, std::size_t f, const std::string& key,
                 Findings& found) {
  const int axis = static_cast<int>(f / 2);
  const double plane = f % 2 == 0 ? box.low[axis] : box.high[axis];
  const double size = (box.high - box.low).maxCoeff();
  if (std::abs(patch.centre[axis] - plane) > 1e-6 * size)
    found.error(key + ".centre",
                fmt::format("the centre is not on the face, which is at {} = {}", axis_names[f / 2],
                            format_quantity(plane, Dimension::length)),
                "a centre on the face");
  else if (!box.contains(patch.centre))
    found.error(key + ".centre", "the centre lies outside the box", "a centre on the face");
  if (patch.type == BoundaryType::velocity && !patch.state.velocity)
    found.error(key + ".velocity", "a velocity patch needs its velocity",
                "a list of 3 velocities or formulas", "velocity = [\"0 m/s\", \"0 m/s\", \"200 m/s\"]");
}

}  // namespace

void sense_boundaries(const Case& c, Findings& found) {
  if (c.flow.solver == FlowSolver::none) return;
  const std::optional<Box> box = grid_box(c);
  for (std::size_t f = 0; f < 6; ++f) {
    const std::string key = std::string("boundary.") + face_names[f];
    check_face(c, f, key, found);
    check_hold(c, f, key, found);
    for (std::size_t n = 0; n < c.boundary[f].patches.size() && !is_incompressible(c); ++n)
      for (const std::string& formula : formulas_of(c.boundary[f].patches[n].state))
        found.error(
            fmt::format("{}.patch.{}.{}", key, n, formula),
            "the compressible solvers hold the gas of a patch as it is at the start, the same all over it",
            "a number here, or the formula on the face itself");
    for (std::size_t n = 0; n < c.boundary[f].patches.size() && box; ++n)
      check_patch(c.boundary[f].patches[n], *box, f, fmt::format("{}.patch.{}", key, n), found);
  }
}

}  // namespace ejecta
