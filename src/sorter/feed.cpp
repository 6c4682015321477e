#include "sorter/feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "case/csv_table.hpp"
#include "case/load.hpp"
#include "sorter/plan_view.hpp"

namespace ejecta {
namespace {

constexpr double kCell = 0.5;          ///< m, of the strip, where particles are not huge
constexpr double kCellOverSize = 5.0;  ///< at least this many of the largest particle
constexpr int kTries = 4000;           ///< to lay a particle where none lies
/// Random sequential laying of equal squares or discs ends at 0.53 to 0.55 (Feder 1980; Viot & Tarjus 1990).
constexpr double kMostCover = 0.45;
/// How full one cell may be by chance: the fullest of some thousands.
constexpr double kFullestCell = 0.5, kDeviationsOfFullest = 4.0;
constexpr double kParticlesACell = 100.0;     ///< of a monolayer: fewer vary too much from cell to cell
constexpr double kLongestRun = 10 * 86400.0;  ///< s, of the belt: even empty cells take time

double belt_carries(const Case& c) { return c.launch.belt_speed * c.sorter.belt_width; }  ///< m2/s

/// Speed of the tray of a feeder over the belt's; of what lies on the belt 1.
double tray_of(const Case& c) {
  return c.feed.presentation == Presentation::feeder ? c.feed.lip_speed / c.launch.belt_speed : 1.0;
}

/// m, of a cell of the strip.
double cell_length_of(const Case& c, const std::vector<ParticleClass>& classes) {
  double largest = 0.0, per_mass = 0.0;  // m; particles a kg
  for (const ParticleClass& k : classes) {
    largest = std::max(largest, k.size_at(1.0 - 1e-6) / k.spec().elongation);
    per_mass += k.spec().share / k.mean_mass();
  }
  const double tray = tray_of(c);
  double length = std::max(kCell, kCellOverSize * largest / std::min(tray, 1.0));
  const double per_metre = c.sorter.throughput * per_mass / c.launch.belt_speed;
  if (c.feed.presentation == Presentation::monolayer && per_metre > 0.0)
    length = std::max(length, std::min(kParticlesACell / per_metre, 20.0 * length));
  return length;
}

double radius_of(const FeedParticle& p) {
  double most = 0.0;
  for (const Vec3& v : p.prototype->outline) most = std::max(most, v.norm());
  return p.scale * most;
}

/// Draws from a Poisson distribution: how many unit exponential intervals fit into the mean.
int poisson(double mean, const CounterRandom& random, std::uint64_t& at) {
  int count = 0;
  for (double sum = -std::log(random.uniform(at++)); sum < mean; sum -= std::log(random.uniform(at++)))
    ++count;
  return count;
}

/// Which draws a cell makes: streams of random numbers.
enum Stream : std::uint64_t { counts, properties, places, streams };
CounterRandom stream_of(std::int64_t seed, std::int64_t cell, Stream stream) {
  const auto number = static_cast<std::uint64_t>(cell + (std::int64_t{1} << 40));
  return {static_cast<std::uint64_t>(seed), number * streams + stream};
}

/// Finds what lies near, in squares of the plane.
class Squares {
 public:
  Squares(double reach) : side_(2.0 * reach) {}
  void add(const FeedParticle& p) { squares_[square(p.x, p.y)].push_back({p, radius_of(p), outline_of(p)}); }
  bool is_free(const FeedParticle& p, double radius) const {
    std::vector<Vec3> outline;
    const auto [i, j] = square(p.x, p.y);
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        const auto found = squares_.find({i + di, j + dj});
        if (found == squares_.end()) continue;
        for (const Laid& other : found->second) {
          const double apart = std::hypot(p.x - other.particle.x, p.y - other.particle.y);
          if (apart > radius + other.radius) continue;
          if (outline.empty()) outline = outline_of(p);
          if (within_gap(outline, other.outline, 0.0)) return false;
        }
      }
    return true;
  }

