#include "simulation/body_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "case/copies.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/schema.hpp"
#include "flow/model/flow_model.hpp"
#include "jet/computed.hpp"
#include "jet/measured.hpp"
#include "jet/model.hpp"
#include "jet/source.hpp"
#include "jet/valve.hpp"
#include "shape/stl.hpp"
#include "simulation/prospect.hpp"
#include "simulation/scene.hpp"
#include "sorter/feed.hpp"

namespace ejecta {
namespace {

constexpr double kCellsNeeded = 4.0, kCellsAdvised = 8.0;  // across the smallest feature (Hager 2014: 8)
constexpr double kTouch = 1e-6;         // of a body: that much it may stick out by rounding
constexpr double kRest = 1e-3;          // likewise into a wall on which it rests (Particles::require_apart)
constexpr double kRounding = 1 - 1e-9;  // of counts of cells
// No particle of a sorter, but units that were forgotten:
constexpr double kHuge = 1.0, kTiny = 1e-6;              // m across
constexpr double kHugeWall = 20.0;                       // m across
constexpr double kHeavy = 100.0;                         // kg
constexpr double kLightest = 10.0, kHeaviest = 23000.0;  // kg/m3; foam and osmium lie in between

std::string mm_or_m(double length) {
  return std::abs(length) < 1.0 ? fmt::format("{:.4g} mm", 1e3 * length) : fmt::format("{:.4g} m", length);
}

/// The key that names the surface of a body, behind "body.0".
constexpr const char* kFileExample = "file = \"lump.stl\"";
constexpr const char* kClosedSurface = "a closed surface as STL, text or binary, whose normals look outwards";

std::string file_key(const BodySpec& b) {
  return !b.files.empty() ? ".files" : !b.file.empty() ? ".file" : "";
}

bool from_file(const BodySpec& b) { return !b.file.empty() || !b.files.empty(); }

/// Collects what is wrong with one body.
class BodyCheck {
 public:
  BodyCheck(const Case& c, const Grid& grid, const Body& body, std::size_t n, std::vector<Problem>& found)
      : case_(c),
        grid_(grid),
        body_(body),
        spec_(c.bodies[n]),
        found_(found),
        key_(fmt::format("body.{}", n)),
        place_key_(spec_.on_belt ? "launch.stand_off" : key_ + ".position"),
        at_(spec_.on_belt ? place_of_interest(c, spec_) : body.position),
        reach_(reach_of(body)) {}

  void look() {
    if (too_large() || outside()) return;
    for (int face = 0; face < 6; ++face) sticking_out(face);
    resolved();
  }

 private:
  void problem(Severity severity, const std::string& key, const std::string& what,
               const std::string& expected, const std::string& example = "") {
    found_.push_back(
        {.key = key, .what = what, .expected = expected, .example = example, .severity = severity});
  }

  bool too_large() {
    for (int d = 0; d < 3; ++d) {
      const double size = reach_.high[d] - reach_.low[d], room = grid_.axis(d).length();
      if (!grid_.active(d) || size <= room * (1 + kTouch)) continue;
      const bool millimetres = from_file(spec_) && spec_.scale == 1.0 && 1e-3 * size <= room;
      problem(Severity::error, key_,
              fmt::format("the body is larger than the box along {}: {} in {}",
                          axis_names[static_cast<std::size_t>(d)], mm_or_m(size), mm_or_m(room)),
              millimetres ? "a larger [grid] or a smaller body; is the file in mm? Then scale = 0.001"
                          : "a larger [grid] or a smaller body",
              millimetres ? "scale = 0.001"
                          : fmt::format("[grid.{0}] points = [\"-{1}\", \"{1}\"]",
                                        axis_names[static_cast<std::size_t>(d)], mm_or_m(size)));
      return true;
    }
    return false;
  }

  bool outside() {
    const Vec3 low = grid_.lower(), high = grid_.upper();
    if ((at_.array() >= low.array()).all() && (at_.array() <= high.array()).all()) return false;
    const std::string what = spec_.on_belt ? "the body crosses the jet's axis outside the computed box"
                                           : "the body starts outside the computed box";
    const std::string expected =
        fmt::format("x in {} to {}, y in {} to {}, z in {} to {}", mm_or_m(low[0]), mm_or_m(high[0]),
                    mm_or_m(low[1]), mm_or_m(high[1]), mm_or_m(low[2]), mm_or_m(high[2]));
    const bool beside = at_.y() < low.y() || at_.y() > high.y();
    if (spec_.on_belt && beside)
      problem(Severity::error, across_key(), what + ": no air would ever reach it", expected,
              placed(Vec3(at_.x(), 0.5 * (low + high).y(), at_.z())));
    else if (spec_.on_belt || body_.motion == Motion::fixed)
      problem(
          Severity::error, place_key_, what + ": no air would ever reach it", expected,
          placed(spec_.on_belt ? Vec3(at_.x(), at_.y(), 0.5 * (low + high).z()) : Vec3(0.5 * (low + high))));
    else
      problem(Severity::warning, place_key_, what + ": no air reaches it before it enters", expected,
              placed(0.5 * (low + high)));
    return true;
  }

