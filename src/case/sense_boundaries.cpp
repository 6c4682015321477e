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

/// A face of the box: places all over it, each for the same share of its area (of one radian of it around an
/// axis).
struct FacePlaces {
  std::vector<Vec3> at;
  double share = 0.0;  ///< m2
};

FacePlaces places_on(const Case& c, const Box& box, std::size_t f) {
  constexpr int kAlong = 40;
  const int a = static_cast<int>(f / 2), b = (a + 1) % 3, d = (a + 2) % 3;
  const bool round = c.grid.geometry == Geometry::axisymmetric;
  const Vec3 size = box.high - box.low;
  FacePlaces face;
  double area = round ? 1.0 : size[b] * size[d];
  if (round)
    area = a == 2 ? 0.5 * (std::pow(box.high.x(), 2) - std::pow(box.low.x(), 2)) : box.high.x() * size.z();
  face.share = area / (kAlong * kAlong);
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAlong; ++j) {
      Vec3 x;
      x[a] = f % 2 ? box.high[a] : box.low[a];
      x[b] = box.low[b] + (i + 0.5) / kAlong * size[b];
      x[d] = box.low[d] + (j + 0.5) / kAlong * size[d];
      if (round && a == 2)  // equal areas of rings
        x.x() = std::sqrt(std::pow(box.low.x(), 2) + (i + 0.5) / kAlong * 2.0 * area);
      face.at.push_back(x);
    }
  return face;
}