 private:
  struct Laid {
    FeedParticle particle;
    double radius;
    std::vector<Vec3> outline;
  };
  using Square = std::pair<std::int64_t, std::int64_t>;
  Square square(double x, double y) const {
    return {static_cast<std::int64_t>(std::floor(x / side_)),
            static_cast<std::int64_t>(std::floor(y / side_))};
  }
  double side_;
  std::map<Square, std::vector<Laid>> squares_;
};

/// sorter.feed.file: particles as a camera logged them.
CsvTable read_log(const Case& c, std::vector<Problem>& problems) {
  const std::string file = beside_case(c, c.feed.file);
  CsvTable table = read_csv(file,
                            {.kind = "a log of particles",
                             .columns = {{"x", Dimension::length},
                                         {"y", Dimension::length},
                                         {"kind", Dimension::none},
                                         {"size", Dimension::length},
                                         {"yaw", Dimension::angle}},
                             .ascends = false,  // two on one line of the camera are nothing unusual
                             .example_head = "x [mm], y [mm], kind, size [mm], yaw [deg]",
                             .example_row = "12.5, -30, 0, 10, 45"},
                            problems);
  const double half = 0.5 * c.sorter.belt_width;
  const double pixel = c.sorter.belt_width / c.camera.pixels, farthest = kLongestRun * c.launch.belt_speed;
  double last = 0.0;
  for (std::size_t n = 0; n < table.rows.size() && problems.empty(); ++n) {
    const std::vector<double>& row = table.rows[n];
    const auto wrong = [&](const char* what, const std::string& expected) {
      problems.push_back(table.problem(n, what, expected));
    };
    if (row[0] < last) wrong("x falls", "particles in the order in which they come, x from 0 on");
    else if (std::abs(row[1]) > half)
      wrong("not on the belt", fmt::format("y from {:.4g} to {:.4g} mm", -1e3 * half, 1e3 * half));
    else if (row[2] != std::floor(row[2]) || row[2] < 0.0 || row[2] >= static_cast<double>(c.classes.size()))
      wrong("no kind of this case", fmt::format("a whole number from 0 to {}", c.classes.size() - 1));
    else if (row[0] > farthest)
      wrong("farther along the belt than it runs in ten days",
            fmt::format("x up to {:.4g} mm", 1e3 * farthest));
    else if (row[3] < pixel || row[3] >= c.sorter.belt_width)
      wrong("no size", fmt::format("from a pixel, {:.4g} mm, to below the belt's width of {:.4g} mm",
                                   1e3 * pixel, 2e3 * half));
    else if (std::abs(row[1]) + 0.5 * row[3] > half * (1.0 + 1e-9))
      wrong("hangs over the side of the belt",
            fmt::format("y from {0:.4g} to {1:.4g} mm for that size", -1e3 * (half - 0.5 * row[3]),
                        1e3 * (half - 0.5 * row[3])));
    last = row[0];
  }
  if (problems.empty() && table.rows.empty()) problems.push_back({.what = file + " holds no particle"});
  return table;
}

}  // namespace

Feed::Feed(const Case& c) : sorter_(c.sorter), feed_(c.feed) {
  for (std::size_t k = 0; k < c.classes.size(); ++k)
    classes_.emplace_back(c.classes[k], folder_of(c), c.sorter.seed + 7919 * static_cast<std::int64_t>(k));
  cell_length_ = cell_length_of(c, classes_);
  laid_length_ = tray_of(c) * cell_length_;
  for (const ParticleClass& k : classes_)
    mean_count_.push_back(c.sorter.throughput * k.spec().share / k.mean_mass() / c.launch.belt_speed *
                          cell_length_);
  if (feed_.presentation == Presentation::file) read_file(c);
  if (feed_.presentation == Presentation::feeder)
    feeder_ = std::make_unique<FeederStream>(c, classes_, cell_length_,
                                             [this](std::int64_t batch) { return laid(batch, batch + 1); });
}

void Feed::read_file(const Case& c) {
  std::vector<Problem> problems;
  const CsvTable table = read_log(c, problems);
  if (!problems.empty()) throw CaseError(problems);
  const CounterRandom what = stream_of(sorter_.seed, 0, properties);
  std::uint64_t property = 0;
  for (const std::vector<double>& row : table.rows) {
    FeedParticle p = drawn_of(static_cast<std::size_t>(row[2]), what, property);
    p.id = file_.size();
    p.x = row[0];
    p.y = row[1];
    p.scale = row[3] / p.prototype->size;
    p.mass = classes_[static_cast<std::size_t>(row[2])].mass_of(*p.prototype, p.scale);
    p.yaw = row[4];
    file_.push_back(p);
  }
}

double Feed::mean_count() const { return std::accumulate(mean_count_.begin(), mean_count_.end(), 0.0); }

FeedParticle Feed::drawn_of(std::size_t kind, const CounterRandom& what, std::uint64_t& at) const {
  const ParticleClass& k = classes_[kind];
  FeedParticle p;
  p.kind = static_cast<int>(kind);
  p.prototype = &k.prototype(what.uniform(at++));
  p.scale = k.size_at(what.uniform(at++)) / p.prototype->size;
  p.mass = k.mass_of(*p.prototype, p.scale);
  p.yaw = 2.0 * std::numbers::pi * what.uniform(at++);
  const auto a = what.normals(at++), b = what.normals(at++);
  p.signal = k.spec().signal + k.spec().signal_spread * a[0];
  p.late = feed_.arrival_scatter * a[1];
  p.beside = feed_.place_scatter * b[0];
  return p;
}

