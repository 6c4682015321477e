#include "dem/grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "case/load.hpp"
#include "case/size_distribution.hpp"

namespace ejecta {
namespace {

/// Streams of random numbers: of a group kStreams more than of the one before it.
constexpr std::uint64_t kSizes = 1, kPlaces = 2, kStreams = 2;
constexpr int kTries = 2000;         // of a grain that looks for its place
constexpr double kRarest = 0.00135;  // beyond three standard deviations none is drawn

/// The key that says how many there are.
std::string amount_of(const GrainsSpec& g) {
  return g.count > 0 ? "count" : g.mass ? "mass" : "solids_fraction";
}

InputError no_room(const GrainsSpec& g, const std::string& what) {
  return InputError(fmt::format("grains \"{}\": {}", g.name, what),
                    {.key = amount_of(g),
                     .expected = "less of them, or a larger region; as a lattice more find room",
                     .example = "packing = \"lattice\""});
}

double volume_of(double d) { return std::numbers::pi / 6 * d * d * d; }

std::vector<double> draw_sizes(const GrainsSpec& g, std::uint64_t group, double density,
                               const std::string& folder) {
  const CounterRandom random(static_cast<std::uint64_t>(g.seed), kSizes + kStreams * group);
  const SizeDistribution distribution = size_distribution(g, folder);
  const auto draw = [&](std::size_t n) {
    return distribution.quantile(std::clamp(random.uniform(n), kRarest, 1.0 - kRarest));
  };
  std::vector<double> sizes;
  if (g.count > 0) {
    for (std::size_t n = 0; n < static_cast<std::size_t>(g.count); ++n) sizes.push_back(draw(n));
    return sizes;
  }
  const double room = ((*g.region)[1] - (*g.region)[0]).prod();
  const double wanted = g.mass ? *g.mass / density : *g.solids_fraction * room;
  // The last one is taken where that brings the sum nearer.
  for (double sum = 0;;) {
    const double d = draw(sizes.size()), v = volume_of(d);
    if (sum + 0.5 * v > wanted) return sizes;
    sum += v;
    sizes.push_back(d);
  }
}

/// A face-centred cubic lattice, stretched to fill the region: points of a simple one of which every other is
/// taken. Where there are more of these than grains some stay empty, evenly.
std::vector<Vec3> lattice_places(const GrainsSpec& g, std::size_t count, double d, const Domain& domain) {
  const Vec3 low = (*g.region)[0], edges = (*g.region)[1] - low;
  bool periodic[3];
  for (int a = 0; a < 3; ++a)
    periodic[a] = domain.period[a] > 0 && std::abs(edges[a] - domain.period[a]) < 1e-9 * edges[a];
  int n[3];
  const auto points = [&](double step) {
    double all = 0.5;
    for (int a = 0; a < 3; ++a) {
      n[a] = periodic[a] ? 2 * static_cast<int>(edges[a] / (2 * step) + 1e-9)
                         : 1 + static_cast<int>((edges[a] - d) / step + 1e-9);
      all *= n[a];
    }
    return all;
  };
  double step = std::cbrt(edges.prod() / (2.0 * static_cast<double>(count)));
  while (step > 0.4 * d && points(step) < static_cast<double>(count)) step *= 0.999;
  Vec3 h;
  for (int a = 0; a < 3; ++a)
    h[a] = periodic[a] ? edges[a] / n[a] : n[a] > 1 ? (edges[a] - d) / (n[a] - 1) : 1e300;
  const double nearest = std::min({std::hypot(h[0], h[1]), std::hypot(h[1], h[2]), std::hypot(h[0], h[2])});
  if (points(step) < static_cast<double>(count) || nearest < d * (1 - 1e-9))
    throw no_room(
        g, fmt::format("{} of {:.4g} mm do not fit into the region even as a lattice", count, 1e3 * d));
  std::vector<Vec3> places;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = (j + k) % 2; i < n[0]; i += 2) {
        Vec3 x;
        const int at[3] = {i, j, k};
        for (int a = 0; a < 3; ++a)
          x[a] = low[a] + (periodic[a] ? (at[a] + 0.25) * h[a]
                           : n[a] > 1  ? 0.5 * d + at[a] * h[a]
                                       : 0.5 * edges[a]);
        places.push_back(x);
      }
  if (places.size() < count)
    throw no_room(g, fmt::format("only {} of {} fit into the region as a lattice", places.size(), count));
  for (std::size_t n = 0; n < count; ++n) places[n] = places[n * places.size() / count];
  places.resize(count);
  return places;
}

/// Places one after the other, each clear of those before (random sequential addition).
class RandomPlaces {
 public:
  /// `count`: of those that places are looked for. Cells hold the largest, and are about as many.
  RandomPlaces(const GrainsSpec& g, double largest, std::size_t count, const Particles& particles,
               const std::vector<Body>& made)
      : particles_(particles), low_((*g.region)[0]), edges_((*g.region)[1] - low_) {
    const double all = static_cast<double>(count + made.size());
    const double width = std::max(largest, std::cbrt(edges_.prod() / all));
    for (int a = 0; a < 3; ++a) {
      const double period = particles.domain().period[a];
      periodic_[a] = period > 0 && std::abs(edges_[a] - period) < 1e-9 * edges_[a];
      n_[a] = static_cast<int>(std::clamp(edges_[a] / width, 1.0, 1e3));
    }
    cells_.resize(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) *
                  static_cast<std::size_t>(n_[2]));
    for (const Body& b : made)
      if (!b.enters_at) cells_[index(b.position)].push_back({b.position, b.shape.bounding_radius()});
  }