/// A wall stays where it is: its velocity is along itself.
void check_wall_motion(const Case& c, std::size_t f, const std::string& key, Findings& found) {
  const BoundarySpec& face = c.boundary[f];
  const std::optional<Box> box = grid_box(c);
  if (face.type != BoundaryType::moving_wall || !face.state.velocity || !box) return;
  constexpr double kThrough = 1e-6;  // of its speed: round-off of formulas
  std::array<Expression, 3> velocity;
  for (std::size_t d = 0; d < 3; ++d) velocity[d] = Expression((*face.state.velocity)[d]);
  const FacePlaces places = places_on(c, *box, f);
  for (const double t : {0.0, 0.31 * c.run.end_time, 0.73 * c.run.end_time})
    for (const Vec3& x : places.at) {
      Vec3 v;
      for (int d = 0; d < 3; ++d) v[d] = velocity[static_cast<std::size_t>(d)](x.x(), x.y(), x.z(), t);
      const double through = v[static_cast<int>(f / 2)];
      if (!(std::abs(through) > kThrough * v.norm())) continue;
      return found.error(
          key + ".velocity",
          fmt::format("the wall would move by {:.4g} m/s across itself: a wall stays where it is, and so "
                      "does the air behind it",
                      through),
          fmt::format("no velocity along {}, or a face through which air comes", "xyz"[f / 2]),
          "type = \"velocity\"");
    }
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
  check_wall_motion(c, f, key, found);
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

/// A value of a key of a state.
std::string example_of(const std::string& key) {
  if (key == "pressure") return "\"1 bar absolute\"";
  if (key == "density") return "\"1.2 kg/m3\"";
  if (key == "temperature") return "\"300 K\"";
  return key == "k" ? "\"0.5 m2/s2\"" : "\"10 m2/s3\"";
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

/// The cells of a face that belong to a disc in it are those whose middles it covers.
bool covers_a_cell(const Case& c, const PatchSpec& patch, std::size_t f) {
  const auto b = (f / 2 + 1) % 3, d = (f / 2 + 2) % 3;
  const std::vector<double> across = cell_centres(c.grid.axis[d]);
  for (const double u : cell_centres(c.grid.axis[b]))
    for (const double v : across)
      if (std::hypot(u - patch.centre[static_cast<Eigen::Index>(b)],
                     v - patch.centre[static_cast<Eigen::Index>(d)]) <= patch.radius)
        return true;
  return false;
}

/// The widest of the cells of a face, m: no disc with that radius misses all of their middles.
double widest_around_face(const Case& c, std::size_t f) {
  double widest = 0.0;
  for (const std::size_t a : {(f / 2 + 1) % 3, (f / 2 + 2) % 3})
    widest = std::max(widest, widest_cell(c.grid.axis[a], -1e300, 1e300));
  return widest;
}

void check_patch(const Case& c, const PatchSpec& patch, const Box& box, std::size_t f, const std::string& key,
                 Findings& found) {
  const int axis = static_cast<int>(f / 2);
  const double plane = f % 2 == 0 ? box.low[axis] : box.high[axis];
  const double size = (box.high - box.low).maxCoeff();
  Vec3 on_face = patch.centre.cwiseMax(box.low).cwiseMin(box.high);
  on_face[axis] = plane;
  if (std::abs(patch.centre[axis] - plane) > 1e-6 * size)
    found.error(key + ".centre",
                fmt::format("the centre is not on the face, which is at {} = {}", axis_names[f / 2],
                            format_quantity(plane, Dimension::length)),
                "a centre on the face", place_line("centre", on_face));
  else if (!box.contains(patch.centre))
    found.error(key + ".centre", "the centre lies outside the box", "a centre on the face",
                place_line("centre", on_face));
  else if (c.grid.geometry != Geometry::axisymmetric && !covers_a_cell(c, patch, f))
    found.error(key + ".radius",
                fmt::format("the patch of {:.4g} mm covers the middle of no cell: it is not there",
                            1e3 * patch.radius),
                "a larger patch, or finer cells around it",
                fmt::format("radius = \"{:.3g} mm\"", 1e3 * widest_around_face(c, f)));
  if (patch.type == BoundaryType::velocity && !patch.state.velocity)
    found.error(key + ".velocity", "a velocity patch needs its velocity",
                "a list of 3 velocities or formulas", "velocity = [\"0 m/s\", \"0 m/s\", \"200 m/s\"]");
}

bool is_open(BoundaryType t) {
  return t == BoundaryType::pressure_outlet || t == BoundaryType::wave_transmissive ||
         t == BoundaryType::free_stream || t == BoundaryType::total_pressure;
}

/// What comes in through faces with a velocity leaves through others, or there is an open one: a liquid, and
/// air that is as good as one, cannot be squeezed.
void check_way_out(const Case& c, const Box& box, Findings& found) {
  constexpr double kOff = 0.02;  // of all that flows: places are places, not integrals
  if (!is_incompressible(c)) return;
  double net = 0.0, all = 0.0;
  std::string inflow;
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[f];
    const int a = static_cast<int>(f / 2);
    if (c.grid.geometry == Geometry::axisymmetric && (a == 1 || (f == 0 && box.low.x() == 0.0))) continue;
    const auto speed_of = [&](const StateSpec& s) {
      return s.velocity ? Expression((*s.velocity)[static_cast<std::size_t>(a)]) : Expression();
    };
    const Expression own = speed_of(face.state);
    std::vector<Expression> of_patches;
    for (const PatchSpec& p : face.patches) of_patches.push_back(speed_of(p.state));
    const FacePlaces places = places_on(c, box, f);
    double through = 0.0;
    for (const Vec3& x : places.at) {
      BoundaryType type = face.type;
      const Expression* speed = &own;
      for (std::size_t n = 0; n < of_patches.size(); ++n)
        if ((x - face.patches[n].centre).norm() <= face.patches[n].radius)
          type = face.patches[n].type, speed = &of_patches[n];
      if (is_open(type)) return;
      if (type == BoundaryType::jet) through = -1.0;  // inwards, however much
      if (type == BoundaryType::velocity)
        through += (f % 2 ? 1.0 : -1.0) * places.share * (*speed)(x.x(), x.y(), x.z(), 0.0);
    }
    net += through;
    all += std::abs(through);
    if (through < 0.0 && inflow.empty()) inflow = std::string("boundary.") + face_names[f];
  }
  if (!(std::abs(net) > kOff * all)) return;
  found.error(
      inflow.empty() ? "boundary" : inflow + ".type",
      fmt::format("what {} has no way {}: no face is open", net < 0.0 ? "comes in" : "goes out",
                  net < 0.0 ? "out" : "in"),
      "a face of type \"pressure-outlet\" or \"free-stream\", or velocities of all faces that balance",
      "[boundary.x_max] type = \"pressure-outlet\"");
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
            "a number here, or the formula on the face itself",
            formula == "velocity" ? "velocity = [\"0 m/s\", \"0 m/s\", \"100 m/s\"]"
                                  : formula + " = " + example_of(formula));
    for (std::size_t n = 0; n < c.boundary[f].patches.size() && box; ++n)
      check_patch(c, c.boundary[f].patches[n], *box, f, fmt::format("{}.patch.{}", key, n), found);
  }
  if (box && found.list.empty()) check_way_out(c, *box, found);
}

}  // namespace ejecta
