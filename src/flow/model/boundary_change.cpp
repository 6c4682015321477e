#include "flow/model/boundary_change.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

/// States are looked at so often within a step: a formula that rises and falls between two of them is not
/// seen, nor would the flow resolve it.
constexpr int kLooks = 8;

void look_at_face(const Grid& grid, const Boundary& boundary, int face, double time, double dt,
                  BoundaryChange& most) {
  const int d = face / 2, a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
  const auto width = [&](int axis, int n) { return grid.axis(axis).width[static_cast<std::size_t>(n)]; };
  Vec3 x = face % 2 ? grid.upper() : grid.lower();
  for (int j = 0; j < grid.n(b); ++j)
    for (int i = 0; i < grid.n(a); ++i) {
      x[a] = grid.axis(a).centre[static_cast<std::size_t>(i)];
      x[b] = grid.axis(b).centre[static_cast<std::size_t>(j)];
      Vec3 per_width = Vec3::Zero();
      for (const auto& [axis, n] :
           {std::pair(d, face % 2 ? grid.n(d) - 1 : 0), std::pair(a, i), std::pair(b, j)})
        if (grid.active(axis)) per_width[axis] = 1.0 / width(axis, n);
      const BoundaryState now = boundary.state(x, time);
      for (int look = 1; look <= kLooks; ++look) {
        const BoundaryState then = boundary.state(x, time + dt * look / kLooks);
        double reached = 0.0, changed = 0.0;
        for (int c = 0; c < 3; ++c) {
          const auto v = static_cast<std::size_t>(c);
          reached += std::abs(double(then.velocity[v])) * per_width[c];
          changed += std::abs(double(then.velocity[v]) - double(now.velocity[v])) * per_width[c];
        }
        const double driven =
            std::sqrt(2.0 * std::abs(double(then.pressure) - double(now.pressure))) * per_width[d];
        most.reached = std::max({most.reached, dt * reached, dt * driven});
        most.changed = std::max({most.changed, dt * changed, dt * driven});
      }
    }
}

}  // namespace

BoundaryChange boundary_change(const Grid& grid, const std::array<Boundary, 6>& faces, double time,
                               double dt) {
  BoundaryChange most;
  for (int face = 0; face < 6; ++face) {
    const Boundary& boundary = faces[static_cast<std::size_t>(face)];
    if (boundary.varies && grid.active(face / 2)) look_at_face(grid, boundary, face, time, dt, most);
  }
  return most;
}

}  // namespace ejecta