  /// A line that brings the body there, on its path as it crosses the jet's axis.
  std::string placed(const Vec3& place) const {
    if (!spec_.on_belt) return place_line("position", place);
    const Vec3 moved = place - at_;
    if (moved.y() == 0.0)
      return fmt::format("stand_off = \"{}\"", mm_or_m(case_.launch.stand_off + moved.z()));
    return spec_.across != 0.0
               ? fmt::format("across = \"{}\"", mm_or_m(spec_.across + moved.y()))
               : fmt::format("offset_across = \"{}\"", mm_or_m(case_.launch.offset_across + moved.y()));
  }

  std::string across_key() const { return spec_.across != 0.0 ? key_ + ".across" : "launch.offset_across"; }

  bool lets_air_in(const BoundarySpec& face) const {
    const auto blows = [](BoundaryType t) {
      return t == BoundaryType::velocity || t == BoundaryType::jet || t == BoundaryType::total_pressure;
    };
    return blows(face.type) || std::any_of(face.patches.begin(), face.patches.end(), [&](const PatchSpec& p) {
             return blows(p.type) && (p.centre - at_).norm() < p.radius + body_.shape.bounding_radius();
           });
  }

  void sticking_out(int face) {
    const int d = face / 2;
    if (!grid_.active(d)) return;
    const double depth =
        face % 2 ? at_[d] + reach_.high[d] - grid_.upper()[d] : grid_.lower()[d] - at_[d] - reach_.low[d];
    if (!(depth > kTouch * body_.shape.bounding_radius())) return;
    const BoundarySpec& spec = case_.boundary[static_cast<std::size_t>(face)];
    const std::string name = face_names[static_cast<std::size_t>(face)];
    const bool goes_on = spec.type == BoundaryType::symmetry || spec.type == BoundaryType::slip ||
                         spec.type == BoundaryType::periodic;
    const bool wall = spec.type == BoundaryType::wall || spec.type == BoundaryType::moving_wall;
    const bool held = body_.motion != Motion::free;
    if (wall && depth <= kRest * body_.shape.bounding_radius()) return;
    const std::string inside = fmt::format("a place at least {} further in", mm_or_m(depth));
    const std::string example = placed(at_ + (face % 2 ? -1.0 : 1.0) * depth * Vec3::Unit(d));
    if (lets_air_in(spec) && !goes_on)
      problem(Severity::error, place_key_,
              fmt::format("the body sticks {} out of the box through {}, where air flows in", mm_or_m(depth),
                          name),
              inside, example);
    else if (spec_.on_belt && !goes_on)
      problem(
          Severity::error, d != 1 ? place_key_ : across_key(),
          fmt::format(
              "the domain is too small for the path: the body sticks {} out of the box through {} where it "
              "crosses the jet's axis",
              mm_or_m(depth), name),
          "a larger [grid] or a path nearer to the jet", example);
    else if (wall && !held)
      problem(Severity::error, place_key_,
              fmt::format("the body starts {} inside the wall {}", mm_or_m(depth), name), inside, example);
    else if (!goes_on && !wall)
      problem(Severity::warning, place_key_,
              fmt::format("the body starts {} outside the box through {}: air acts on the part inside alone",
                          mm_or_m(depth), name),
              inside, example);
  }

  void resolved() {
    const Resolution r = resolution_of(grid_, body_, at_);
    const std::string what = resolution_words(r, body_);
    const std::string finer =
        fmt::format("[grid] refinement = {:.1f}", case_.grid.refined * kCellsAdvised / r.cells + 0.05);
    if (r.cells < kCellsNeeded * kRounding)
      problem(Severity::error, key_, what + ": the air's force on it would be wrong",
              fmt::format("at least {}, better {}", kCellsNeeded, kCellsAdvised), finer);
    else if (r.cells < kCellsAdvised * kRounding)
      problem(Severity::warning, key_, what,
              fmt::format("at least {} for results that do not depend on the grid", kCellsAdvised), finer);
  }

