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

Candidates CandidateSearch::find(const Parts& parts, std::span<const Body> bodies,
                                 std::span<const Wall> walls, double skin) {
  const auto body_of = [&](int n) -> const Body& { return bodies[static_cast<std::size_t>(n)]; };
  const int balls = parts.ball_count();
  items_.clear();
  for (int n = 0; n < balls; ++n)
    items_.push_back({parts.row(n).centre(), parts.row(n).radius, parts.body_of_ball(n)});
  for (int n = 0; n < parts.polytope_count(); ++n) {
    const PolytopePart& p = parts.polytope(n);
    items_.push_back({body_of(p.body).to_world(p.solid->centre), p.solid->radius, p.body});
  }
  const auto key_of = [&](int item) {
    return item < balls ? PartKey{PartKind::ball, item, 0} : PartKey{PartKind::polytope, item - balls, 0};
  };
  const auto can_be_pushed = [&](int body) { return body_of(body).motion == Motion::free; };

  balls_.clear();
  std::vector<SolidPair> solids;
  for (const auto& [i, j] : search_.find(items_, skin)) {
    const int a = items_[static_cast<std::size_t>(i)].body, b = items_[static_cast<std::size_t>(j)].body;
    if (!can_be_pushed(a) && !can_be_pushed(b)) continue;
    if (j < balls) {
      balls_.emplace_back(i, j);
    } else {
      SolidPair pair;
      pair.a = key_of(i);
      pair.b = key_of(j);
      pair.body_a = a;
      pair.body_b = b;
      solids.push_back(pair);
    }
  }
  for (int n = 0; n < static_cast<int>(items_.size()); ++n) {
    const NeighbourSearch::Item& item = items_[static_cast<std::size_t>(n)];
    if (!can_be_pushed(item.body)) continue;
    SolidPair pair;
    pair.a = key_of(n);
    pair.body_a = item.body;
    for (int w = 0; w < static_cast<int>(walls.size()); ++w) {
      const Wall& wall = walls[static_cast<std::size_t>(w)];
      if (wall.is_plane) {
        pair.b = {PartKind::wall_plane, w, 0};
        if (wall.normal.dot(item.centre) - wall.offset < item.radius + skin) solids.push_back(pair);
      }
      for (int s = 0; s < static_cast<int>(wall.solids.size()); ++s) {
        pair.b = {PartKind::wall_solid, w, s};
        if (near_solid(item, wall.solids[static_cast<std::size_t>(s)], skin)) solids.push_back(pair);
      }
    }
  }
  std::sort(solids.begin(), solids.end(),
            [](const SolidPair& p, const SolidPair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  return {balls_, std::move(solids)};
}

}  // namespace ejecta
