#include "coupling/unresolved/eddy_walk.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta {
namespace {

constexpr double kLagrangian = 0.15;  // T_L epsilon / k
constexpr double kManyInAStep =
    1 / 16.0;  // eddies of less life than this part of a step are met by the dozen
constexpr std::uint64_t kEddies = 1'000'000;  // streams of random numbers behind those of places and sizes

/// How long the grain stays in an eddy, s.
double life_of(const EddyAround& a) {
  const double life = 2 * kLagrangian * a.k / a.epsilon,
               size = std::pow(double(k_epsilon::kCmu), 0.75) * std::pow(a.k, 1.5) / a.epsilon,
               way = a.relaxation * a.slip;  // that it comes along in still fluid
  return way > size ? std::min(life, -a.relaxation * std::log1p(-size / way)) : life;
}

}  // namespace

Vec3 EddyWalk::draw(std::size_t grain, Eddy& e) const {
  const CounterRandom random(seed_, kEddies + grain);
  const auto [x, y] = random.normals(2 * e.drawn);
  const double z = random.normal(2 * e.drawn + 1);
  ++e.drawn;
  return {x, y, z};
}

Vec3 EddyWalk::velocity(std::size_t grain, const EddyAround& around, double dt) {
  Eddy& e = eddies_[grain];
  if (!(around.k > 0.0 && around.epsilon > 0.0)) {
    e.left = 0.0;
    return {0, 0, 0};
  }
  const double size = std::sqrt(2 * around.k / 3), life = life_of(around);
  if (life < kManyInAStep * dt) {
    e.left = 0.0;
    return std::sqrt(life / dt) * size * draw(grain, e);
  }
  Vec3 way(0, 0, 0);
  for (double rest = dt; rest > 0.0;) {
    if (!(e.left > 0.0)) {
      e.velocity = size * draw(grain, e);
      e.left = life;
    }
    const double together = std::min(rest, e.left);
    way += together * e.velocity;
    e.left = rest < e.left ? e.left - rest : 0.0;
    rest -= together;
  }
  return way / dt;
}

void EddyWalk::add_state(std::vector<double>& to) const {
  for (const Eddy& e : eddies_)
    to.insert(to.end(), {e.velocity.x(), e.velocity.y(), e.velocity.z(), e.left, double(e.drawn)});
}

void EddyWalk::restore(StateReader& in, std::size_t grains) {
  eddies_.assign(grains, {});
  for (Eddy& e : eddies_) {
    e.velocity = in.vec3();
    e.left = in.number();
    e.drawn = static_cast<std::uint64_t>(in.number());
  }
}

}  // namespace ejecta
