#include "dem/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "dem/contact_damping.hpp"
#include "dem/time_step.hpp"

namespace ejecta {
namespace {

void require(bool good, const MaterialSpec& m, const char* key, double value, const char* range,
             const char* example) {
  if (!good)
    throw InputError(fmt::format("material \"{}\": {} = {} must be {}", m.name, key, value, range),
                     {.key = key, .expected = range, .example = fmt::format("{} = {}", key, example)});
}

void check(const MaterialSpec& m) {
  require(m.youngs_modulus > 0, m, "youngs_modulus", m.youngs_modulus,
          m.friction > 0 ? "positive: friction needs a stiffness (the paper's is 5 MPa)"
                         : "positive (the paper's is 5 MPa)",
          "\"5 MPa\"");
  require(m.poisson_ratio > -1 && m.poisson_ratio <= 0.5, m, "poisson_ratio", m.poisson_ratio, "in (-1, 0.5]",
          "0.45");
  require(m.density > 0, m, "density", m.density, "positive (quartz: 2700 kg/m3)", "\"2700 kg/m3\"");
  require(m.restitution >= 0.01 && m.restitution <= 1, m, "restitution", m.restitution, "in [0.01, 1]",
          "0.3");
  require(m.friction >= 0, m, "friction", m.friction, "zero or positive", "0.5");
  require(m.rolling_friction >= 0, m, "rolling_friction", m.rolling_friction, "zero or positive", "0.05");
}

double shear_modulus(const MaterialSpec& m) { return m.youngs_modulus / (2 * (1 + m.poisson_ratio)); }

}  // namespace

Materials::Materials(const Case& config)
    : specs_(config.materials), law_(config.contact.law), allow_tension_(config.contact.allow_tension) {
  if (specs_.empty()) specs_.emplace_back();  // the defaults
  for (const MaterialSpec& m : specs_) check(m);
  if (law_ == ContactLaw::linear && !(config.contact.linear_stiffness > 0))
    throw InputError(
        fmt::format("contact.linear_stiffness = {} N/m must be positive with law = \"linear\": a contact "
                    "without stiffness bears neither load nor friction (try 1e5 N/m)",
                    config.contact.linear_stiffness));
  for (const MaterialSpec& a : specs_)
    for (const MaterialSpec& b : specs_) {
      double restitution = std::min(a.restitution, b.restitution);
      double friction = std::min(a.friction, b.friction);
      double rolling = std::min(a.rolling_friction, b.rolling_friction);
      for (const MaterialPairSpec& p : config.material_pairs)
        if ((p.a == a.name && p.b == b.name) || (p.a == b.name && p.b == a.name)) {
          restitution = p.restitution.value_or(restitution);
          friction = p.friction.value_or(friction);
          rolling = p.rolling_friction.value_or(rolling);
        }
      if (!(restitution >= 0.01 && restitution <= 1 && friction >= 0 && rolling >= 0))
        throw InputError(
            fmt::format("material_pair \"{}\"-\"{}\": restitution {} must be in [0.01, 1], friction {} and "
                        "rolling_friction {} zero or positive",
                        a.name, b.name, restitution, friction, rolling));
      PairConstants<double> c;
      c.youngs = 1 / ((1 - a.poisson_ratio * a.poisson_ratio) / a.youngs_modulus +
                      (1 - b.poisson_ratio * b.poisson_ratio) / b.youngs_modulus);
      c.shear = 1 / ((2 - a.poisson_ratio) / shear_modulus(a) + (2 - b.poisson_ratio) / shear_modulus(b));
      c.stiffness = config.contact.linear_stiffness;
      c.damping = contact_damping(restitution, allow_tension_);
      c.drag = with_law(law_, [&](auto law) { return law.drag(c); });
      c.friction = friction;
      c.rolling = rolling;
      pairs_.push_back(c);
    }
  for (int a = 0; a < count(); ++a) {
    double& most = swiftest_.emplace_back(0.0);
    if (!with_law(law_, [](auto law) { return law.kIsElastic; })) continue;
    for (int b = 0; b < count(); ++b) {  // of a dent with root(radius x overlap) = 1 and a mass of 1
      Contact<double> dent;
      dent.overlap = dent.radius = dent.mass = 1.0;
      const NormalSpring<double> s = HertzMindlin::spring(dent, pair(a, b));
      const double dashpot = dashpot_of(s, dent, pair(a, b));
      // The dashpot goes with the root of the stiffness, so its square is in proportion too.
      most = std::max(most, asked_rate_squared(1.5 * s.secant, dashpot));
    }
  }
  for (const MaterialPairSpec& p : config.material_pairs) {
    index(p.a);
    index(p.b);
  }
}

int Materials::index(const std::string& name) const {
  if (name.empty()) return 0;
  std::string known;
  for (std::size_t n = 0; n < specs_.size(); ++n) {
    if (specs_[n].name == name) return static_cast<int>(n);
    known += (n ? ", \"" : "\"") + specs_[n].name + "\"";
  }
  throw InputError(
      fmt::format("material \"{}\" is not defined; known: {}", name, known.empty() ? "none" : known));
}

bool Materials::any_rolling() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const auto& p) { return p.rolling > 0; });
}

}  // namespace ejecta
