#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/required_file.hpp"
#include "case/size_law.hpp"
#include "case/words.hpp"

/// [sorter]: whether it is a whole machine, and one that can work. What needs shapes and sizes is checked by
/// sorter/feed.cpp.
namespace ejecta {
namespace {

bool has_machine(const Case& c, Findings& found) {
  const std::ptrdiff_t before = found.errors();
  if (!c.launch.enabled)
    found.error("sorter", "a sorter needs the flight from the belt to the jets, but there is no [launch]",
                "[launch]", "[launch] belt_speed = \"3 m/s\"");
  if (!c.splitter.enabled)
    found.error("sorter", "a sorter needs a plate that parts its products, but there is no [splitter]",
                "[splitter]", "[splitter] distance = \"250 mm\", height = \"18 mm\"");
  if (!jet_face(c) || !grid_box(c))
    found.error("sorter", "a sorter needs the jet of a valve, but no face of a box is of type \"jet\"",
                "the box of one ejection: [grid], [boundary.z_min] type = \"jet\", [valve], [jet]",
                "extends = \"../paper/setup/box.toml\"");
  else if (!is_incompressible(c))
    found.error("flow.solver", "the jet of a sorter is that of an incompressible box", "\"incompressible\"",
                "solver = \"incompressible\"");
  if (!c.jet.more_nozzles.empty())
    found.error("jet.more_nozzles", "the valves of a sorter are those of its manifold", "[sorter.manifold]",
                "[sorter.manifold] valves = 128");
  if (!c.valve.more_pulses.empty())
    found.error("valve.more_pulses", "the valves of a sorter open as its controller tells them",
                "no more_pulses", "more_pulses = []");
  for (const char* key : {"offset_along", "offset_across"})
    if (c.given.contains(fmt::format("launch.{}", key)))
      found.error(fmt::format("launch.{}", key),
                  fmt::format("`{}` does nothing here: the feed says where particles are", key),
                  fmt::format("no {}, or sorter.controller.lead", key),
                  "[sorter.controller] lead = \"6 ms\"");
  const Vec3& g = c.environment.gravity;
  if (!(g.z() < 0.0) || g.x() != 0.0 || g.y() != 0.0)
    found.error("environment.gravity", "particles leave a level belt and fall straight down",
                "gravity along -z", "gravity = [\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]");
  const bool file = c.feed.presentation == Presentation::file;
  if (!file && !(c.sorter.throughput > 0.0))
    found.error("sorter.throughput", "missing: how much the belt brings", "a mass flow, more than 0",
                "throughput = \"10 t/h\"");
  for (const char* key : {"throughput", "particles"})
    if (file && c.given.contains(fmt::format("sorter.{}", key)))
      found.warning(fmt::format("sorter.{}", key),
                    fmt::format("`{}` does nothing here: sorter.feed.file says what comes, and when", key),
                    fmt::format("no {}, or another presentation", key),
                    "[sorter.feed] presentation = \"monolayer\"");
  return found.errors() == before;
}

void check_sizes(const Case& c, std::size_t n, Findings& found) {
  const ParticleClassSpec& k = c.classes[n];
  const std::string at = fmt::format("sorter.class.{}.", n);
  const double largest = std::max(k.size, k.size_to) / k.elongation;
  if (largest >= c.sorter.belt_width)
    found.error(at + "size",
                fmt::format("particles of {:.4g} mm are wider than the belt of {:.4g} mm", 1e3 * largest,
                            1e3 * c.sorter.belt_width),
                "a size below sorter.belt_width",
                fmt::format("size = \"{:.3g} mm\"", 100.0 * c.sorter.belt_width));
  check_size_law(c, k, at, "20 mm", found);
  if (k.form == ParticleForm::mesh)
    require_file(c, at + "file", k.file, "missing: the file", "file = \"rock.stl\"", found);
  else if (!k.file.empty())
    found.error(at + "file", "`file` does nothing here: it belongs to form = \"mesh\"",
                "form = \"mesh\", or no file", "form = \"mesh\"");
}

void check_classes(const Case& c, Findings& found) {
  if (c.classes.empty()) {
    found.error("sorter", "there is nothing to sort: no [[sorter.class]]", "classes whose shares add up to 1",
                "[[sorter.class]] name = \"ore\", share = 1.0, eject = true, size = \"10 mm\"");
    return;
  }
  double sum = 0.0;
  bool any = false;
  std::set<std::string> names;
  for (std::size_t n = 0; n < c.classes.size(); ++n) {
    if (!c.classes[n].name.empty() && !names.insert(c.classes[n].name).second)
      found.error(fmt::format("sorter.class.{}.name", n),
                  fmt::format("there is a class \"{}\" already", c.classes[n].name), "names that differ",
                  fmt::format("name = \"{} {}\"", c.classes[n].name, n + 1));
    sum += c.classes[n].share;
    any = any || (c.classes[n].eject && c.classes[n].share > 0.0);
    check_sizes(c, n, found);
  }
  const std::size_t last = c.classes.size() - 1;
  if (std::abs(sum - 1.0) > 1e-6) {
    const double rest = 1.0 - (sum - c.classes[last].share);
    found.error(fmt::format("sorter.class.{}.share", last),
                fmt::format("the shares of all classes add up to {:.6g}, not to 1", sum),
                "shares that add up to 1",
                rest > 0.0 ? fmt::format("share = {:.6g}", rest)
                           : fmt::format("share = {:.6g}", c.classes[last].share / sum));
  }
  if (!any)
    found.error("sorter.class.0.eject", "no class is to be ejected", "true for at least one of them",
                "eject = true");
}

/// s, of a burst: longer ones are no shots at particles.
constexpr double kLongestBurst = 1.0;

/// Commands that the controller cannot mean, or that the jet of the case says nothing of.
void check_commands(const Case& c, Findings& found) {
  const ControllerSpec& k = c.controller;
  const bool fixed = k.window == WindowRule::fixed;
  const auto too_long = [&](const char* key, double lasts, const char* example) {
    if (lasts > kLongestBurst)
      found.error(fmt::format("sorter.controller.{}", key),
                  fmt::format("{} is no burst at a particle", format_quantity(lasts, Dimension::time)),
                  fmt::format("at most {:g} s", kLongestBurst), example);
  };
  too_long("duration", k.duration, "duration = \"8 ms\"");
  too_long("lead", std::abs(k.lead), "lead = \"6 ms\"");
  too_long("shortest_on", k.shortest_on, "shortest_on = \"2 ms\"");
  too_long("shortest_off", k.shortest_off, "shortest_off = \"2 ms\"");
  too_long("time_error", 2.0 * k.quantile * k.time_error, "time_error = \"1 ms\"");
  if (fixed && c.given.contains("sorter.controller.time_error"))
    found.warning("sorter.controller.time_error", "`time_error` does nothing here: window is \"fixed\"",
                  "no time_error, or the other window", "window = \"by-size\"");
  const double opens = c.valve.rise_time, needs = fixed ? std::max(k.duration, k.shortest_on) : 1e300;
  if (c.valve.shape != ValveShape::trace && c.valve.duration < std::min(opens, needs))
    found.error(
        "valve.duration",
        fmt::format("the jet of a command of {} never blows fully, its valve opens within {}: it does not "
                    "say what the longer commands of the controller do",
                    format_quantity(c.valve.duration, Dimension::time),
                    format_quantity(opens, Dimension::time)),
        "at least valve.rise_time, or as long as sorter.controller.duration",
        fmt::format("duration = \"{:.3g} ms\"", 1e3 * std::max(opens, fixed ? needs : opens)));
}

/// Signals by which no reading can part the classes.
void check_signals(const Case& c, Findings& found) {
  double sum[2] = {0, 0}, share[2] = {0, 0}, low = 1e300, high = -1e300, spread = c.camera.noise;
  for (const ParticleClassSpec& k : c.classes) {
    if (k.read_as_eject) return;  // a matrix of readings stands for signals
    sum[k.eject] += k.share * k.signal;
    share[k.eject] += k.share;
    low = std::min(low, k.signal);
    high = std::max(high, k.signal);
    spread = std::max(spread, k.signal_spread);
  }
  if (!(share[0] > 0.0) || !(share[1] > 0.0)) return;
  const double keep = sum[0] / share[0], eject = sum[1] / share[1];
  if (keep == eject)
    return found.error("sorter.class.0.signal",
                       fmt::format("what is ejected and what is kept read alike, {:g}: nothing can tell them "
                                   "apart",
                                   keep),
                       "signals that differ, or read_as_eject for each class", "signal = 1.0");
  const double threshold = c.camera.threshold.value_or(0.5 * (keep + eject));
  if (spread == 0.0 && (threshold < low || threshold >= high))
    found.error("sorter.camera.threshold",
                fmt::format("all signals, {:g} to {:g}, lie on one side of {:g}: everything is read alike",
                            low, high, threshold),
                "a threshold between the signals", fmt::format("threshold = {:g}", 0.5 * (keep + eject)));
}

/// Share of the belt's width that the valves may leave without one, or stand beside it, before it is asked
/// about.
constexpr double kBesideBelt = 0.2;

void check_manifold(const Case& c, Findings& found) {
  const ManifoldSpec& m = c.manifold;
  for (const int valve : m.dead_valves)
    if (valve >= m.valves)
      found.error("sorter.manifold.dead_valves",
                  fmt::format("there is no valve {}: they are 0 to {}", valve, m.valves - 1),
                  "numbers of valves, from 0", "dead_valves = [12, 13]");
  if (m.dead * m.valves > m.valves - 0.5)
    found.error("sorter.manifold.dead", "no valve opens", "a share below 1", "dead = 0.2");
  if (std::set<int>(m.dead_valves.begin(), m.dead_valves.end()).size() >= static_cast<std::size_t>(m.valves))
    found.error("sorter.manifold.dead_valves", "no valve opens", "some valves that work",
                "dead_valves = [12, 13]");
  const double belt = c.sorter.belt_width, pitch = valve_pitch(c), span = m.valves * pitch;
  const std::string fits = fmt::format("pitch = \"{:.3g} mm\"", 1e3 * belt / m.valves);
  if (pitch > belt)
    found.error("sorter.manifold.pitch",
                fmt::format("the valves stand {:.4g} mm apart, farther than the belt of {:.4g} mm is wide",
                            1e3 * pitch, 1e3 * belt),
                "the belt's width over the number of valves", fits);
  else if (std::abs(span - belt) > kBesideBelt * belt)
    found.warning("sorter.manifold.pitch",
                  fmt::format("{} valves every {:.4g} mm stand along {:.4g} mm, the belt is {:.4g} mm wide",
                              m.valves, 1e3 * pitch, 1e3 * span, 1e3 * belt),
                  "valves along the width of the belt", fits);
  if (pitch < c.valve.orifice_diameter)
    found.error("sorter.manifold.pitch",
                fmt::format("valves every {:.4g} mm have no room for orifices of {:.4g} mm", 1e3 * pitch,
                            1e3 * c.valve.orifice_diameter),
                "more than valve.orifice_diameter, or fewer valves",
                belt > m.valves * c.valve.orifice_diameter
                    ? fits
                    : fmt::format("valves = {:.0f}",
                                  std::max(1.0, std::floor(0.5 * belt / c.valve.orifice_diameter))));
  if (m.vessel > 0.0 && !(m.line_diameter > 0.0))
    found.error("sorter.manifold.line_diameter", "the vessel is fed through nothing", "a length, more than 0",
                "line_diameter = \"10 mm\"");
}

/// Whether particles can fall from the lip, land ahead of the camera, and come to rest. `longest`: m, of
/// them.
void check_feeder(const Case& c, double longest, Findings& found) {
  const double g = std::abs(c.environment.gravity.z()), v = c.launch.belt_speed, u = c.feed.lip_speed;
  if (c.feed.lip_height < longest)
    found.error("sorter.feed.lip_height",
                fmt::format("particles of up to {:.4g} mm do not pass under a lip at {:.4g} mm",
                            1e3 * longest, 1e3 * c.feed.lip_height),
                fmt::format("at least {:.4g} mm", 1e3 * longest),
                fmt::format("lip_height = \"{:.0f} mm\"", 1e3 * longest + 20.0));
  const double lands = u * std::sqrt(2.0 * c.feed.lip_height / g) + longest;
  if (c.feed.lip_distance < lands)
    found.error("sorter.feed.lip_distance",
                fmt::format("particles fly over the camera: they land {:.4g} mm behind the lip", 1e3 * lands),
                fmt::format("at least {:.4g} mm", 1e3 * lands),
                fmt::format("lip_distance = \"{:.2g} m\"", lands + v * v / g + 0.1));
  if (c.camera.distance < c.launch.drop_distance)
    found.error("sorter.camera.distance",
                "the camera of a feeder looks at the belt, not at the flight behind it",
                fmt::format("at least launch.drop_distance, {:.4g} mm", 1e3 * c.launch.drop_distance),
                fmt::format("distance = \"{:.0f} mm\"", 1e3 * c.launch.drop_distance + 200.0));
  const MaterialSpec material = c.materials.empty() ? MaterialSpec{} : c.materials.front();
  if (!(material.friction > 0.0))
    found.error("material.0.friction", "the belt cannot speed particles up that it does not rub on",
                "more than 0", "friction = 0.5");
  const bool any_round = std::any_of(c.classes.begin(), c.classes.end(), [](const ParticleClassSpec& k) {
    return k.form == ParticleForm::sphere;
  });
  if (any_round && !(material.rolling_friction > 0.0))
    found.error("material.0.rolling_friction", "spheres that fall on a running belt roll on it without end",
                "more than 0", "rolling_friction = 0.1");
}

void check_devices(const Case& c, Findings& found) {
  // All of an object must have passed the camera, and be thought about, before its first command.
  const double v = c.launch.belt_speed, there = c.camera.distance / v;
  double longest = 0.0;
  for (const ParticleClassSpec& k : c.classes)
    longest = std::max(longest, std::max(k.size, k.size_to) / k.elongation);
  const ControllerSpec& k = c.controller;
  const double needs = k.lead + c.camera.computing_time + longest / v +
                       (k.window == WindowRule::by_size ? k.quantile * k.time_error : 0.0);
  if (needs > there)
    found.error(
        "sorter.camera.distance",
        fmt::format(
            "the window would open before the camera has seen the particle: from the camera to the jets it "
            "takes {}, the commands are needed {} before",
            format_quantity(there, Dimension::time), format_quantity(needs, Dimension::time)),
        fmt::format("at least {:.3g} mm, or a shorter lead or computing time", 1e3 * needs * v),
        fmt::format("distance = \"{:.0f} mm\"", 1e3 * needs * v + 20.0));
  if (c.camera.gap >= c.sorter.belt_width)
    found.error("sorter.camera.gap",
                fmt::format("all that lies within {:.4g} mm is one object: the whole belt of {:.4g} mm",
                            1e3 * c.camera.gap, 1e3 * c.sorter.belt_width),
                "about two pixels",
                fmt::format("gap = \"{:.2g} mm\"", 2e3 * c.sorter.belt_width / c.camera.pixels));
  check_manifold(c, found);
  check_commands(c, found);
  check_signals(c, found);
  if (c.feed.presentation != Presentation::file && !c.feed.file.empty())
    found.error("sorter.feed.file", "`file` does nothing here: it belongs to presentation = \"file\"",
                "presentation = \"file\", or no file", "presentation = \"file\"");
  if (c.feed.presentation == Presentation::feeder) {
    check_feeder(c, longest, found);
  } else {
    for (const char* key : {"lip_speed", "lip_height", "lip_distance"})
      if (c.given.contains(fmt::format("sorter.feed.{}", key)))
        found.error(fmt::format("sorter.feed.{}", key),
                    fmt::format("`{}` does nothing here: it belongs to presentation = \"feeder\"", key),
                    fmt::format("presentation = \"feeder\", or no {}", key), "presentation = \"feeder\"");
  }
  if (c.feed.presentation == Presentation::file)
    require_file(c, "sorter.feed.file", c.feed.file, "missing: the file with the places",
                 "file = \"log.csv\"", found);
}

}  // namespace

void sense_machine(const Case& c, Findings& found) {
  if (!c.sorter.enabled) return;
  if (!has_machine(c, found)) return;
  const std::ptrdiff_t before = found.errors();
  check_classes(c, found);
  if (found.errors() == before) check_devices(c, found);
}

}  // namespace ejecta
