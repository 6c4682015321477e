#include "sorter/camera.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/joined_sets.hpp"
#include "base/random.hpp"

namespace ejecta {
namespace {

/// Covered pixels beside each other on a line.
struct Run {
  std::int64_t line = 0;
  int first = 0, last = 0;
  int particle = 0;
};

/// The pixels whose centres lie in a convex outline, line by line.
void rasterise(const std::vector<Vec3>& outline, int particle, double pixel, double half_width, int pixels,
               std::vector<Run>& runs) {
  double low = 1e300, high = -1e300;
  for (const Vec3& p : outline) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  const auto first = static_cast<std::int64_t>(std::ceil(low / pixel - 0.5)),
             last = static_cast<std::int64_t>(std::floor(high / pixel - 0.5));
  for (std::int64_t line = first; line <= last; ++line) {
    const double x = (static_cast<double>(line) + 0.5) * pixel;
    double left = 1e300, right = -1e300;
    for (std::size_t n = 0; n < outline.size(); ++n) {
      const Vec3 &a = outline[n], &b = outline[(n + 1) % outline.size()];
      if ((a.x() - x) * (b.x() - x) > 0.0 || a.x() == b.x()) continue;
      const double y = a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
      left = std::min(left, y);
      right = std::max(right, y);
    }
    const int from = std::max(0, static_cast<int>(std::ceil((left + half_width) / pixel - 0.5))),
              to = std::min(pixels - 1, static_cast<int>(std::floor((right + half_width) / pixel - 0.5)));
    if (from <= to) runs.push_back({line, from, to, particle});
  }
}

}  // namespace

Camera::Camera(const Case& c)
    : spec_(c.camera),
      classes_(c.classes),
      seed_(c.sorter.seed),
      pixel_(c.sorter.belt_width / c.camera.pixels),
      half_width_(0.5 * c.sorter.belt_width) {
  double sum[2] = {0, 0}, share[2] = {0, 0};
  for (const ParticleClassSpec& k : classes_) {
    sum[k.eject] += k.share * k.signal;
    share[k.eject] += k.share;
    given_confusion_ = given_confusion_ || k.read_as_eject.has_value();
  }
  const double keep = share[0] > 0.0 ? sum[0] / share[0] : -1.0,
               eject = share[1] > 0.0 ? sum[1] / share[1] : 1.0;
  threshold_ = spec_.threshold.value_or(0.5 * (keep + eject));
  eject_above_ = eject >= keep;
}

std::vector<SeenObject> Camera::look(std::span<const FeedParticle> particles) const {
  std::vector<Run> runs;
  for (std::size_t n = 0; n < particles.size(); ++n)
    rasterise(outline_of(particles[n]), static_cast<int>(n), pixel_, half_width_, spec_.pixels, runs);
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return a.line != b.line ? a.line < b.line : a.first < b.first;
  });
  // Joined are pixels that touch, and those with less than the gap between them.
  const int reach = 1 + static_cast<int>(std::floor(spec_.gap / pixel_));
  JoinedSets sets(runs.size());
  std::size_t window = 0;  // the first run on a line within reach
  for (std::size_t n = 0; n < runs.size(); ++n) {
    while (runs[window].line < runs[n].line - reach) ++window;
    for (std::size_t m = window; m < n; ++m)
      if (runs[m].first <= runs[n].last + reach && runs[n].first <= runs[m].last + reach) sets.join(n, m);
  }
  std::vector<SeenObject> objects;
  std::map<std::size_t, std::size_t> place;  // of the object of a root
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const auto [at, fresh] = place.try_emplace(sets.of(n), objects.size());
    if (fresh) {
      objects.emplace_back();
      objects.back().x_low = objects.back().y_low = 1e300;
      objects.back().x_high = objects.back().y_high = -1e300;
    }
    SeenObject& o = objects[at->second];
    const Run& r = runs[n];
    const auto count = r.last - r.first + 1;
    o.x_low = std::min(o.x_low, static_cast<double>(r.line) * pixel_);
    o.x_high = std::max(o.x_high, static_cast<double>(r.line + 1) * pixel_);
    o.y_low = std::min(o.y_low, r.first * pixel_ - half_width_);
    o.y_high = std::max(o.y_high, (r.last + 1) * pixel_ - half_width_);
    o.x += count * (static_cast<double>(r.line) + 0.5) * pixel_;
    o.y += count * (0.5 * (r.first + r.last + 1) * pixel_ - half_width_);
    o.signal += count * particles[static_cast<std::size_t>(r.particle)].signal;
    o.pixels += count;
    o.members.push_back(r.particle);
  }
  std::erase_if(objects, [&](const SeenObject& o) { return o.pixels < spec_.least_pixels; });
  for (SeenObject& o : objects) {
    std::sort(o.members.begin(), o.members.end());
    o.members.erase(std::unique(o.members.begin(), o.members.end()), o.members.end());
    const auto count = static_cast<double>(o.pixels);
    o.x /= count;
    o.y /= count;
    o.signal /= count;
    o.eject = reads_eject(o, particles);
  }
  return objects;
}

bool Camera::reads_eject(const SeenObject& o, std::span<const FeedParticle> particles) const {
  // Of an object's draws the number is that of its first particle.
  const FeedParticle& first = particles[static_cast<std::size_t>(o.members.front())];
  constexpr std::uint64_t stream = std::uint64_t{1} << 62;
  const CounterRandom random(static_cast<std::uint64_t>(seed_), stream + first.id);
  if (given_confusion_) {  // what it is taken for is decided by its largest particle
    const auto largest = std::max_element(o.members.begin(), o.members.end(), [&](int a, int b) {
      return particles[static_cast<std::size_t>(a)].mass < particles[static_cast<std::size_t>(b)].mass;
    });
    const ParticleClassSpec& k =
        classes_[static_cast<std::size_t>(particles[static_cast<std::size_t>(*largest)].kind)];
    return random.uniform(0) < k.read_as_eject.value_or(k.eject ? 1.0 : 0.0);
  }
  const double signal = o.signal + spec_.noise / std::sqrt(static_cast<double>(o.pixels)) * random.normal(1);
  return (signal > threshold_) == eject_above_;
}

}  // namespace ejecta
