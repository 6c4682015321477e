#include "dem/candidates.hpp"

#include <algorithm>
#include <tuple>

namespace ejecta {
namespace {

bool near_solid(const NeighbourSearch::Item& item, const Polytope& solid, double skin) {
  const double reach = item.radius + skin;
  if ((item.centre - solid.centre).norm() > reach + solid.radius) return false;
  return std::all_of(solid.faces.begin(), solid.faces.end(),
                     [&](const Polytope::Face& f) { return f.normal.dot(item.centre) - f.offset < reach; });
}

}  // namespace

void CandidateSearch::find(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
                           double skin) {
  const int balls = parts.ball_count();
  items_.clear();
  can_be_pushed_.clear();
  for (int n = 0; n < balls; ++n) {
    const BallRow& row = parts.row(n);
    items_.push_back({row.centre(), row.radius, parts.body_of_ball(n)});
    can_be_pushed_.push_back(row.inverse_mass > 0);
  }
  for (int n = 0; n < parts.polytope_count(); ++n) {
    const PolytopePart& p = parts.polytope(n);
    const Body& body = bodies[static_cast<std::size_t>(p.body)];
    items_.push_back({body.to_world(p.solid->centre), p.solid->radius, p.body});
    can_be_pushed_.push_back(inverse_mass(body) > 0);
  }
  const auto key_of = [&](int item) {
    return item < balls ? PartKey{PartKind::ball, item, 0} : PartKey{PartKind::polytope, item - balls, 0};
  };
  const auto body_of = [&](int item) { return items_[static_cast<std::size_t>(item)].body; };
  const auto pushed = [&](int item) { return can_be_pushed_[static_cast<std::size_t>(item)]; };

  balls_.clear();
  planes_.clear();
  solids_.clear();
  for (const auto& [i, j] : search_.find(items_, skin)) {
    if (!pushed(i) && !pushed(j)) continue;
    if (j < balls) {
      balls_.emplace_back(i, j);
    } else {
      SolidPair& pair = solids_.emplace_back();
      pair.a = key_of(i);
      pair.b = key_of(j);
      pair.body_a = body_of(i);
      pair.body_b = body_of(j);
    }
  }
  for (int n = 0; n < static_cast<int>(items_.size()); ++n) {
    if (!pushed(n)) continue;
    const NeighbourSearch::Item& item = items_[static_cast<std::size_t>(n)];
    const auto list = [&](const PartKey& wall) {
      SolidPair& pair = solids_.emplace_back();
      pair.a = key_of(n);
      pair.b = wall;
      pair.body_a = item.body;
    };
    for (int w = 0; w < static_cast<int>(walls.size()); ++w) {
      const Wall& wall = walls[static_cast<std::size_t>(w)];
      if (wall.is_plane && wall.normal.dot(item.centre) - wall.offset < item.radius + skin) {
        if (n < balls) planes_.emplace_back(n, w);
        else list({PartKind::wall_plane, w, 0});
      }
      for (int s = 0; s < static_cast<int>(wall.solids.size()); ++s)
        if (near_solid(item, wall.solids[static_cast<std::size_t>(s)], skin))
          list({PartKind::wall_solid, w, s});
    }
  }
  std::sort(solids_.begin(), solids_.end(),
            [](const SolidPair& p, const SolidPair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
}

}  // namespace ejecta