  /// Nothing where no try found room.
  std::optional<Vec3> find(double d, const CounterRandom& random) {
    for (int t = 0; t < kTries; ++t) {
      Vec3 x;
      for (int a = 0; a < 3; ++a) {
        const double margin = periodic_[a] ? 0.0 : 0.5 * d;
        x[a] = low_[a] + margin + (edges_[a] - 2 * margin) * random.uniform(next_++);
      }
      if (!clear(x, 0.5 * d)) continue;
      cells_[index(x)].push_back({x, 0.5 * d});
      return x;
    }
    return {};
  }

  /// Whether a ball there would lie in a grain that is placed.
  bool meets_grains(const Vec3& x, double r) const {
    constexpr double kTouching = 1 - 1e-9;
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a) {
          int p[3] = {cell(x, 0) + a, cell(x, 1) + b, cell(x, 2) + c};
          bool inside = true;
          for (int d = 0; d < 3; ++d) {
            if (periodic_[d]) p[d] = (p[d] + n_[d]) % n_[d];
            inside = inside && p[d] >= 0 && p[d] < n_[d];
          }
          if (!inside) continue;
          for (const Ball& ball : cells_[at(p[0], p[1], p[2])])
            if (particles_.domain().nearest(ball.centre - x).norm() < kTouching * (ball.radius + r))
              return true;
        }
    return false;
  }

 private:
  struct Ball {
    Vec3 centre;
    double radius;
  };
  int cell(const Vec3& x, int a) const {
    return std::clamp(static_cast<int>((x[a] - low_[a]) / edges_[a] * n_[a]), 0, n_[a] - 1);
  }
  std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(i);
  }
  std::size_t index(const Vec3& x) const { return at(cell(x, 0), cell(x, 1), cell(x, 2)); }

  bool clear(const Vec3& x, double r) const {
    if (meets_grains(x, r)) return false;
    const Domain& domain = particles_.domain();
    for (const Body& body : particles_.bodies()) {
      const Vec3 nearest = body.position + domain.nearest(x - body.position);
      const double reach = body.shape.bounding_radius() + r;
      if ((nearest - body.position).squaredNorm() < reach * reach && body.signed_distance(nearest) < r)
        return false;
    }
    return std::ranges::none_of(particles_.walls(), [&](const Wall& w) {
      return w.is_plane ? w.normal.dot(x) - w.offset < r : w.surface->contains(x);
    });
  }

  const Particles& particles_;
  Vec3 low_, edges_;
  bool periodic_[3];
  int n_[3];
  std::vector<std::vector<Ball>> cells_;
  std::uint64_t next_ = 0;
};

