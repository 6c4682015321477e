#include "shape/fit_spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "base/error.hpp"
#include "shape/polytope.hpp"

namespace ejecta {
namespace {

constexpr double kSpacing = 0.5;  // of samples over the error
constexpr double kNear = 0.6;     // a sample this near (over the error) to a ball counts as covered: with the
                                  // half diagonal of the samples, 0.36, the surface between them is as well
constexpr std::size_t kMost = 40000;  // samples

/// A point of the surface and the unit normal that looks inwards there.
struct Sample {
  Vec3 point, inward;
};

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                      .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
                      .norm();
  }
  return area;
}

/// Centres of the small triangles into which each triangle is divided, none with an edge longer than
/// `spacing`.
std::vector<Sample> samples_of(const TriangleMesh& mesh, double spacing) {
  std::vector<Sample> samples;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a;
    const Vec3 ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
    const Vec3 inward = -ab.cross(ac).normalized();
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int n = static_cast<int>(std::ceil(longest / spacing));
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        for (const double third : {1.0 / 3, 2.0 / 3})
          if (third < 0.5 || i + j + 1 < n)
            samples.push_back({a + (i + third) / n * ab + (j + third) / n * ac, inward});
  }
  return samples;
}

/// The largest ball that touches the surface at sample `s` from inside and holds no other: of all balls
/// through `s` and another sample, tangent at `s`, the smallest. (They lie inside each other.)
Ball shrink(const std::vector<Sample>& samples, const Sample& s, double largest) {
  double radius = largest;
  for (const Sample& q : samples) {
    const Vec3 way = q.point - s.point;
    const double height = way.dot(s.inward), squared = way.squaredNorm();
    if (2 * radius * height > squared) radius = 0.5 * squared / height;
  }
  return {s.point + radius * s.inward, radius};
}

double distance_to(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    least = std::min(least, (nearest_on_triangle(p, mesh.vertices[static_cast<std::size_t>(t[0])],
                                                 mesh.vertices[static_cast<std::size_t>(t[1])],
                                                 mesh.vertices[static_cast<std::size_t>(t[2])])
                                 .point -
                             p)
                                .norm());
  return least;
}

}  // namespace

std::vector<Ball> fit_spheres(const TriangleMesh& mesh, double error, const std::string& name) {
  require_closed(mesh, name);
  const double area = area_of(mesh), spacing = kSpacing * error;
  const double least = std::sqrt(4.0 * area / static_cast<double>(kMost)) / kSpacing;
  if (!(error >= least))
    throw InputError(fmt::format("{}: fit_error = {:.4g} mm is too fine for this surface; at least {:.4g} mm",
                                 name, 1e3 * error, 1e3 * least));
  const std::vector<Sample> samples = samples_of(mesh, spacing);
  if (samples.size() > 4 * kMost)
    throw InputError(
        fmt::format("{}: fit_error = {:.4g} mm is too fine for its slender triangles; try {:.4g} mm", name,
                    1e3 * error, 2e3 * error));

  Vec3 low = samples.front().point, high = low;
  for (const Sample& s : samples) {
    low = low.cwiseMin(s.point);
    high = high.cwiseMax(s.point);
  }
  // Candidates, one for balls that are nearly the same.
  std::vector<Ball> candidates;
  for (const Sample& s : samples) {
    const Ball ball = shrink(samples, s, (high - low).norm());
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Ball& c) {
      return (c.centre - ball.centre).norm() + std::abs(c.radius - ball.radius) < 0.15 * error;
    });
    if (!known) candidates.push_back(ball);
  }
  for (Ball& c : candidates) c.radius = distance_to(mesh, c.centre);  // inside, also between the samples

  const auto covers = [&](const Ball& b, const Sample& s) {
    return (s.point - b.centre).norm() - b.radius <= kNear * error;
  };
  std::vector<char> covered(samples.size(), 0);
  const auto gain = [&](const Ball& b) {
    std::size_t count = 0;
    for (std::size_t n = 0; n < samples.size(); ++n) count += !covered[n] && covers(b, samples[n]);
    return count;
  };
  // What a ball gains only falls as others are taken: an old figure is a bound (lazy greedy).
  std::priority_queue<std::pair<std::size_t, std::size_t>> queue;
  for (std::size_t c = 0; c < candidates.size(); ++c) queue.emplace(gain(candidates[c]), c);
  std::vector<Ball> chosen;
  while (!queue.empty()) {
    const std::size_t c = queue.top().second;
    queue.pop();
    const std::size_t now = gain(candidates[c]);
    if (now == 0) continue;
    if (!queue.empty() && now < queue.top().first) {
      queue.emplace(now, c);
      continue;
    }
    chosen.push_back(candidates[c]);
    for (std::size_t n = 0; n < samples.size(); ++n) covered[n] |= covers(candidates[c], samples[n]);
  }
  const auto missed = std::find(covered.begin(), covered.end(), 0);
  if (missed != covered.end()) {
    const Vec3& p = samples[static_cast<std::size_t>(missed - covered.begin())].point;
    throw InputError(fmt::format(
        "{}: no sphere inside comes within {:.4g} mm of the surface at ({:.4g}, {:.4g}, {:.4g}) mm; a larger "
        "fit_error is needed",
        name, 1e3 * error, 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()));
  }
  return chosen;
}

}  // namespace ejecta