std::vector<FeedParticle> Feed::drawn(std::int64_t cell) const {
  const CounterRandom how_many = stream_of(sorter_.seed, cell, counts),
                      what = stream_of(sorter_.seed, cell, properties);
  std::vector<FeedParticle> list;
  std::uint64_t at = 0, property = 0;
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    const int count = poisson(mean_count_[k], how_many, at);
    for (int n = 0; n < count; ++n) {
      list.push_back(drawn_of(k, what, property));
      list.back().id = (static_cast<std::uint64_t>(cell + (std::int64_t{1} << 20)) << 24) | (list.size() - 1);
    }
  }
  return list;
}

void Feed::place(std::int64_t cell, std::vector<FeedParticle>& particles,
                 const std::vector<FeedParticle>& beside) const {
  const CounterRandom random = stream_of(sorter_.seed, cell, places);
  const double from = static_cast<double>(cell) * laid_length_;
  std::uint64_t at = 0;
  const auto draw = [&](FeedParticle& p, double radius) {
    p.x = from + laid_length_ * random.uniform(at++);
    p.y = (sorter_.belt_width - 2.0 * radius) * (random.uniform(at++) - 0.5);
  };
  if (feed_.presentation == Presentation::independent) {
    for (FeedParticle& p : particles) draw(p, radius_of(p));
    return;
  }
  // The largest are laid first: later they would find no place.
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> radius;
  for (const FeedParticle& p : particles) radius.push_back(radius_of(p));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radius[a] > radius[b]; });
  double reach = 1e-6;
  for (const double r : radius) reach = std::max(reach, r);
  for (const FeedParticle& p : beside) reach = std::max(reach, radius_of(p));
  Squares laid(reach);
  for (const FeedParticle& p : beside) laid.add(p);
  for (const std::size_t n : order) {
    FeedParticle& p = particles[n];
    int tries = 0;
    do {
      if (++tries > kTries)
        throw InputError(
            fmt::format("the {} cannot carry the feed as a monolayer: no place was found for a particle "
                        "of {:.3g} mm\n  expected: less sorter.throughput{}",
                        feeder_ ? "feeder's tray" : "belt", 1e3 * p.size(),
                        feeder_ ? " or more sorter.feed.lip_speed" : ""));
      draw(p, radius[n]);
    } while (!laid.is_free(p, radius[n]));
    laid.add(p);
  }
}

std::vector<FeedParticle> Feed::even_cell(std::int64_t cell) const {
  std::vector<FeedParticle> list = drawn(cell);
  place(cell, list, {});
  return list;
}

std::vector<FeedParticle> Feed::cells(std::int64_t first, std::int64_t last) const {
  if (feed_.presentation == Presentation::file) {
    const auto from = [&](std::int64_t cell) {  // the first particle that lies in it or behind it
      return std::lower_bound(file_.begin(), file_.end(), static_cast<double>(cell) * cell_length_,
                              [](const FeedParticle& p, double x) { return p.x < x; });
    };
    return {from(first), from(last)};
  }
  return feeder_ ? feeder_->cells(first, last) : laid(first, last);
}

