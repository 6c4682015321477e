#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/text.hpp"
#include "case/findings.hpp"
#include "case/schema.hpp"

/// Keys that the user gave and that change nothing: who wrote them meant something. What another model would
/// take (flow.solver, flow.turbulence, contact.law, jet.kind) may stand: one switches between models to
/// compare.
namespace ejecta {
namespace {

using Names = std::vector<std::string_view>;

/// What is asked of one table of the case.
class Idle {
 public:
  Idle(const Case& c, std::string section, Findings& found)
      : case_(c), section_(std::move(section)), found_(found) {}

  bool given(std::string_view key) const { return case_.given.contains(fmt::format("{}.{}", section_, key)); }

  /// Each given one of `names` is an error: `why` it cannot act, and what to do instead.
  void refuse(const Names& names, const std::string& why, const std::string& expected,
              const std::string& example = "") {
    for (const std::string_view name : names)
      if (given(name))
        found_.error(fmt::format("{}.{}", section_, name),
                     fmt::format("`{}` does nothing here: {}", name, why), expected, example);
  }

 private:
  const Case& case_;
  std::string section_;
  Findings& found_;
};

/// Refuses keys, of all those that only some kinds have, that this kind does not take. keys_of(kind): those
/// that it takes.
template <class Kind, class KeysOf>
void refuse_of_other_kinds(Idle& idle, const Names& all, Kind kind, const char* key, const KeysOf& keys_of) {
  const Names taken = keys_of(kind);
  const auto takes = [](const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::vector<std::string> mine(taken.begin(), taken.end());
  for (const std::string_view name : all) {
    if (takes(taken, name)) continue;
    std::string example;
    for (std::size_t n = words(kind).size(); n-- > 0;)
      if (takes(keys_of(static_cast<Kind>(n)), name))
        example = fmt::format("{} = \"{}\"", key, words(kind)[n].name);
    idle.refuse({name}, fmt::format("{} is \"{}\"", key, word(kind)),
                mine.empty() ? fmt::format("no `{}`, or another {}", name, key)
                             : fmt::format("no `{}`, or another {}; \"{}\" takes {}", name, key, word(kind),
                                           joined(mine)),
                example.empty() ? "fit_error = \"0 mm\"" : example);  // the one key that parts a kind in two
  }
}

Names shape_keys(const BodySpec& b) {
  switch (b.shape) {
    case ShapeKind::sphere:
      return {"diameter"};
    case ShapeKind::box:
      return {"size"};
    case ShapeKind::superquadric:
      return {"size", "exponents"};
    case ShapeKind::cluster:
      return {"size", "cluster", "sphere_diameter", "true_box_mass"};
    case ShapeKind::multisphere:
      if (b.fit_error > 0.0) return {"file", "fit_error", "scale"};
      return {"spheres", "fit_error"};
    case ShapeKind::polyhedron:
      return {"vertices"};
    case ShapeKind::mesh:
      return {"file", "files", "fit_error", "scale"};
  }
  return {};
}

void look_at_body(const BodySpec& b, Idle idle) {
  refuse_of_other_kinds(idle,
                        {"diameter", "size", "spheres", "cluster", "sphere_diameter", "vertices", "file",
                         "files", "fit_error", "scale", "exponents", "true_box_mass"},
                        b.shape, "shape", [&](ShapeKind shape) {
                          BodySpec other = b;
                          other.shape = shape;
                          return shape_keys(other);
                        });
  if (b.on_belt) {
    idle.refuse({"position"}, "[launch] says where a body from the belt is",
                "`along` and `across`, or `behind` and `gap`, in this [[body]]; or no on_belt",
                "along = \"-26 mm\"");
    idle.refuse({"velocity"}, "[launch] says how fast a body from the belt is",
                "launch.belt_speed, or no on_belt", "[launch] belt_speed = \"3 m/s\"");
    idle.refuse({"release_at", "enters_at"}, "[launch] says when a body from the belt comes",
                "launch.arrives_at, or no on_belt", "[launch] arrives_at = \"4 ms\"");
  } else {
    idle.refuse({"along", "across", "behind", "gap"}, "the body does not come from the belt",
                "on_belt = true, or `position`", "on_belt = true");
  }
  if (!b.behind.empty())
    idle.refuse({"along"}, "`behind` and `gap` say where the body lies along the belt", "either of the two",
                "gap = \"12 mm\"");
  else
    idle.refuse({"gap"}, "it is not said to which body", "behind = \"name of the body ahead\"",
                "behind = \"cube\"");
  if (b.mass)
    idle.refuse({"density", "true_box_mass"}, "`mass` is given", "either of the two", "mass = \"2.7 g\"");
  if (b.motion == Motion::fixed)
    idle.refuse({"velocity", "spin", "release_at"}, "motion is \"fixed\"",
                "motion = \"free\" or \"prescribed\"", "motion = \"prescribed\"");
  if (b.copies == 1) idle.refuse({"every"}, "there is one body", "copies, or no `every`", "copies = 10");
  if (b.random_rotation)
    idle.refuse({"rotation_axis", "rotation_angle"}, "random_rotation turns the body at random",
                "either of the two", "random_rotation = false");
  else if (!idle.given("rotation_angle") && b.path.empty())
    idle.refuse({"rotation_axis"}, "no angle is given", "rotation_angle beside it",
                "rotation_angle = \"45 deg\"");
}

Names wall_keys(WallKind kind) {
  switch (kind) {
    case WallKind::plane:
      return {"normal"};
    case WallKind::plate:
    case WallKind::belt:
      return {"normal", "size"};
    case WallKind::box:
      return {"size", "rotation_axis", "rotation_angle"};
    case WallKind::mesh:
      return {"file", "scale", "rotation_axis", "rotation_angle", "two_sided"};
  }
  return {};
}

void look_at_wall(const WallSpec& w, Idle idle) {
  refuse_of_other_kinds(idle,
                        {"normal", "size", "file", "scale", "rotation_axis", "rotation_angle", "two_sided"},
                        w.kind, "kind", wall_keys);
  if (!idle.given("rotation_angle"))
    idle.refuse({"rotation_axis"}, "no angle is given", "rotation_angle beside it",
                "rotation_angle = \"45 deg\"");
}

/// Of a face or of a disc in it.
void look_at_inflow(const Case& c, BoundaryType type, bool patches, Idle idle) {
  const bool incompressible = c.flow.solver == FlowSolver::incompressible;
  const auto because = [&] { return fmt::format("a face of type \"{}\" does not take it", word(type)); };
  const bool moves =
      type == BoundaryType::velocity || type == BoundaryType::moving_wall ||
      (!incompressible && (type == BoundaryType::free_stream || type == BoundaryType::wave_transmissive ||
                           type == BoundaryType::pressure_outlet));
  if (!moves)
    idle.refuse({"velocity"}, because(),
                type == BoundaryType::wall ? "type = \"moving-wall\" or \"velocity\"" : "type = \"velocity\"",
                type == BoundaryType::wall ? "type = \"moving-wall\"" : "type = \"velocity\"");
  if (type != BoundaryType::total_pressure)
    idle.refuse({"total_pressure", "total_temperature"}, because(), "type = \"total-pressure\"",
                "type = \"total-pressure\"");
  const bool closed = type == BoundaryType::wall || type == BoundaryType::moving_wall ||
                      type == BoundaryType::slip || type == BoundaryType::symmetry ||
                      type == BoundaryType::periodic || type == BoundaryType::jet;
  if (closed && !patches)
    idle.refuse({"pressure", "density", "k", "epsilon"}, because(), "no such key, or an open face",
                "type = \"pressure-outlet\"");
  if (closed && !patches && !(type == BoundaryType::wall || type == BoundaryType::moving_wall))
    idle.refuse({"temperature"}, because(), "no such key, or an open face", "type = \"pressure-outlet\"");
}

void look_at_valve(const ValveSpec& v, Idle idle) {
  if (v.shape == ValveShape::trace)
    idle.refuse({"rise_time", "fall_time"}, "the trace says how the valve opens", "either of the two",
                "shape = \"smooth\"");
  else
    idle.refuse({"trace"}, fmt::format("shape is \"{}\"", word(v.shape)), "shape = \"trace\"",
                "shape = \"trace\"");
}

void look_at_plate(const SplitterSpec& s, Idle idle) {
  if (s.edge)
    idle.refuse({"distance", "height"}, "`edge` says where the plate is",
                "either edge (fixed to the machine), or distance and height (above the undisturbed path)",
                "edge = [\"250 mm\", \"60 mm\"]");
}

/// Whether a key, of those that some model takes, is one that this case's models leave aside.
bool is_left_aside(const Case& c, std::string_view key) {
  const auto in = [&](const Names& tables) {
    return std::any_of(tables.begin(), tables.end(), [&](std::string_view t) { return key.starts_with(t); });
  };
  const auto is = [&](const Names& names) {
    return std::find(names.begin(), names.end(), key.substr(key.rfind('.') + 1)) != names.end();
  };
  if (c.flow.solver == FlowSolver::none)
    return in({"grid.", "boundary.", "initial.", "fluid.", "jet.", "valve.", "flow."}) &&
           key != "flow.solver" && !c.sorter.enabled;
  const bool of_a_state = in({"boundary.", "initial."});
  if (c.flow.solver == FlowSolver::incompressible &&
      ((of_a_state && is({"temperature", "density"})) || key == "flow.compressibility_correction"))
    return true;
  return c.flow.turbulence == TurbulenceModel::laminar &&
         ((of_a_state && is({"k", "epsilon"})) || key == "flow.round_jet_correction" ||
          key == "flow.compressibility_correction");
}

/// They may stand, for one switches between models to compare; but nobody is to believe that they act.
void tell_what_is_left_aside(const Case& c, Findings& found) {
  std::vector<std::string> keys;
  for (const std::string& key : c.given)
    if (is_left_aside(c, key)) keys.push_back(key);
  if (keys.empty()) return;
  constexpr std::size_t kMost = 6;
  const std::size_t more = keys.size() > kMost ? keys.size() - kMost : 0;
  const std::string first = keys.front();
  keys.resize(keys.size() - more);
  for (std::string& key : keys) key = fmt::format("`{}`", key);
  found.warning(first,
                fmt::format("{}{} {} nothing with flow.solver \"{}\"{}", joined(keys),
                            more > 0 ? fmt::format(" and {} more", more) : "",
                            keys.size() + more == 1 ? "does" : "do", word(c.flow.solver),
                            c.flow.solver == FlowSolver::none
                                ? ""
                                : fmt::format(" and flow.turbulence \"{}\"", word(c.flow.turbulence))));
}

/// Nothing sets the fluid in motion, and no body moves in it.
bool is_still(const Case& c) {
  const auto given = [](const StateSpec& s) {
    return s.velocity || s.pressure || s.density || s.temperature;
  };
  const auto drives = [&](const BoundarySpec& face) {
    return given(face.state) || !face.patches.empty() || face.type == BoundaryType::total_pressure ||
           face.type == BoundaryType::jet || face.type == BoundaryType::moving_wall;
  };
  return std::none_of(c.boundary.begin(), c.boundary.end(), drives) && c.initial.empty() &&
         c.flow.body_force.isZero() && c.grains.empty() &&
         std::all_of(c.bodies.begin(), c.bodies.end(),
                     [](const BodySpec& b) { return b.motion == Motion::fixed; });
}

/// The face through which a stream of this velocity comes in.
const char* face_upstream(const Vec3& velocity) {
  int axis = 0;
  velocity.cwiseAbs().maxCoeff(&axis);
  return face_names[static_cast<std::size_t>(2 * axis + (velocity[axis] < 0.0))];
}

}  // namespace

void sense_idle(const Case& c, Findings& found) {
  tell_what_is_left_aside(c, found);
  const auto table = [&](const std::string& name) { return Idle(c, name, found); };
  for (std::size_t n = 0; n < c.bodies.size(); ++n)
    look_at_body(c.bodies[n], table(fmt::format("body.{}", n)));
  for (std::size_t n = 0; n < c.bodies.size() && !c.splitter.enabled; ++n)
    table(fmt::format("body.{}", n))
        .refuse({"wanted"}, "there is no plate to be wanted on a side of", "[splitter]",
                "[splitter] distance = \"250 mm\"");
  if (c.study.design == StudyDesign::grid || c.study.design == StudyDesign::list)
    table("study").refuse({"samples"}, fmt::format("design is \"{}\"", word(c.study.design)),
                          "a design that is drawn, or no samples", "design = \"latin-hypercube\"");
  for (std::size_t n = 0; n < c.walls.size(); ++n) look_at_wall(c.walls[n], table(fmt::format("wall.{}", n)));
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[f];
    const std::string name = std::string("boundary.") + face_names[f];
    look_at_inflow(c, face.type, !face.patches.empty(), table(name));
    for (std::size_t n = 0; n < face.patches.size(); ++n)
      look_at_inflow(c, face.patches[n].type, false, table(fmt::format("{}.patch.{}", name, n)));
  }
  look_at_valve(c.valve, table("valve"));
  look_at_plate(c.splitter, table("splitter"));
  if (c.flow.solver == FlowSolver::none && c.stream.enabled)
    found.error("stream", "[stream] does nothing here: nothing flows, solver is \"none\"",
                "a flow solver, or no [stream]", "[flow] solver = \"incompressible\"");
  if (c.flow.solver != FlowSolver::none && !c.stream.velocity.isZero() && is_still(c))
    found.error(
        "stream.velocity",
        "[stream] only says what drag coefficients refer to, and nothing in this case moves: no velocity "
        "on a boundary or at first, no pressure, no force, no body",
        "the stream on the face where it comes in, or at first",
        fmt::format("[boundary.{}] type = \"velocity\", velocity = [\"{:g} m/s\", \"{:g} m/s\", \"{:g} "
                    "m/s\"]",
                    face_upstream(c.stream.velocity), c.stream.velocity.x(), c.stream.velocity.y(),
                    c.stream.velocity.z()));
  if (c.grains.empty())
    table("coupling")
        .refuse({"drag", "exchange", "kernel_width", "dispersion"}, "there are no [[grains]]",
                "[[grains]], or no [coupling]", "[[grains]] size = \"0.1 mm\"");
  if (!(c.manifold.vessel > 0.0))
    table("sorter.manifold")
        .refuse({"line_diameter"}, "there is no vessel that it feeds", "vessel beside it",
                "vessel = \"20 L\"");
  for (std::size_t n = 0; n < c.classes.size(); ++n)
    if (c.classes[n].form == ParticleForm::sphere)
      table(fmt::format("sorter.class.{}", n))
          .refuse({"elongation", "flatness"}, "form is \"sphere\"", "another form", "form = \"rock\"");
  if (c.output.fields_interval == 0.0)
    table("output").refuse({"fields"}, "no fields are written", "fields_interval beside it",
                           "fields_interval = \"1 ms\"");
  if (c.contact.time_step)
    table("contact").refuse({"time_step_fraction"}, "time_step is given", "either of the two",
                            "time_step = \"1 us\"");
}

}  // namespace ejecta
