#include "sorter/alone.hpp"

#include <algorithm>
#include <cmath>

#include "sorter/plan_view.hpp"

namespace ejecta {

std::vector<bool> standing_alone(std::span<const FeedParticle> particles, double gap) {
  std::vector<std::size_t> order(particles.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return particles[a].x < particles[b].x; });
  double largest = 0.0;
  std::vector<double> radius;
  std::vector<std::vector<Vec3>> outlines;
  for (const FeedParticle& p : particles) {
    radius.push_back(p.scale * p.prototype->shape.bounding_radius());
    outlines.push_back(outline_of(p));
    largest = std::max(largest, radius.back());
  }
  std::vector<bool> single(particles.size(), true);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const std::size_t a = order[i], b = order[j];
      const double dx = particles[b].x - particles[a].x, dy = particles[b].y - particles[a].y;
      if (dx > radius[a] + largest + gap) break;
      if (!single[a] && !single[b]) continue;
      if (std::hypot(dx, dy) > radius[a] + radius[b] + gap) continue;
      if (within_gap(outlines[a], outlines[b], gap)) single[a] = single[b] = false;
    }
  return single;
}

}  // namespace ejecta
