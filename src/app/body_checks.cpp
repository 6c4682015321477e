#include "app/body_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/flow_model.hpp"
#include "app/grid_walls.hpp"
#include "base/error.hpp"
#include "case/copies.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/schema.hpp"
#include "dem/particles.hpp"
#include "sorter/launch.hpp"

namespace ejecta {
namespace {

constexpr double cells_needed = 4.0, cells_advised = 8.0;  // across the smallest feature (Hager 2014: 8)
constexpr double kTouch = 1e-6;         // of a body: that much it may stick out by rounding
constexpr double kRest = 1e-3;          // likewise into a wall on which it rests (Particles::require_apart)
constexpr double kRounding = 1 - 1e-9;  // of counts of cells
constexpr double kHuge = 1.0;           // m: no particle of a sorter, but a mesh whose units were forgotten

std::string mm(double length) {
  return std::abs(length) < 1.0 ? fmt::format("{:.4g} mm", 1e3 * length) : fmt::format("{:.4g} m", length);
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
                          axis_names[static_cast<std::size_t>(d)], mm(size), mm(room)),
              millimetres ? "a larger [grid] or a smaller body; is the file in mm? Then scale = 0.001"
                          : "a larger [grid] or a smaller body",
              millimetres ? "scale = 0.001" : "");
      return true;
    }
    return false;
  }

  bool outside() {
    const Vec3 low = grid_.lower(), high = grid_.upper();
    if ((at_.array() >= low.array()).all() && (at_.array() <= high.array()).all()) return false;
    const std::string what = spec_.on_belt ? "the body crosses the jet's axis outside the computed box"
                                           : "the body starts outside the computed box";
    const std::string expected = fmt::format("x in {} to {}, y in {} to {}, z in {} to {}", mm(low[0]),
                                             mm(high[0]), mm(low[1]), mm(high[1]), mm(low[2]), mm(high[2]));
    if (spec_.on_belt || body_.motion == Motion::fixed)
      problem(Severity::error, place_key_, what + ": no air would ever reach it", expected);
    else problem(Severity::warning, place_key_, what + ": no air reaches it before it enters", expected);
    return true;
  }

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
    const std::string inside = fmt::format("a place at least {} further in", mm(depth));
    if (lets_air_in(spec) && !goes_on)
      problem(
          Severity::error, place_key_,
          fmt::format("the body sticks {} out of the box through {}, where air flows in", mm(depth), name),
          inside);
    else if (spec_.on_belt && !goes_on)
      problem(
          Severity::error, place_key_,
          fmt::format(
              "the domain is too small for the path: the body sticks {} out of the box through {} where it "
              "crosses the jet's axis",
              mm(depth), name),
          "a larger [grid] or another stand_off");
    else if (wall && !held)
      problem(Severity::error, place_key_,
              fmt::format("the body starts {} inside the wall {}", mm(depth), name), inside);
    else if (!goes_on && !wall)
      problem(Severity::warning, place_key_,
              fmt::format("the body starts {} outside the box through {}: air acts on the part inside alone",
                          mm(depth), name),
              inside);
  }

  void resolved() {
    const Resolution r = resolution_of(grid_, body_, at_);
    const std::string what = resolution_words(r, body_);
    if (r.cells < cells_needed * kRounding)
      problem(Severity::error, key_, what + ": the air's force on it would be wrong",
              fmt::format("at least {}, better {}", cells_needed, cells_advised));
    else if (r.cells < cells_advised * kRounding)
      problem(Severity::warning, key_, what,
              fmt::format("at least {} for results that do not depend on the grid", cells_advised));
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

/// A body from the belt against those that are placed and all walls: all others were compared when the case
/// was read.
void check_belt(const Case& c, const Grid& grid, std::vector<Problem>& found) {
  const auto belt =
      std::find_if(c.bodies.begin(), c.bodies.end(), [](const BodySpec& b) { return b.on_belt; });
  if (!c.launch.enabled || belt == c.bodies.end()) return;
  const int n = static_cast<int>(belt - c.bodies.begin());
  Particles particles = make_particles(c);
  for (const Wall& wall : grid_walls(c, grid, particles)) particles.add(wall);
  if (particles.bodies().size() + particles.walls().size() < 2) return;
  try {
    const Body& body = particles.bodies()[static_cast<std::size_t>(n)];
    const FlightState s = launch_state(c.launch, c.jet.nozzle, c.environment.gravity, 0.0);
    particles.place(n, s.position, body.orientation, s.velocity, body.angular_velocity);
    particles.require_apart();
  } catch (const InputError& e) {
    found.push_back({.key = fmt::format("body.{}.on_belt", n),
                     .what = e.what(),
                     .expected = "bodies that are apart when the run starts"});
  }
}

}  // namespace

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
  const bool smallest = r.width.size <= body.shape.smallest_feature() * (1 + 1e-6);
  if (smallest)
    return fmt::format("{:.1f} cells across the smallest feature ({})", r.cells, mm(r.width.size));
  const Vec3& either = r.width.direction;
  const Vec3 d = (either.sum() < 0.0 ? -1.0 : 1.0) * either + Vec3(0, 0, 0);  // no minus before a nought
  return fmt::format("{:.1f} cells across the {} along ({:.2g}, {:.2g}, {:.2g})", r.cells, mm(r.width.size),
                     d.x(), d.y(), d.z());
}

std::vector<Problem> check_bodies(const Case& c, const Grid& grid, std::span<const Body> bodies) {
  std::vector<Problem> found;
  for (std::size_t n = 0; n < bodies.size(); ++n) BodyCheck(c, grid, bodies[n], n, found).look();
  return found;
}

std::vector<Problem> check_bodies(const Case& original) {
  const bool flows = original.flow.solver != FlowSolver::none;
  const Case c = flows ? with_copies(original) : original;
  std::vector<Problem> found;
  std::vector<Body> bodies;
  const Materials materials(c);
  for (std::size_t n = 0; n < c.bodies.size(); ++n) {
    const BodySpec& spec = c.bodies[n];
    if (!flows && !from_file(spec)) continue;
    try {
      bodies.push_back(make_body(spec, materials, folder_of(c)));
    } catch (const InputError& e) {
      found.push_back({.key = fmt::format("body.{}", n), .what = e.what()});
      continue;
    }
    const double size = 2.0 * bodies.back().shape.bounding_radius();
    if (!flows && size > kHuge && spec.scale == 1.0)
      found.push_back({.key = fmt::format("body.{}", n),
                       .what = fmt::format("the body is {:.3g} m across", size),
                       .expected = "a size in metres; is the file in mm? Then scale = 0.001",
                       .example = "scale = 0.001",
                       .severity = Severity::warning});
  }
  if (!found.empty() || !flows) return found;
  const Grid grid = make_grid(c);
  found = check_bodies(c, grid, bodies);
  if (std::none_of(found.begin(), found.end(),
                   [](const Problem& p) { return p.severity == Severity::error; }))
    check_belt(c, grid, found);
  return found;
}

Case load_checked(const std::string& path, const std::vector<std::string>& overrides,
                  std::vector<Problem>* warnings) {
  return load_case(path, overrides, warnings, [](const Case& c) { return check_bodies(c); });
}

}  // namespace ejecta
