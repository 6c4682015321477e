#include "shape/fit_spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "base/error.hpp"
#include "base/parallel.hpp"
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

/// Points side by side in memory, so that all are looked at in registers; filled up to whole lanes with
/// points that have no weight.
struct Points {
  static constexpr int kLanes = 8;
  std::vector<double> x, y, z, weight;  ///< weight: 1 where a point counts, else 0

  explicit Points(const std::vector<Sample>& samples) {
    const std::size_t lanes = kLanes, count = (samples.size() + lanes - 1) / lanes * lanes;
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3& p = samples[std::min(n, samples.size() - 1)].point;
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
      weight.push_back(n < samples.size() ? 1.0 : 0.0);
    }
  }
  /// each(lane, n, way from `from` to point n) for all points.
  template <class Each>
  void visit(const Vec3& from, const Each& each) const {
    const double fx = from.x(), fy = from.y(), fz = from.z();
    const double *px = x.data(), *py = y.data(), *pz = z.data();
    for (int n = 0; n < static_cast<int>(x.size()); n += kLanes)
      for_each_in_lanes(0, kLanes, [&](int lane) {
        each(lane, n + lane, px[n + lane] - fx, py[n + lane] - fy, pz[n + lane] - fz);
      });
  }
};

/// The largest ball that touches the surface at sample `s` from inside and holds no other: of all balls
/// through `s` and another sample, tangent at `s`, the smallest. (They lie inside each other.)
Ball shrink(const Points& points, const Sample& s, double largest) {
  double radius[Points::kLanes];
  std::fill(std::begin(radius), std::end(radius), largest);
  const double ix = s.inward.x(), iy = s.inward.y(), iz = s.inward.z();
  points.visit(s.point, [&](int lane, int, double dx, double dy, double dz) {
    const double height = dx * ix + dy * iy + dz * iz, squared = dx * dx + dy * dy + dz * dz;
    const double own = 0.5 * squared / height;
    radius[lane] = height > 0 && own < radius[lane] ? own : radius[lane];
  });
  const double least = *std::min_element(std::begin(radius), std::end(radius));
  return {s.point + least * s.inward, least};
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

Advice coarser(double error) {
  return {.key = "fit_error",
          .expected = fmt::format("at least {:.4g} mm", 1e3 * error),
          .example = fmt::format("fit_error = \"{:.4g} mm\"", 1.01e3 * error)};
}

}  // namespace

std::vector<Ball> fit_spheres(const TriangleMesh& mesh, double error, const std::string& name) {
  require_closed(mesh, name);
  const double area = area_of(mesh), spacing = kSpacing * error;
  const double least = std::sqrt(4.0 * area / static_cast<double>(kMost)) / kSpacing;
  if (!(error >= least))
    throw InputError(fmt::format("{}: {:.4g} mm is too fine for this surface", name, 1e3 * error),
                     coarser(least));
  const std::vector<Sample> samples = samples_of(mesh, spacing);
  if (samples.size() > 4 * kMost)
    throw InputError(fmt::format("{}: {:.4g} mm is too fine for its slender triangles", name, 1e3 * error),
                     coarser(2.0 * error));

  Vec3 low = samples.front().point, high = low;
  for (const Sample& s : samples) {
    low = low.cwiseMin(s.point);
    high = high.cwiseMax(s.point);
  }
  // Candidates, one for balls that are nearly the same.
  Points points(samples);
  std::vector<Ball> largest(samples.size());
  for_each_index(static_cast<int>(samples.size()), [&](int n) {
    const std::size_t at = static_cast<std::size_t>(n);
    largest[at] = shrink(points, samples[at], (high - low).norm());
  });
  // By cells so wide that what is nearly the same lies in neighbours.
  std::vector<Ball> candidates;
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> cells;
  const double same = 0.15 * error;
  for (const Ball& ball : largest) {
    const auto cell = [&](int c, int step) {
      return static_cast<std::int64_t>(std::floor((ball.centre[c] - low[c]) / same)) + step;
    };
    bool known = false;
    for (int step = 0; step < 27 && !known; ++step) {
      const auto near = cells.find({cell(0, step % 3 - 1), cell(1, step / 3 % 3 - 1), cell(2, step / 9 - 1)});
      if (near == cells.end()) continue;
      known = std::any_of(near->second.begin(), near->second.end(), [&](std::size_t n) {
        const Ball& c = candidates[n];
        return (c.centre - ball.centre).norm() + std::abs(c.radius - ball.radius) < same;
      });
    }
    if (known) continue;
    cells[{cell(0, 0), cell(1, 0), cell(2, 0)}].push_back(candidates.size());
    candidates.push_back(ball);
  }
  for_each_index(static_cast<int>(candidates.size()), [&](int n) {  // inside, also between the samples
    Ball& c = candidates[static_cast<std::size_t>(n)];
    c.radius = distance_to(mesh, c.centre);
  });

  // A point weighs until a chosen ball covers it.
  const auto reach_squared = [&](const Ball& b) {
    const double reach = b.radius + kNear * error;
    return reach * reach;
  };
  double* const weight = points.weight.data();
  const auto gain = [&](const Ball& b) {
    double count[Points::kLanes] = {};
    points.visit(b.centre, [&count, weight, reach = reach_squared(b)](int lane, int n, double dx, double dy,
                                                                      double dz) {
      const double own = weight[n];
      count[lane] += dx * dx + dy * dy + dz * dz <= reach ? own : 0.0;
    });
    return static_cast<std::size_t>(std::accumulate(std::begin(count), std::end(count), 0.0));
  };
  // What a ball gains only falls as others are taken: an old figure is a bound (lazy greedy).
  std::priority_queue<std::pair<std::size_t, std::size_t>> queue;
  std::vector<std::size_t> gains(candidates.size());
  for_each_index(static_cast<int>(candidates.size()), [&](int n) {
    gains[static_cast<std::size_t>(n)] = gain(candidates[static_cast<std::size_t>(n)]);
  });
  for (std::size_t c = 0; c < candidates.size(); ++c) queue.emplace(gains[c], c);
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
    points.visit(candidates[c].centre,
                 [weight, reach = reach_squared(candidates[c])](int, int n, double dx, double dy, double dz) {
                   const double own = weight[n];
                   weight[n] = dx * dx + dy * dy + dz * dz <= reach ? 0.0 : own;
                 });
  }
  const auto missed = std::find(points.weight.begin(), points.weight.end(), 1.0);
  if (missed != points.weight.end()) {
    const Vec3& p = samples[static_cast<std::size_t>(missed - points.weight.begin())].point;
    throw InputError(
        fmt::format(
            "{}: no sphere inside comes within {:.4g} mm of the surface at ({:.4g}, {:.4g}, {:.4g}) mm", name,
            1e3 * error, 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()),
        {.key = "fit_error",
         .expected = "a larger one",
         .example = fmt::format("fit_error = \"{:.4g} mm\"", 2e3 * error)});
  }
  return chosen;
}

}  // namespace ejecta
