#include "case/initial.hpp"

namespace ejecta {

std::vector<int> regions_at(const Case& c, const Vec3& x) {
  std::vector<int> regions;
  for (std::size_t n = 0; n < c.initial.size(); ++n) {
    if (const auto& box = c.initial[n].box) {
      const Vec3 low = (*box)[0].cwiseMin((*box)[1]), high = (*box)[0].cwiseMax((*box)[1]);
      if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) continue;
    }
    regions.push_back(static_cast<int>(n));
  }
  return regions;
}

StateSpec merged(const Case& c, const std::vector<int>& regions) {
  StateSpec all;
  const auto take = [](auto& into, const auto& said) {
    if (said) into = said;
  };
  for (const int n : regions) {
    const StateSpec& s = c.initial[static_cast<std::size_t>(n)].state;
    take(all.velocity, s.velocity);
    take(all.pressure, s.pressure);
    if (s.temperature) all.density.reset();
    take(all.density, s.density);
    take(all.temperature, s.temperature);
    take(all.k, s.k);
    take(all.epsilon, s.epsilon);
  }
  return all;
}

}  // namespace ejecta