std::vector<FeedParticle> Feed::laid(std::int64_t first, std::int64_t last) const {
  const bool monolayer = feed_.presentation != Presentation::independent;
  std::vector<FeedParticle> all, before, after;
  std::optional<std::int64_t> have;  // the cell that `after` holds
  for (std::int64_t cell = first; cell < last; ++cell) {
    std::vector<FeedParticle> own;
    if (!monolayer) {
      own = even_cell(cell);
    } else if (cell % 2 == 0) {
      own = have == cell ? after : even_cell(cell);
      before = own;
    } else {  // odd cells are laid between their even neighbours
      if (cell == first) before = even_cell(cell - 1);
      after = even_cell(cell + 1);
      have = cell + 1;
      own = drawn(cell);
      std::vector<FeedParticle> beside = before;
      beside.insert(beside.end(), after.begin(), after.end());
      place(cell, own, beside);
    }
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::vector<Problem> check_feed(const Case& c) {
  std::vector<Problem> problems;
  const double pixel = c.sorter.belt_width / c.camera.pixels;
  std::vector<ParticleClass> classes;
  for (std::size_t k = 0; k < c.classes.size(); ++k) {
    try {
      classes.emplace_back(c.classes[k], folder_of(c), c.sorter.seed);
    } catch (const InputError& e) {
      for (Problem p : problems_of(e)) {
        const std::string own = p.key.empty() ? e.advice.key : p.key;
        p.key = fmt::format("sorter.class.{}.{}", k, own.empty() ? "form" : own);
        problems.push_back(std::move(p));
      }
      continue;
    }
    const double least = classes.back().size_at(0.01),
                 rarest = 1.0 / std::max(100.0, static_cast<double>(c.sorter.particles)),
                 most = classes.back().size_at(1.0 - rarest) / c.classes[k].elongation;
    const std::string key = fmt::format("sorter.class.{}.size", k);
    if (most >= c.sorter.belt_width)
      problems.push_back({.key = key,
                          .what = fmt::format("particles of {:.4g} mm are wider than the belt of {:.4g} mm",
                                              1e3 * most, 1e3 * c.sorter.belt_width),
                          .expected = "a size below sorter.belt_width",
                          .example = fmt::format("size = \"{:.3g} mm\"", 100.0 * c.sorter.belt_width)});
    if (least < pixel)
      problems.push_back({.key = key,
                          .what = fmt::format("particles of {:.4g} mm are smaller than a pixel of {:.4g} mm",
                                              1e3 * least, 1e3 * pixel),
                          .expected = "a size of some pixels, or more sorter.camera.pixels",
                          .example = fmt::format("size = \"{:.3g} mm\"", 1e4 * pixel)});
  }
  if (problems.empty() && c.feed.presentation == Presentation::file) {
    read_log(c, problems);
    for (Problem& p : problems) p.key = "sorter.feed.file";
  }
  if (!problems.empty()) return problems;
  double area_per_mass = 0.0, per_mass = 0.0, pixels_seen = 0.0;
  for (const ParticleClass& k : classes) {
    area_per_mass += k.spec().share * k.mean_area() / k.mean_mass();
    per_mass += k.spec().share / k.mean_mass();
    if (!k.spec().eject || !(k.spec().share > 0.0)) continue;
    const double grown = k.size_at(0.99) / k.size_at(0.5);
    pixels_seen = std::max(pixels_seen, k.mean_area() * grown * grown / (pixel * pixel));
  }
  if (pixels_seen < c.camera.least_pixels)
    problems.push_back(
        {.key = "sorter.camera.least_pixels",
         .what = fmt::format("nothing that is to be ejected is seen: it covers {:.0f} pixels, what covers "
                             "fewer than {} is not seen",
                             pixels_seen, c.camera.least_pixels),
         .expected = "a small part of that",
         .example = fmt::format("least_pixels = {:.0f}", std::max(1.0, 0.1 * pixels_seen))});
  const double runs = c.sorter.particles / (c.sorter.throughput * per_mass);  // s
  if (runs > kLongestRun && c.feed.presentation != Presentation::file)
    problems.push_back({.key = "sorter.throughput",
                        .what = fmt::format("the belt would have to run {:.3g} days to bring {} particles",
                                            runs / 86400, c.sorter.particles),
                        .expected = fmt::format("at least {:.4g} t/h, or fewer sorter.particles",
                                                3.6 * c.sorter.throughput * runs / kLongestRun),
                        .example = fmt::format("throughput = \"{:.4g} t/h\"",
                                               3.6 * 0.05 * belt_carries(c) / area_per_mass)});
  const double belt = belt_carries(c), cover = c.sorter.throughput * area_per_mass / belt;
  double most = c.feed.presentation == Presentation::independent ? 1.0 : kMostCover;
  if (c.feed.presentation == Presentation::monolayer) {
    const double count = c.sorter.throughput * per_mass * cell_length_of(c, classes) / c.launch.belt_speed;
    most = std::min(most, kFullestCell / (1.0 + kDeviationsOfFullest / std::sqrt(std::max(count, 1.0))));
  }
  if (cover > most)
    problems.push_back(
        {.key = "sorter.throughput",
         .what = fmt::format("the belt cannot carry it: particles would cover {:.0f} % of it", 100 * cover),
         .expected = fmt::format("at most {:.3g} t/h, a cover of {:.0f} %", 3.6 * most * belt / area_per_mass,
                                 100 * most),
         .example = fmt::format("throughput = \"{:.4g} t/h\"", 3.6 * 0.5 * most * belt / area_per_mass)});
  const double on_tray = cover * c.launch.belt_speed / c.feed.lip_speed;
  if (problems.empty() && c.feed.presentation == Presentation::feeder && on_tray > kMostCover)
    problems.push_back(
        {.key = "sorter.feed.lip_speed",
         .what = fmt::format(
             "the feeder's tray cannot carry it in one layer: particles would cover {:.0f} % of it",
             100 * on_tray),
         .expected = fmt::format("at least {:.3g} m/s, a cover of {:.0f} %",
                                 on_tray / kMostCover * c.feed.lip_speed, 100 * kMostCover),
         .example =
             fmt::format("lip_speed = \"{:.2g} m/s\"", on_tray / (0.8 * kMostCover) * c.feed.lip_speed)});
  return problems;
}

}  // namespace ejecta
