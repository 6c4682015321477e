#include "dem/candidates.hpp"

#include <algorithm>

namespace ejecta {
namespace {

constexpr double kParallel = 1 - 1e-10;  // cosine: surfaces that lie on each other
constexpr double kSameHeight = 1e-6;     // of a ball's radius
constexpr double kShallow = 0.9;         // of a ball's radius: nearer to a plane, it has dented it deeply

bool near_solid(const NeighbourSearch::Item& item, const Polytope& solid, double skin) {
  const double reach = item.radius + skin;
  if ((item.centre - solid.centre).norm() > reach + solid.radius) return false;
  return std::all_of(solid.faces.begin(), solid.faces.end(),
                     [&](const Polytope::Face& f) { return f.normal.dot(item.centre) - f.offset < reach; });
}

/// `part`: a ball, or a polytope counted after all balls.
PartKey key_of(int part, int balls) {
  return part < balls ? PartKey{PartKind::ball, part, 0} : PartKey{PartKind::polytope, part - balls, 0};
}

}  // namespace

void CandidateSearch::list_body(int body, const Parts& parts, const Body& at) {
  const bool can_be_pushed = inverse_mass(at) > 0;
  for (int n = parts.first_ball(body); n < parts.first_ball(body + 1); ++n) {
    items_.push_back({parts.row(n).centre(), parts.row(n).radius, body});
    part_of_.push_back({n, can_be_pushed, parts.ball_count(body) == 1});
  }
  for (int n = parts.first_polytope(body); n < parts.first_polytope(body + 1); ++n) {
    const Polytope& solid = *parts.polytope(n).solid;
    items_.push_back({at.to_world(solid.centre), solid.radius, body});
    part_of_.push_back({parts.ball_count() + n, can_be_pushed});
  }
}

void CandidateSearch::list_parts(const Parts& parts, std::span<const Body> bodies) {
  items_.clear();
  part_of_.clear();
  for (int n = 0; n < static_cast<int>(bodies.size()); ++n)
    if (parts.here(n)) list_body(n, parts, bodies[static_cast<std::size_t>(n)]);
}

void CandidateSearch::add_images(const Domain& domain, double skin) {
  double largest = 0.0;
  for (const auto& item : items_) largest = std::max(largest, item.radius);
  const double margin = 2 * largest + skin;
  for (int c = 0; c < 3; ++c) {
    if (!(domain.period[c] > 0)) continue;
    const std::size_t count = items_.size();  // images of images make those across edges and corners
    for (std::size_t n = 0; n < count; ++n)
      for (const double side : {1.0, -1.0}) {
        const double x = items_[n].centre[c];
        if ((side > 0 ? x - domain.low[c] : domain.high[c] - x) > margin) continue;
        Part part = part_of_[n];
        NeighbourSearch::Item item = items_[n];
        part.image = true;
        part.shift[c] += side * domain.period[c];
        part.periods[c] += side > 0 ? 1 : -1;
        item.centre[c] += side * domain.period[c];
        items_.push_back(item);
        part_of_.push_back(part);
      }
  }
}

void CandidateSearch::put(std::size_t item, const PartKey& wall, int balls) {
  SolidPair& pair = solids_.emplace_back();
  pair.a = key_of(part_of_[item].index, balls);
  pair.b = wall;
  pair.b.image = image_of(part_of_[item].periods);
  pair.body_a = items_[item].body;
  pair.shift = -part_of_[item].shift;
}

/// Balls meet triangles, polytopes the regions they lie in; but where nothing else of the surface is near a
/// ball than the inside of a flat piece, it is a plane.
void CandidateSearch::list_surface(const Wall& wall, int index, const Domain& domain, std::size_t n,
                                   int balls, double skin, bool as_plane, const BallContacts* before) {
  const NeighbourSearch::Item& item = items_[n];
  const Surface& surface = *wall.surface;
  const double reach = item.radius + skin;
  near_.clear();
  gaps_.clear();
  surface.near(item.centre, reach, [&](int t) {
    const auto& c = surface.triangles()[static_cast<std::size_t>(t)].corners;
    const double height = surface.triangles()[static_cast<std::size_t>(t)].normal.dot(item.centre - c[0]);
    if (!(std::abs(height) < reach)) return;
    const double away = (nearest_on_triangle(item.centre, c[0], c[1], c[2]).point - item.centre).norm();
    if (!(away < reach)) return;
    near_.push_back(t);
    gaps_.push_back(away - item.radius);
  });
  if (near_.empty()) return;
  const auto region_of = [&](int t) { return surface.triangles()[static_cast<std::size_t>(t)].region; };
  if (part_of_[n].index < balls) {
    const int first = region_of(near_.front());
    if (as_plane && std::all_of(near_.begin(), near_.end(), [&](int t) { return region_of(t) == first; }) &&
        list_plane(wall, first, domain, n, reach, before))
      return;
    for (std::size_t k = 0; k < near_.size(); ++k) {
      put(n, {PartKind::wall_triangle, index, near_[k]}, balls);
      solids_.back().listed_at = item.centre - part_of_[n].shift;
      solids_.back().gap = gaps_[k];
    }
    return;
  }
  for (int& t : near_) t = region_of(t);
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
  for (const int r : near_) put(n, {PartKind::wall_region, index, r}, balls);
}

/// Whether the one region of a surface near a ball is a plane to it. One that it has dented deeply, from
/// which side so ever, is left to the triangles, which remember the side.
bool CandidateSearch::list_plane(const Wall& wall, int r, const Domain& domain, std::size_t n, double reach,
                                 const BallContacts* before) {
  const NeighbourSearch::Item& item = items_[n];
  const Surface::Region& region = wall.surface->regions()[static_cast<std::size_t>(r)];
  // A plane of the image of a wall would be another plane. And a body of several balls has one dashpot: all
  // of its contacts with the surface are kept together.
  if (!part_of_[n].only_ball || std::abs(region.plane.normal.dot(part_of_[n].shift)) > 0) return false;
  const double height = region.plane.normal.dot(item.centre) - region.plane.offset;
  const Vec3 foot = item.centre - height * region.plane.normal;
  const int ball = part_of_[n].index, front = wall.first_plane + 2 * r, back = front + 1;
  int plane = height < 0 ? back : front;
  if (before && std::abs(height) < kShallow * item.radius) {
    plane = before->touching(ball, front) >= 0 ? front : back;
    if (before->touching(ball, plane) < 0) return false;
  }
  if (!region.holds(foot, std::sqrt(std::max(0.0, reach * reach - height * height)))) return false;
  if (plane == back && !wall.surface->two_sided()) return std::abs(height) >= item.radius;
  // Of a ball and its images across periodic sides only one stands on the wall within the domain.
  for (int c = 0; c < 3; ++c) {
    const double slack = 1e-9 * domain.period[c];
    if (domain.period[c] > 0 && (foot[c] < domain.low[c] - slack || foot[c] >= domain.high[c] - slack))
      return true;
  }
  planes_.emplace_back(ball, plane);
  return true;
}

/// Walls that lie on each other in one plane push a ball once. Of planes that look the same way the highest
/// stands for all, of those as high the first; what of other surfaces lies wholly under a wall that is a
/// plane is covered by it. Where another surface that ends near the ball lies in a flat region, both are
/// looked at triangle by triangle, as one surface.
void CandidateSearch::drop_doubles(std::span<const Wall> walls, const Domain& domain, std::size_t n,
                                   int balls, double skin, const BallContacts* before,
                                   std::size_t first_plane, std::size_t first_solid) {
  const NeighbourSearch::Item item = items_[n];
  const double slack = kSameHeight * item.radius;
  flats_.clear();
  for (std::size_t k = first_plane; k < planes_.size(); ++k) {
    const int plane = planes_[k].second;
    int w = static_cast<int>(walls.size()) - 1;
    while (walls[static_cast<std::size_t>(w)].first_plane > plane) --w;
    const Wall& wall = walls[static_cast<std::size_t>(w)];
    HalfSpace at{wall.normal, wall.offset};
    if (!wall.is_plane) {
      at = wall.surface->regions()[static_cast<std::size_t>((plane - wall.first_plane) / 2)].plane;
      if ((plane - wall.first_plane) % 2) at = {-at.normal, -at.offset};
    }
    flats_.push_back({at.normal, at.normal.dot(item.centre) - at.offset, w, plane});
  }
  for (std::size_t k = 0; k < flats_.size(); ++k)
    for (std::size_t m = 0; m < flats_.size() && flats_[k].kept; ++m) {
      const Flat &low = flats_[k], &high = flats_[m];
      if (m == k || !high.kept || !(low.normal.dot(high.normal) > kParallel)) continue;
      flats_[k].kept = low.height < high.height - slack || (low.height <= high.height + slack && k < m);
    }
  const auto corners_of = [&](const SolidPair& p) -> const Surface::Triangle& {
    return walls[static_cast<std::size_t>(p.b.index)]
        .surface->triangles()[static_cast<std::size_t>(p.b.solid)];
  };
  const std::size_t listed = solids_.size();
  for (Flat& f : flats_) {
    if (!f.kept) continue;
    const Vec3 foot = item.centre - f.height * f.normal;
    const auto above = [&](const Vec3& p) { return f.normal.dot(p - foot); };
    const auto lies_in = [&](const SolidPair& p) {
      const Surface::Triangle& t = corners_of(p);
      return p.b.index != f.wall && std::abs(t.normal.dot(f.normal)) > kParallel &&
             std::abs(above(t.corners[0])) <= slack;
    };
    const auto from = solids_.begin() + static_cast<std::ptrdiff_t>(first_solid);
    if (walls[static_cast<std::size_t>(f.wall)].is_plane) {
      solids_.erase(std::remove_if(from, solids_.end(),
                                   [&](const SolidPair& p) {
                                     const auto& corners = corners_of(p).corners;
                                     return std::all_of(corners.begin(), corners.end(),
                                                        [&](const Vec3& c) { return above(c) <= slack; });
                                   }),
                    solids_.end());
    } else if (std::any_of(from,
                           from + static_cast<std::ptrdiff_t>(std::min(listed, solids_.size()) - first_solid),
                           lies_in)) {
      f.kept = false;
      list_surface(walls[static_cast<std::size_t>(f.wall)], f.wall, domain, n, balls, skin, false, before);
    }
  }
  planes_.resize(first_plane);
  for (const Flat& f : flats_)
    if (f.kept) planes_.emplace_back(part_of_[n].index, f.plane);
}

void CandidateSearch::list_walls(std::span<const Wall> walls, const Domain& domain, int balls, double skin,
                                 const BallContacts* before) {
  for (std::size_t n = 0; n < items_.size(); ++n) {
    if (!part_of_[n].can_be_pushed) continue;
    const NeighbourSearch::Item& item = items_[n];
    const bool ball = part_of_[n].index < balls;
    const std::size_t first_plane = planes_.size(), first_solid = solids_.size();
    for (int w = 0; w < static_cast<int>(walls.size()); ++w) {
      const Wall& wall = walls[static_cast<std::size_t>(w)];
      if (!ball && wall.covered) continue;
      if (wall.is_plane) {
        if (part_of_[n].image || !(wall.normal.dot(item.centre) - wall.offset < item.radius + skin)) continue;
        if (ball) planes_.emplace_back(part_of_[n].index, wall.first_plane);
        else put(n, {PartKind::wall_plane, w, 0}, balls);
      } else if (ball || wall.solids.empty()) {
        list_surface(wall, w, domain, n, balls, skin, true, before);
      } else {
        for (int s = 0; s < static_cast<int>(wall.solids.size()); ++s)
          if (near_solid(item, wall.solids[static_cast<std::size_t>(s)], skin))
            put(n, {PartKind::wall_solid, w, s}, balls);
      }
    }
    const std::size_t planes = planes_.size() - first_plane, solids = solids_.size() - first_solid;
    if (ball && planes > 0 && planes + solids > 1)
      drop_doubles(walls, domain, n, balls, skin, before, first_plane, first_solid);
  }
}

void CandidateSearch::find_walls(int body, const Parts& parts, std::span<const Body> bodies,
                                 std::span<const Wall> walls, const Domain& domain) {
  items_.clear();
  part_of_.clear();
  planes_.clear();
  solids_.clear();
  list_body(body, parts, bodies[static_cast<std::size_t>(body)]);
  if (domain.periodic()) add_images(domain, 0.0);
  list_walls(walls, domain, parts.ball_count(), 0.0, nullptr);
}

void CandidateSearch::find(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
                           const Domain& domain, double skin, const BallContacts* before) {
  list_parts(parts, bodies);
  if (domain.periodic()) add_images(domain, skin);
  const int balls = parts.ball_count();
  balls_.clear();
  planes_.clear();
  solids_.clear();
  for (auto [i, j] : search_.find(items_, skin)) {
    if (part_of_[static_cast<std::size_t>(i)].index > part_of_[static_cast<std::size_t>(j)].index)
      std::swap(i, j);
    const Part &a = part_of_[static_cast<std::size_t>(i)], &b = part_of_[static_cast<std::size_t>(j)];
    if ((!a.can_be_pushed && !b.can_be_pushed) || (a.image && b.image)) continue;
    if (b.index < balls) {
      balls_.emplace_back(a.index, b.index);
    } else {
      SolidPair& pair = solids_.emplace_back();
      pair.a = key_of(a.index, balls);
      pair.b = key_of(b.index, balls);
      pair.body_a = items_[static_cast<std::size_t>(i)].body;
      pair.body_b = items_[static_cast<std::size_t>(j)].body;
      pair.shift = b.shift - a.shift;
    }
  }
  list_walls(walls, domain, balls, skin, before);
  std::sort(planes_.begin(), planes_.end());
  const auto same = [](const SolidPair& p, const SolidPair& q) { return p.a == q.a && p.b == q.b; };
  std::sort(solids_.begin(), solids_.end(), is_before);
  if (!domain.periodic()) return;
  // A pair across a side was found from both.
  std::sort(balls_.begin(), balls_.end());
  balls_.erase(std::unique(balls_.begin(), balls_.end()), balls_.end());
  solids_.erase(std::unique(solids_.begin(), solids_.end(), same), solids_.end());
}

}  // namespace ejecta
