#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "case/load.hpp"
#include "case/schema.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/coupled_model.hpp"

/// What `check` passes, `run` computes: cases of which some keys are drawn at random from the schema are
/// refused, or set up and stepped without a crash, a divergence or a NaN. Some hundred by default;
/// EJECTA_RANDOM_CASES=10000 for the long run.
using namespace ejecta;

namespace {

constexpr const char* kBodies = R"(
[[material]]
name = "ore"
[[body]]
name = "cube"
shape = "box"
size = ["10 mm", "10 mm", "10 mm"]
material = "ore"
position = ["0 mm", "0 mm", "20 mm"]
velocity = ["1 m/s", "0 m/s", "0 m/s"]
[[body]]
name = "ball"
diameter = "9 mm"
position = ["-12 mm", "0 mm", "20 mm"]
velocity = ["1 m/s", "0 m/s", "0 m/s"]
)";

constexpr const char* kGrid = R"(
[grid.x]
points = ["-20 mm", "20 mm"]
cells = [20]
[grid.y]
points = ["-12 mm", "12 mm"]
cells = [12]
[grid.z]
points = ["5 mm", "35 mm"]
cells = [16]
)";

constexpr const char* kOpen = R"(
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_max]
type = "free-stream"
)";

/// What the cases are drawn about.
std::vector<std::string> starts() {
  const std::string run =
      "[run]\nend_time = \"20 ms\"\n[contact]\nlinear_stiffness = \"10 kN/m\"\n[environment]\n[fluid]\n";
  const std::string dry = run + "[flow]\nsolver = \"none\"\n" + kBodies +
                          "[[wall]]\nname = \"floor\"\npoint = [\"0 m\", \"0 m\", \"-1 mm\"]\n[domain]\n";
  const std::string belt = run +
                           "[flow]\nsolver = \"none\"\n[[body]]\nname = \"cube\"\nshape = \"box\"\nsize = "
                           "[\"8 mm\", \"8 mm\", \"8 mm\"]\n"
                           "on_belt = true\n[[body]]\nname = \"ball\"\ndiameter = \"6 mm\"\non_belt = "
                           "true\nbehind = \"cube\"\ngap = \"4 mm\"\n"
                           "[launch]\n[splitter]\n";
  const std::string wet = run + "[flow]\nsolver = \"incompressible\"\n" + kGrid + kOpen;
  const std::string jet =
      wet + "[boundary.z_min]\ntype = \"jet\"\n[valve]\norifice_diameter = \"0.4 mm\"\n[jet]\n";
  const std::string gas = run + "[flow]\nsolver = \"compressible-piso\"\n" + kGrid + kOpen +
                          "[boundary.z_min]\ntype = \"wall\"\n";
  const std::string shock =
      run + "[flow]\nsolver = \"compressible\"\n" + kGrid + kOpen + "[boundary.z_min]\ntype = \"slip\"\n";
  const std::string dusty =
      wet + "[boundary.z_min]\ntype = \"slip\"\n[[grains]]\nsize = \"0.3 mm\"\ncount = 50\n[coupling]\n";
  return {dry, belt, wet + kBodies, jet + kBodies, jet, gas + kBodies, shock, dusty};
}

/// Draws values for a key.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  double real(double low, double high) {
    return low + (high - low) * std::ldexp(double(random_() >> 11), -53);
  }

  /// As TOML; empty: no value is drawn for such a key.
  std::string value(const Key& key) {
    return std::visit([&](const auto& slot) { return of(slot, key); }, key.slot);
  }

 private:
  double typical(Dimension d) {
    using enum Dimension;
    switch (d) {
      case length:
        return 10e-3;
      case area:
        return 1e-4;
      case Dimension::time:
        return 2e-3;
      case velocity:
        return 3.0;
      case acceleration:
        return 10.0;
      case mass:
        return 2e-3;
      case density:
        return 2000.0;
      case pressure_gauge:
        return 1000.0;
      case pressure_absolute:
        return 2e5;
      case pressure:
        return 5e6;
      case temperature:
        return 300.0;
      case viscosity:
        return 2e-5;
      case stiffness:
        return 1e4;
      default:
        return 1.0;
    }
  }
  double number(const Key& key) {
    const Bounds& b = key.bounds;
    double v =
        typical(key.dimension) * std::pow(10.0, real(-1.0, 1.0)) * (b.least < 0.0 && below(2) ? -1.0 : 1.0);
    if (below(20) == 0) v = 0.0;
    if (below(20) == 0 && std::isfinite(b.most)) v = b.most;
    if (below(20) == 0 && std::isfinite(b.least)) v = b.least;
    return std::clamp(v, b.least, b.most);
  }
  std::string scalar(const Key& key) {
    const double v = number(key);
    if (key.dimension == Dimension::none) return fmt::format("{}", v);
    const char* word = key.dimension == Dimension::pressure_gauge      ? " gauge"
                       : key.dimension == Dimension::pressure_absolute ? " absolute"
                                                                       : "";
    return fmt::format("\"{} {}{}\"", v, si_unit(key.dimension), word);
  }
  std::string list(const Key& key, std::size_t n) {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < n; ++k) parts.push_back(scalar(key));
    return "[" + joined(parts) + "]";
  }
  std::string of(const bool*, const Key&) { return below(2) ? "true" : "false"; }
  std::string of(const std::optional<bool>*, const Key&) { return below(2) ? "true" : "false"; }
  std::string of(const int*, const Key&) { return std::to_string(below(6)); }
  std::string of(const std::int64_t*, const Key&) { return std::to_string(below(6)); }
  std::string of(const double*, const Key& key) { return scalar(key); }
  std::string of(const std::optional<double>*, const Key& key) { return scalar(key); }
  std::string of(const Vec3*, const Key& key) { return list(key, 3); }
  std::string of(const std::vector<double>*, const Key& key) { return list(key, 1 + below(3)); }
  std::string of(const std::array<double, 2>*, const Key& key) { return list(key, 2); }
  std::string of(const std::optional<std::array<double, 2>>*, const Key& key) { return list(key, 2); }
  std::string of(const std::array<int, 3>*, const Key&) {
    return fmt::format("[{}, {}, {}]", 1 + below(4), 1 + below(4), 1 + below(4));
  }
  std::string of(const Choice& c, const Key&) {
    return "\"" + (*c.words)[below(c.words->size())].name + "\"";
  }
  std::string of(const Formula&, const Key& key) { return scalar(key); }
  std::string of(const Formulas&, const Key& key) { return list(key, 3); }
  std::string of(const VectorOrFormulas&, const Key& key) { return list(key, 3); }
  template <class Other>
  std::string of(const Other&, const Key&) {
    return "";
  }  // names, files, lists of lists

  std::mt19937_64 random_;
};

