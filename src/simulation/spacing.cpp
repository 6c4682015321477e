#include "simulation/spacing.hpp"

#include <algorithm>
#include <limits>

namespace ejecta {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// How far points of a's surface stay from b, m; `shift` brings b to its nearest image.
double corners_from(const Body& a, const std::vector<Vec3>& corners, const Body& b, const Vec3& shift) {
  double least = kFar;
  for (const Vec3& corner : corners) least = std::min(least, b.signed_distance(a.to_world(corner) - shift));
  return least;
}

}  // namespace

std::vector<Spacing> spacings(const Particles& particles) {
  const auto bodies = particles.bodies();
  std::vector<std::vector<Vec3>> corners;
  for (const Body& b : bodies) corners.push_back(b.shape.surface().vertices);
  std::vector<Spacing> all;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    if (particles.presence(i) != Presence::here) continue;
    const Body& a = bodies[static_cast<std::size_t>(i)];
    Spacing s{i, -1, kFar, kFar};
    for (int j = 0; j < static_cast<int>(bodies.size()); ++j) {
      if (j == i || particles.presence(j) != Presence::here) continue;
      const Body& b = bodies[static_cast<std::size_t>(j)];
      const Vec3 shift = particles.domain().whole(a.position - b.position);
      const double apart = (a.position - b.position - shift).norm();
      s.centre = std::min(s.centre, apart);
      if (apart - a.shape.bounding_radius() - b.shape.bounding_radius() >= s.gap) continue;
      const double gap = std::min(corners_from(a, corners[static_cast<std::size_t>(i)], b, shift),
                                  corners_from(b, corners[static_cast<std::size_t>(j)], a, Vec3(-shift)));
      if (gap < s.gap) s.gap = gap, s.neighbour = j;
    }
    if (s.neighbour >= 0) all.push_back(s);
  }
  return all;
}

bool belt_runs(const Particles& particles) {
  const auto walls = particles.walls();
  return std::any_of(walls.begin(), walls.end(), [](const Wall& w) { return w.velocity.norm() > 0; });
}

void add_spacing(const Particles& particles, nlohmann::ordered_json& result) {
  if (!belt_runs(particles)) return;
  const auto walls = particles.walls();
  const std::vector<Spacing> all = spacings(particles);
  if (all.empty()) return;
  std::vector<double> gaps, centres;
  for (const Spacing& s : all) {
    gaps.push_back(s.gap);
    centres.push_back(s.centre);
  }
  std::sort(gaps.begin(), gaps.end());
  const auto mean = [](const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v) sum += x;
    return sum / static_cast<double>(v.size());
  };
  double sliding = 0.0;
  int touching = 0;
  for (const ContactRecord& c : particles.contacts()) {
    if (c.b >= 0) {
      ++touching;
      continue;
    }
    const Vec3 wall = walls[static_cast<std::size_t>(-1 - c.b)].velocity;
    if (wall.norm() > 0)
      sliding = std::max(sliding, (particles.bodies()[static_cast<std::size_t>(c.a)].velocity - wall).norm());
  }
  auto& out = result["spacing"];
  out["bodies"] = all.size();
  out["mean_gap_m"] = mean(gaps);
  out["median_gap_m"] = gaps[gaps.size() / 2];
  out["least_gap_m"] = gaps.front();
  out["mean_centre_distance_m"] = mean(centres);
  out["contacts_between_bodies"] = touching;
  out["max_speed_relative_to_belt_m_s"] = sliding;
}

}  // namespace ejecta