  const Case& case_;
  const Grid& grid_;
  const Body& body_;
  const BodySpec& spec_;
  std::vector<Problem>& found_;
  const std::string key_, place_key_;
  const Vec3 at_;
  const Reach reach_;
};

/// Largest width of the cells of an axis that touch [from, to], or the nearest cell's, m.
double widest_around(const Axis& axis, double from, double to) {
  double widest = 0.0;
  for (int i = axis.cell_at(from); i <= axis.cell_at(to); ++i)
    widest = std::max(widest, axis.width[static_cast<std::size_t>(i)]);
  return widest;
}

/// What setting up the bodies of a run refused is about a body, a wall, grains or the contact: the key by the
/// name in the message.
void add_refusal(const Case& c, const InputError& refusal, std::vector<Problem>& found) {
  const std::string what = refusal.what();
  const auto in = [&](const std::string& section, const std::string& or_key) {
    const std::string& key = refusal.advice.key.empty() ? or_key : refusal.advice.key;
    return key.empty() ? section : section + "." + key;
  };
  std::string key = in("contact", "");
  for (std::size_t n = 0; n < c.walls.size(); ++n)
    if (what.starts_with(fmt::format("wall \"{}\"", c.walls[n].name)))
      key = in(fmt::format("wall.{}", n), c.walls[n].kind == WallKind::mesh ? "file" : "");
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (what.starts_with(fmt::format("grains \"{}\"", c.grains[n].name)))
      key = in(fmt::format("grains.{}", n), "");
  // Of two bodies, the one whose place is the harder to see: that from the belt.
  for (const bool on_belt : {false, true})
    for (std::size_t n = c.bodies.size(); n-- > 0;)
      if (c.bodies[n].on_belt == on_belt && refusal.advice.key.empty() &&
          what.find(fmt::format("body \"{}\"", c.bodies[n].name)) != std::string::npos)
        key = fmt::format("body.{}.{}", n, on_belt ? "on_belt" : "position");
  if (refusal.advice.key == "splitter") key = "splitter";
  if (what.starts_with("domain")) key = in("domain", "");
  for (std::size_t n = 0; n < c.materials.size(); ++n)
    if (what.starts_with(fmt::format("material \"{}\"", c.materials[n].name)))
      key = in(fmt::format("material.{}", n), "");
  const bool file = refusal.advice.expected.empty() && key.ends_with(".file");
  found.push_back({.key = key,
                   .what = what,
                   .expected = file ? "a surface as STL, text or binary" : refusal.advice.expected,
                   .example = file ? kFileExample
                              : key.ends_with(".on_belt")
                                  ? "behind = \"name of the body ahead\", gap = \"12 mm\""
                                  : refusal.advice.example});
}

/// Valve traces and measured curves that cannot be read.
void check_tables(const Case& c, std::vector<Problem>& found) {
  const auto named = [&](const std::string& key, const auto& read) {
    const std::size_t before = found.size();
    read();
    for (std::size_t n = before; n < found.size(); ++n) found[n].key = key;
  };
  if (c.valve.shape == ValveShape::trace)
    named("valve.trace", [&] { read_valve_trace(beside_case(c, c.valve.trace), found); });
  for (std::size_t n = 0; n < c.measured.size(); ++n) {
    const MeasuredSpec& m = c.measured[n];
    const bool probe =
        std::any_of(c.probes.begin(), c.probes.end(), [&](const ProbeSpec& p) { return p.name == m.of; });
    named(fmt::format("measured.{}.file", n),
          [&] { read_measured(beside_case(c, m.file), probe ? Dimension::time : Dimension::length, found); });
  }
}

/// The case that is to compute the jet.
void check_source_case(const Case& c, std::vector<Problem>& found) {
  if (c.flow.solver == FlowSolver::none || !has_jet(c) || c.jet.kind != JetKind::computed) return;
  try {
    require_jet_case(computed_jet_case(c));
  } catch (const InputError& e) {
    const std::string all = e.what();
    const std::size_t end = std::min(all.find('\n'), all.size());
    found.push_back({.key = "jet.source_case",
                     .what = all.substr(0, end),
                     .expected = "the case of a jet that blows from the orifice of this valve",
                     .example = "source_case = \"jet-700kPa.toml\""});
  }
}

/// Whether what falls on an open surface falls through.
bool looks_down(const Surface& surface, const Vec3& gravity) {
  if (surface.closed() || surface.two_sided()) return false;
  Vec3 sum(0, 0, 0);
  double area = 0.0;
  for (const Surface::Triangle& t : surface.triangles()) {
    const double twice = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
    sum += twice * t.normal;
    area += twice;
  }
  return sum.dot(gravity) > 0.3 * area * gravity.norm();
}

/// A surface of a wall whose file has other units, or which bodies meet on the wrong side.
void ask_about_walls(const Case& c, std::span<const Wall> walls, std::vector<Problem>& found) {
  for (std::size_t n = 0; n < c.walls.size(); ++n) {
    const WallSpec& w = c.walls[n];
    if (w.kind != WallKind::mesh) continue;
    if (looks_down(*walls[n].surface, c.environment.gravity))
      found.push_back(
          {.key = fmt::format("wall.{}.file", n),
           .what = "the surface is open and its normals look down: what falls on it falls through",
           .expected = "triangles that turn the other way, or both sides of it",
           .example = "two_sided = true",
           .severity = Severity::warning});
    const double across = extent_of(read_stl(beside_case(c, w.file), w.scale)).norm();
    if (w.scale == 1.0 && across > kHugeWall)
      found.push_back({.key = fmt::format("wall.{}.file", n),
                       .what = fmt::format("the wall is {} across", mm_or_m(across)),
                       .expected = "a size in metres; is the file in mm? Then scale = 0.001",
                       .example = "scale = 0.001",
                       .severity = Severity::warning});
  }
}

/// Of a case that cannot be set up as a whole: each body by itself, and what is wrong with it.
std::vector<Body> bodies_one_by_one(const Case& c, std::vector<Problem>& found) {
  std::vector<Body> bodies;
  try {
    const Materials materials(c);
    for (std::size_t n = 0; n < c.bodies.size(); ++n) {
      try {
        bodies.push_back(make_body(c.bodies[n], materials, folder_of(c)));
      } catch (const InputError& e) {
        const Advice& a = e.advice;
        const bool file = a.expected.empty() && from_file(c.bodies[n]);
        found.push_back(
            {.key = fmt::format("body.{}{}", n, a.key.empty() ? file_key(c.bodies[n]) : "." + a.key),
             .what = e.what(),
             .expected = file ? kClosedSurface : a.expected,
             .example = file ? kFileExample : a.example});
      }
    }
  } catch (const InputError& e) {
    add_refusal(c, e, found);
  }
  return bodies;
}

/// Sizes and masses that no particle of a sorter has: units forgotten, a point taken for a comma.
void ask_about_size(const BodySpec& spec, const Body& body, std::size_t n, bool flows,
                    std::vector<Problem>& found) {
  const auto ask = [&](const std::string& key, const std::string& what, const std::string& expected,
                       const std::string& example) {
    found.push_back(
        {.key = key, .what = what, .expected = expected, .example = example, .severity = Severity::warning});
  };
  const std::string key = fmt::format("body.{}", n);
  const double size = 2.0 * body.shape.bounding_radius();
  const bool asked = !found.empty();  // once is enough: a case of boulders has many
  const std::string mass =
      fmt::format(" and weighs {}", body.mass < 1.0 ? fmt::format("{:.3g} g", 1e3 * body.mass)
                                                    : fmt::format("{:.4g} kg", body.mass));
  if (from_file(spec) && spec.scale == 1.0 && size > kHuge && !flows)
    ask(key, fmt::format("the body is {:.3g} m across{}", size, mass),
        "a size in metres; is the file in mm? Then scale = 0.001", "scale = 0.001");
  else if (from_file(spec) && size < kTiny)
    ask(key + ".scale", fmt::format("the body is {:.3g} um across", 1e6 * size),
        "is the file in metres already? Then scale = 1", "scale = 1");
  else if (body.motion == Motion::free && body.mass > kHeavy && !asked)
    ask(spec.mass      ? key + ".mass"
        : spec.density ? key + ".density"
                       : key,
        fmt::format("the body is {} across{}", mm_or_m(size), mass),
        "grams rather than tonnes? See its size and density", "density = \"2700 kg/m3\"");
  if (body.motion != Motion::free) return;
  const double density = body.mass / body.shape.mass_properties().volume;
  if (density < kLightest || density > kHeaviest)
    ask(spec.mass      ? key + ".mass"
        : spec.density ? key + ".density"
                       : key + ".material",
        fmt::format("the body has a density of {:.4g} kg/m3{}", density,
                    density < kLightest ? ", less than a foam's: a point that parts thousands?"
                                        : ", more than any metal's"),
        "that of the material", "density = \"2700 kg/m3\"");
}

}  // namespace

Vec3 extent_of(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return high - low;
}

Vec3 body_size(const Body& body) {
  Vec3 size;
  for (int d = 0; d < 3; ++d) {
    const Vec3 along = Vec3::Unit(d);
    size[d] = along.dot(body.shape.support(along)) - along.dot(body.shape.support(-along));
  }
  return size;
}

Reach reach_of(const Body& body) {
  Reach reach;
  for (int d = 0; d < 3; ++d) {
    const Vec3 along = body.orientation.conjugate() * Vec3::Unit(d);
    reach.high[d] = along.dot(body.shape.support(along));
    reach.low[d] = along.dot(body.shape.support(-along));
  }
  return reach;
}

/// Across a direction aslant lie as many cells as if their edge were the root mean square of the three, with
/// the direction's shares: the edge itself where the three are alike.
Resolution resolution_of(const Grid& grid, const Body& body, const Vec3& place) {
  const Reach reach = reach_of(body);
  Vec3 cell{0, 0, 0};  // a direction of one cell resolves nothing and need not
  for (int d = 0; d < 3; ++d)
    if (grid.active(d))
      cell[d] = widest_around(grid.axis(d), place[d] + reach.low[d], place[d] + reach.high[d]);
  Resolution worst;
  for (const Width& w : body.shape.widths()) {
    const Vec3 direction = body.orientation * w.direction;
    const double edge = direction.isZero() ? cell.maxCoeff() : direction.cwiseProduct(cell).norm();
    if (!(w.size < worst.cells * edge)) continue;
    worst = {w.size / edge, {direction, w.size}};
  }
  return worst;
}

std::string resolution_words(const Resolution& r, const Body& body) {
  const double cells = std::floor(10 * r.cells + 1e-6) / 10;  // 3.98 are not the 4.0 that are asked for
  const bool smallest = r.width.size <= body.shape.smallest_feature() * (1 + 1e-6);
  if (smallest)
    return fmt::format("{:.1f} cells across the smallest feature ({})", cells, mm_or_m(r.width.size));
  const Vec3& either = r.width.direction;
  const Vec3 d = (either.sum() < 0.0 ? -1.0 : 1.0) * either + Vec3(0, 0, 0);  // no minus before a nought
  return fmt::format("{:.1f} cells across the {} along ({:.2g}, {:.2g}, {:.2g})", cells,
                     mm_or_m(r.width.size), d.x(), d.y(), d.z());
}

std::vector<Problem> check_bodies(const Case& c, const Grid& grid, std::span<const Body> bodies) {
  std::vector<Problem> found;
  for (std::size_t n = 0; n < bodies.size(); ++n) BodyCheck(c, grid, bodies[n], n, found).look();
  return found;
}

std::vector<Problem> check_bodies(const Case& original, std::optional<Scene>* set_up) {
  const bool flows = original.flow.solver != FlowSolver::none;
  const Case c = with_first_copies(original);
  std::vector<Problem> found;
  const auto failed = [&] {
    return std::any_of(found.begin(), found.end(),
                       [](const Problem& p) { return p.severity == Severity::error; });
  };
  std::optional<Grid> grid;
  if (flows) grid.emplace(make_grid(c));
  std::optional<Scene> scene;
  std::optional<InputError> refusal;
  std::vector<Body> bodies;
  try {  // first of all, and once: surfaces may take seconds to divide
    scene.emplace(make_scene(c, grid ? &*grid : nullptr));
    bodies = company_of(*scene).bodies;
  } catch (const InputError& e) {
    refusal = e;
    bodies = bodies_one_by_one(c, found);
  }
  if (failed()) return found;
  for (std::size_t n = 0; n < bodies.size(); ++n) ask_about_size(c.bodies[n], bodies[n], n, flows, found);
  if (grid) {
    const auto more = check_bodies(c, *grid, bodies);
    found.insert(found.end(), more.begin(), more.end());
  }
  check_tables(c, found);
  check_source_case(c, found);
  if (failed()) return found;
  if (!scene) {
    add_refusal(c, *refusal, found);
    return found;
  }
  ask_about_walls(c, scene->particles.walls(), found);  // those of the case stand first
  const auto more = check_prospects(c, company_of(*scene), scene->splitter ? &*scene->splitter : nullptr);
  found.insert(found.end(), more.begin(), more.end());
  if (set_up) *set_up = std::move(scene);
  return found;
}

std::vector<Problem> check_set_up(const Case& c, std::optional<Scene>* scene) {
  if (c.campaign.enabled) return {};  // only its parts have bodies
  std::vector<Problem> found = check_bodies(c, scene);
  if (c.sorter.enabled) {
    const std::vector<Problem> more = check_feed(c);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

Case load_checked(const std::string& path, const std::vector<std::string>& overrides,
                  std::vector<Problem>* warnings, std::optional<Scene>* scene) {
  return load_case(path, overrides, warnings, [scene](const Case& c) { return check_set_up(c, scene); });
}

}  // namespace ejecta