struct Drawn {
  std::string text;
  std::vector<std::string> overrides;
};

/// Some keys of the sections that the start has, each with a value from the schema.
Drawn draw_case(Draw& draw) {
  const auto texts = starts();
  Drawn d{texts[draw.below(texts.size())], {}};
  Case c = parse_case(d.text, "start.toml");
  const std::vector<Section> all = sections(c);
  const std::size_t changes = 1 + draw.below(5);
  for (int tries = 0; d.overrides.size() < changes && tries < 200; ++tries) {
    const Section& s = all[draw.below(all.size())];
    const bool there =
        d.text.find(s.repeated ? "[[" + s.name + "]]" : "[" + s.name + "]") != std::string::npos;
    if (!there || s.count() == 0) continue;
    const std::size_t n = draw.below(s.count());
    const std::vector<Key> keys = s.keys(n);
    const Key& key = keys[draw.below(keys.size())];
    const std::string value = draw.value(key);
    if (value.empty()) continue;
    d.overrides.push_back(
        fmt::format("{}.{}={}", s.repeated ? fmt::format("{}.{}", s.name, n) : s.name, key.name, value));
  }
  return d;
}

enum class Fate { refused, too_large, ran };

/// Throws what a run must not throw.
Fate fate_of(const Drawn& d) {
  Case c;
  try {
    c = parse_case(d.text, "drawn.toml", d.overrides, nullptr,
                   [](const Case& one) { return check_bodies(one); });
  } catch (const InputError& e) {
    if (std::getenv("EJECTA_RANDOM_TELL")) std::fprintf(stderr, "%s\n", e.what());
    return Fate::refused;
  }
  double cells = 1.0;
  if (c.flow.solver != FlowSolver::none)
    for (const AxisSpec& a : c.grid.axis)
      for (const int n : a.cells) cells *= n;
  int copies = 0;
  for (const BodySpec& b : c.bodies) copies += b.copies;
  if (cells > 2e4 || copies > 20 || c.jet.kind == JetKind::computed) return Fate::too_large;
  CoupledModel model(c);
  Clock clock;
  clock.add_event(c.run.end_time);
  for (int step = 0; step < 3 && clock.time() < c.run.end_time * (1 - 1e-12) && !model.finished(); ++step) {
    const Step next = clock.next(model.stable_dt(clock.time()));
    if (!(next.dt > 0.0) || !std::isfinite(next.dt))
      throw Error(fmt::format("step {} of {} s", step, next.dt));
    model.advance(next);
    clock.tick(next);
    model.require_finite(clock.time());
    for (const Body& b : model.particles().bodies())
      if (!b.position.allFinite() || !b.velocity.allFinite() || !b.angular_velocity.allFinite())
        throw Error(fmt::format("body \"{}\" is nowhere after step {}", b.name, step));
  }
  return Fate::ran;
}

std::string complaint_of(const Drawn& d) {
  try {
    fate_of(d);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

/// Without the changes that do not matter.
Drawn shrunk(Drawn d) {
  for (std::size_t n = 0; n < d.overrides.size();) {
    Drawn less = d;
    less.overrides.erase(less.overrides.begin() + static_cast<std::ptrdiff_t>(n));
    if (complaint_of(less).empty()) ++n;
    else d = less;
  }
  return d;
}

TEST(RandomCases, WhatCheckPassesRunComputes) {
  const char* wish = std::getenv("EJECTA_RANDOM_CASES");
  const int cases = wish ? std::atoi(wish) : 300;
  int ran = 0, refused = 0, wrong = 0;
  for (int n = 0; n < cases && wrong < 25; ++n) {
    Draw draw(static_cast<unsigned>(n));
    const Drawn d = draw_case(draw);
    try {
      const Fate fate = fate_of(d);
      ran += fate == Fate::ran;
      refused += fate == Fate::refused;
    } catch (const std::exception& e) {
      ++wrong;
      const Drawn small = shrunk(d);
      ADD_FAILURE() << "case " << n << ": " << e.what() << "\n--set " << joined(small.overrides, "\n--set ")
                    << "\n"
                    << small.text;
    }
  }
  EXPECT_GT(ran, cases / 5) << "hardly a case was run: " << refused << " of " << cases << " refused";
  RecordProperty("ran", ran);
}

}  // namespace