void add_group(const GrainsSpec& g, std::uint64_t group, const std::string& folder,
               const Particles& particles, std::vector<Body>& made) {
  const int material = particles.materials().index(g.material);
  const double density = g.density.value_or(particles.materials().spec(material).density);
  const std::vector<double> sizes = draw_sizes(g, group, density, folder);
  if (sizes.empty())
    throw InputError(
        fmt::format("grains \"{}\": not even one makes up what is asked for", g.name),
        {.key = amount_of(g), .expected = "more of them, or smaller ones", .example = "count = 100"});
  const double largest = *std::max_element(sizes.begin(), sizes.end());
  const CounterRandom random(static_cast<std::uint64_t>(g.seed), kPlaces + kStreams * group);
  double widest = largest;  // of all that have to keep clear of each other
  for (const Body& b : made) widest = std::max(widest, 2 * b.shape.bounding_radius());
  std::vector<Vec3> places;
  if (g.packing == GrainPacking::lattice) {
    places = lattice_places(g, sizes.size(), largest, particles.domain());
    const RandomPlaces taken(g, widest, 1, particles, made);
    for (std::size_t n = 0; n < sizes.size(); ++n)
      if (taken.meets_grains(places[n], 0.5 * sizes[n]))
        throw InputError(
            fmt::format("grains \"{}\": number {} of the lattice would lie in a grain of another", g.name,
                        n + 1),
            {.key = "region",
             .expected = "regions that do not overlap; at random grains keep clear of others",
             .example = "packing = \"random\""});
  } else if (g.over > 0) {  // those who come find the place free or wait
    for (std::size_t n = 0; n < sizes.size(); ++n) {
      const Vec3 low = (*g.region)[0], edges = (*g.region)[1] - low;
      Vec3 x;
      for (int a = 0; a < 3; ++a)
        x[a] = low[a] + 0.5 * sizes[n] +
               (edges[a] - sizes[n]) * random.uniform(3 * n + static_cast<std::size_t>(a));
      places.push_back(x);
    }
  } else {
    RandomPlaces room(g, widest, sizes.size(), particles, made);
    for (std::size_t n = 0; n < sizes.size(); ++n) {
      const auto x = room.find(sizes[n], random);
      if (!x)
        throw no_room(g, fmt::format("number {} of {} finds no place in the region at random after {} tries",
                                     n + 1, sizes.size(), kTries));
      places.push_back(*x);
    }
  }
  std::optional<Shape> shape;
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    const double d = sizes[n];
    if (!shape || n == 0 || sizes[n - 1] != d) shape = make_sphere(d);
    Body body{.name = g.name, .shape = *shape, .enters_at = {}};
    body.mass = density * volume_of(d);
    body.inertia = Vec3::Constant(0.1 * body.mass * d * d);
    body.material = material;
    body.motion = g.held ? Motion::fixed : Motion::free;
    body.position = places[n];
    body.velocity = g.velocity;
    if (g.from > 0 || g.over > 0)
      body.enters_at = g.from + g.over * static_cast<double>(n) / static_cast<double>(sizes.size());
    made.push_back(std::move(body));
  }
}

}  // namespace

void add_grains(const Case& c, Particles& particles) {
  std::vector<Body> made;
  for (std::size_t n = 0; n < c.grains.size(); ++n) add_group(c.grains[n], n, folder_of(c), particles, made);
  for (Body& body : made) particles.add(std::move(body));
}

}  // namespace ejecta
