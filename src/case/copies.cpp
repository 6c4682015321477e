#include "case/copies.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "base/random.hpp"

namespace ejecta {
namespace {

/// Uniform numbers in [0, 1) that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return std::ldexp(static_cast<double>(bits_() >> 11), -53); }

 private:
  std::mt19937_64 bits_;
};

Quat any_rotation(Random& random) {
  const double u = random(), v = random(), w = random();  // in this order
  return uniform_rotation(u, v, w);
}

}  // namespace

Case with_first_copies(const Case& c) {
  Case first = c;
  for (BodySpec& b : first.bodies) {
    if (b.copies > 1 && !b.enters_at) b.enters_at = 0.0;
    b.copies = 1;
  }
  return with_copies(first);
}

Case with_copies(const Case& c) {
  Case out = c;
  out.bodies.clear();
  std::uint64_t seed = 0;
  for (const BodySpec& spec : c.bodies) {
    Random random(++seed);
    for (int n = 0; n < spec.copies; ++n) {
      BodySpec b = spec;
      if (spec.copies > 1) {
        b.name = fmt::format("{}-{}", spec.name, n + 1);
        b.enters_at = spec.enters_at.value_or(0.0) + n * spec.every;
      }
      for (int a = 0; a < 3; ++a) b.position[a] += spec.spread[a] * (random() - 0.5);
      if (spec.random_rotation) {
        const Eigen::AngleAxisd turn(any_rotation(random));
        b.rotation_axis = turn.axis();
        b.rotation_angle = turn.angle();
      }
      b.copies = 1;
      b.spread.setZero();
      b.random_rotation = false;
      out.bodies.push_back(std::move(b));
    }
  }
  return out;
}

}  // namespace ejecta
