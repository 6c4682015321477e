#include "study/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace ejecta {
namespace {

/// Processes that explain the runs: for the next places, and for the result.
constexpr int kProcessesToAsk = 8, kProcesses = 16;
/// Margins drawn from each process for the errors.
constexpr int kDraws = 64;
/// Cells of the half or whole window in which places are looked for and in which areas are measured.
constexpr int kCellsToAsk = 600, kCells = 2000;
/// Nodes of unsure sign in one draw, whose number cubed is its cost: more take a raster of half as many
/// cells.
constexpr int kMostUnsure = 500;
/// A sign is unsure within so many standard deviations.
constexpr double kUnsure = 3.5;
constexpr double kQuantile = 1.96;  // standard deviations within which 95 % lie
/// Fine runs that repeat coarse ones before others may stand alone: what ties the fidelities together.
constexpr int kPairs = 5;
/// Coarse runs before the first fine one: where the boundary is, so that none is spent far from it.
constexpr int kCoarseFirst = 20;
/// A verdict less likely than this contradicts the others: one in a thousand, so that the runs of a map
/// seldom raise the alarm by chance.
constexpr double kContradiction = 1e-3;
/// A verdict less likely than this is judged once more, without the run itself.
constexpr double kSuspicion = 0.1;
constexpr double kLeastMargin = 1e-12;  // m: clipping divides by the usual margin

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }
double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// The part of the window that is computed, and places in it as shares of the whole window.
class Frame {
 public:
  explicit Frame(const MapSettings& s) : window_(s.window), symmetric_(s.symmetric) {
    if (symmetric_) window_.y_low = 0.0;
  }
  double share_x(double x) const { return (x - window_.x_low) / window_.width(); }
  double share_y(double y) const {
    return (y - window_.y_low) / ((symmetric_ ? 2.0 : 1.0) * window_.depth());
  }
  double distance(const Point2& a, const Point2& b) const {
    return std::hypot(share_x(a.x) - share_x(b.x), share_y(a.y) - share_y(b.y));
  }
  /// To the sides of the window; the axis of symmetry is none.
  double distance_to_sides(const Point2& p) const {
    const double x = std::min(share_x(p.x), 1.0 - share_x(p.x));
    const double top = share_y(window_.y_high) - share_y(p.y);
    return std::min({x, top, symmetric_ ? top : share_y(p.y)});
  }
  const Window& window() const { return window_; }
  double whole() const { return symmetric_ ? 2.0 : 1.0; }

  /// Cells nearly as wide as long, an even number along either side.
  Raster raster(int cells) const {
    const double side = std::sqrt(window_.width() * window_.depth() / cells);
    const auto even = [&](double length) {
      return 2 * std::clamp(static_cast<int>(std::lround(0.5 * length / side)), 4, 500);
    };
    Raster r{window_.x_low, window_.y_low, 0.0, 0.0, even(window_.width()), even(window_.depth())};
    r.dx = window_.width() / r.cells_x;
    r.dy = window_.depth() / r.cells_y;
    return r;
  }

  Places places(std::span<const Point2> points, double fine = 1.0) const {
    const auto n = static_cast<Eigen::Index>(points.size());
    Places out{Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd::Constant(n, fine)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const Point2& p = points[static_cast<std::size_t>(k)];
      out.x[k] = share_x(p.x);
      out.y[k] = share_y(symmetric_ ? std::abs(p.y) : p.y);
    }
    return out;
  }

 private:
  Window window_;
  bool symmetric_;
};

std::vector<Point2> nodes_of(const Raster& r) {
  std::vector<Point2> nodes;
  for (int n = 0; n < r.nodes(); ++n) nodes.push_back({r.x(n), r.y(n)});
  return nodes;
}

Places joined(const Places& a, const Places& b) {
  Places out{Eigen::ArrayXd(a.size() + b.size()), Eigen::ArrayXd(a.size() + b.size()),
             Eigen::ArrayXd(a.size() + b.size())};
  out.x << a.x, b.x;
  out.y << a.y, b.y;
  out.fine << a.fine, b.fine;
  return out;
}

Places selected(const Places& places, const std::vector<Eigen::Index>& which) {
  return {places.x(which), places.y(which), places.fine(which)};
}

/// Median over the window of the size of the margin, that of the nearest run standing for each place: runs
/// that crowd at the boundary must not make it small.
double usual_margin(const std::vector<MapRun>& runs, const Frame& frame) {
  std::vector<double> sizes;
  for (const Point2& node : nodes_of(frame.raster(kCellsToAsk))) {
    const auto nearer = [&](const MapRun& a, const MapRun& b) {
      return frame.distance(a.at, node) < frame.distance(b.at, node);
    };
    sizes.push_back(std::abs(std::min_element(runs.begin(), runs.end(), nearer)->margin));
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(*middle, kLeastMargin);
}

bool comes_first(const MapRun& a, const MapRun& b) {
  return std::tie(a.at.x, a.at.y, a.fidelity, a.margin) < std::tie(b.at.x, b.at.y, b.fidelity, b.margin);
}

/// Runs in an order of their own, so that the order in which they ended leaves no trace in the last bits.
std::vector<ConditionedProcess> explain(std::vector<MapRun> runs, const MapSettings& settings, int count) {
  std::sort(runs.begin(), runs.end(), comes_first);
  const Frame frame(settings);
  std::vector<Point2> points;
  Eigen::VectorXd margins(static_cast<Eigen::Index>(runs.size()));
  for (const MapRun& r : runs) {
    margins[static_cast<Eigen::Index>(points.size())] = r.margin;
    points.push_back(r.at);
  }
  Places places = frame.places(points);
  for (std::size_t n = 0; n < runs.size(); ++n)
    places.fine[static_cast<Eigen::Index>(n)] = runs[n].fidelity == Fidelity::fine ? 1.0 : 0.0;
  return explain_runs(places, margins,
                      {.usual = usual_margin(runs, frame),
                       .mirrored = settings.symmetric,
                       .two = settings.coarse_cost > 0.0,
                       .noise_of_place = settings.of_class},
                      count);
}

/// Probability that a fine run ejects, noise included.
std::vector<double> chances_of(std::span<const Point2> places, const std::vector<MapRun>& runs,
                               const MapSettings& settings) {
  std::vector<double> out(places.size(), 0.0);
  const auto processes = explain(runs, settings, kProcesses);
  const Places at = Frame(settings).places(places);
  for (const ConditionedProcess& p : processes) {
    const auto f = p.at(at);
    for (std::size_t n = 0; n < out.size(); ++n) {
      const auto k = static_cast<Eigen::Index>(n);
      out[n] += normal_share(f.mean[k] / std::sqrt(f.variance[k] + p.noise())) /
                static_cast<double>(processes.size());
    }
  }
  return out;
}

double chance_of_verdict(const MapRun& run, double ejected) {
  return run.margin > 0.0 ? ejected : 1.0 - ejected;
}

/// The node farthest from all runs; half as far from the sides will do.
int emptiest(const Frame& frame, const std::vector<Point2>& nodes, std::span<const Point2> taken) {
  int best = 0;
  double farthest = -1.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    double distance = 2.0 * frame.distance_to_sides(nodes[n]);
    for (const Point2& p : taken) distance = std::min(distance, frame.distance(nodes[n], p));
    if (distance > farthest * (1.0 + 1e-9)) {
      farthest = distance;
      best = static_cast<int>(n);
    }
  }
  return best;
}

/// Square of what the values change by over a cell at a node.
double square_of_change(const Raster& r, std::span<const double> values, int i, int j) {
  const auto at = [&](int a, int b) {
    return values[static_cast<std::size_t>(r.node(std::clamp(a, 0, r.cells_x), std::clamp(b, 0, r.cells_y)))];
  };
  const double gx = 0.5 * (at(i + 1, j) - at(i - 1, j)), gy = 0.5 * (at(i, j + 1) - at(i, j - 1));
  return gx * gx + gy * gy;
}

/// How the area answers to the margin at each node, to first order: the density of a zero there. A zero
/// between nodes must not slip through, so that the deviation includes half a cell's change of the mean.
Eigen::VectorXd zero_density(const Raster& r, const Eigen::VectorXd& mean, const Eigen::VectorXd& variance) {
  Eigen::VectorXd density(r.nodes());
  const std::span<const double> values(mean.data(), static_cast<std::size_t>(mean.size()));
  for (int j = 0; j <= r.cells_y; ++j)
    for (int i = 0; i <= r.cells_x; ++i) {
      const int n = r.node(i, j);
      const double deviation = std::sqrt(variance[n] + square_of_change(r, values, i, j) / 6.0);
      density[n] = normal_density(mean[n] / deviation) / deviation;
    }
  return density;
}

/// Integral of the chance that a margin of this mean and deviation is positive, m2. Within a cell the mean
/// is evenly spread over what it changes by.
double chance_area(const Raster& r, std::span<const double> means, double variance) {
  double area = 0.0;
  for (int j = 0; j <= r.cells_y; ++j)
    for (int i = 0; i <= r.cells_x; ++i) {
      const double part = (i == 0 || i == r.cells_x ? 0.5 : 1.0) * (j == 0 || j == r.cells_y ? 0.5 : 1.0);
      const double deviation = std::sqrt(variance + square_of_change(r, means, i, j) / 12.0 + 1e-300);
      area += part * normal_share(means[static_cast<std::size_t>(r.node(i, j))] / deviation);
    }
  return area * r.dx * r.dy;
}

/// What one process expects of runs at all options: how much the variance of the area falls.
class Prospect {
 public:
  /// The first options are the nodes of the raster, fine.
  Prospect(const ConditionedProcess& process, const Raster& raster, const Places& options, bool of_class)
      : process_(process), options_(options), field_(process.at(options)) {
    const Eigen::VectorXd spread =
        Eigen::VectorXd::Constant(raster.nodes(), of_class ? process.noise() : 0.0);
    const Eigen::VectorXd density =
        zero_density(raster, field_.mean.head(raster.nodes()), field_.variance.head(raster.nodes()) + spread);
    std::vector<Eigen::Index> where;
    for (Eigen::Index n = 0; n < density.size(); ++n)
      if (density[n] > 1e-2 * density.maxCoeff()) where.push_back(n);
    const Eigen::VectorXd weight = density(where);
    const Eigen::VectorXd lost = field_.whitened(Eigen::all, where) * weight;
    with_area_ = process.variance() *
                 (process.covariance().between(selected(options, where), options).transpose() * weight -
                  field_.whitened.transpose() * lost);
  }

  double gain(Eigen::Index option) const {
    return with_area_[option] * with_area_[option] / (field_.variance[option] + process_.noise());
  }

  /// A run there, whatever it gives: only the variances know.
  void run_at(Eigen::Index option) {
    const double v = field_.variance[option] + process_.noise();
    const Eigen::VectorXd c =
        process_.variance() * (process_.covariance().between(options_, selected(options_, {option})) -
                               field_.whitened.transpose() * field_.whitened.col(option));
    with_area_ -= with_area_[option] / v * c;
    field_.variance = (field_.variance - c.cwiseAbs2() / v).cwiseMax(1e-8 * process_.variance());
    const auto row = field_.whitened.rows();
    field_.whitened.conservativeResize(row + 1, Eigen::NoChange);
    field_.whitened.row(row) = c.transpose() / std::sqrt(v * process_.variance());
  }

 private:
  const ConditionedProcess& process_;
  const Places& options_;
  ConditionedProcess::Field field_;
  Eigen::VectorXd with_area_;  // covariance of the area with each option's margin
};

/// What a drawn margin encloses, on the computed part of the window.
struct Measures {
  double area, half_width, before, behind;
};

Measures measured(const Raster& r, std::span<const double> values) {
  const Extent e = positive_extent(r, values);
  if (e.low_x > e.high_x) return {0.0, 0.0, 0.0, 0.0};
  return {positive_area(r, values), std::max(std::abs(e.low_y), std::abs(e.high_y)), std::max(0.0, -e.low_x),
          std::max(0.0, e.high_x)};
}

/// By how much the area of a smooth margin exceeds that of its linear pieces: a third of what half as many
/// cells lose.
double beyond_pieces(const Raster& r, std::span<const double> values) {
  const Raster half{r.x0, r.y0, 2.0 * r.dx, 2.0 * r.dy, r.cells_x / 2, r.cells_y / 2};
  std::vector<double> every_second;
  for (int j = 0; j <= r.cells_y; j += 2)
    for (int i = 0; i <= r.cells_x; i += 2)
      every_second.push_back(values[static_cast<std::size_t>(r.node(i, j))]);
  return (positive_area(r, values) - positive_area(half, every_second)) / 3.0;
}

/// Within which the margins of half of the coarse runs lie, and of so many that pairs can be made, m. What
/// fine runs correct farther from the boundary moves none of it, and far from the jet, where no air acts,
/// they correct nothing at all, which says nothing of the boundary.
double margin_of_nearer_half(std::span<const MapRun> runs) {
  std::vector<double> margins;
  for (const MapRun& run : runs)
    if (run.fidelity == Fidelity::coarse) margins.push_back(std::abs(run.margin));
  if (margins.empty()) return 0.0;
  std::ranges::sort(margins);
  const std::size_t half = std::max(margins.size() / 2, std::size_t{kPairs});
  return margins[std::min(half, margins.size()) - 1];
}

std::vector<Eigen::Index> unsure_nodes(const ConditionedProcess::Field& f) {
  std::vector<Eigen::Index> nodes;
  for (Eigen::Index n = 0; n < f.mean.size(); ++n)
    if (f.mean[n] * f.mean[n] < kUnsure * kUnsure * f.variance[n]) nodes.push_back(n);
  return nodes;
}

/// Margins drawn from a process, in Measures each. The variance of the process is drawn too, from what as
/// many runs as there are leave of it.
void draw(const ConditionedProcess& process, const Raster& r, const Places& nodes, bool of_class,
          std::uint64_t seed, int number, std::span<Measures> out) {
  const auto f = process.at(nodes);
  const auto unsure = unsure_nodes(f);
  const auto n = static_cast<Eigen::Index>(unsure.size()), runs = f.whitened.rows();
  std::vector<double> values(f.mean.data(), f.mean.data() + f.mean.size());
  const double beyond = beyond_pieces(r, values);

  Eigen::MatrixXd draws(n, static_cast<Eigen::Index>(out.size()));
  for (Eigen::Index d = 0; d < draws.cols(); ++d) {
    const CounterRandom random(
        seed, static_cast<std::uint64_t>(number) * out.size() + static_cast<std::uint64_t>(d));
    double square = 0.0;
    for (Eigen::Index k = 0; k < runs; ++k)
      square += std::pow(random.normal(static_cast<std::uint64_t>(k)), 2);
    const double deviation = std::sqrt(process.variance() * static_cast<double>(runs) / square);
    for (Eigen::Index k = 0; k < n; ++k)
      draws(k, d) = deviation * random.normal(static_cast<std::uint64_t>(runs + k));
  }
  if (n > 0) {
    const Places at = selected(nodes, unsure);
    const Eigen::MatrixXd white = f.whitened(Eigen::all, unsure);
    Eigen::MatrixXd covariance = process.covariance().between(at, at) - white.transpose() * white;
    covariance.diagonal().array() += 1e-7;  // rounding must not make it indefinite
    draws = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL() * draws;
  }
  for (std::size_t d = 0; d < out.size(); ++d) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto node = static_cast<std::size_t>(unsure[static_cast<std::size_t>(k)]);
      values[node] = f.mean[unsure[static_cast<std::size_t>(k)]] + draws(k, static_cast<Eigen::Index>(d));
    }
    out[d] = measured(r, values);
    if (of_class) out[d].area = chance_area(r, values, process.noise());
    else if (out[d].area > 0.0) out[d].area = std::max(0.0, out[d].area + beyond);
  }
}

/// Median, and the distance from it within which 95 % lie.
Estimate estimate(std::span<const Measures> all, double Measures::*what, double factor) {
  std::vector<double> values;
  for (const Measures& m : all) values.push_back(factor * (m.*what));
  const auto nth = [&values](double share) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  Estimate e;
  e.value = nth(0.5);
  for (double& v : values) v = std::abs(v - e.value);
  e.error = nth(0.95);
  return e;
}

/// The middles of seven equal parts of the normal distribution, scaled to its variance.
std::array<double, 7> normal_steps(double deviation) {
  return {-1.6076 * deviation, -0.8685 * deviation, -0.4017 * deviation, 0.0,
          0.4017 * deviation,  0.8685 * deviation,  1.6076 * deviation};
}

}  // namespace

OutlineFinder::OutlineFinder(const MapSettings& settings) : settings_(settings) {
  const Window& w = settings.window;
  if (!(w.x_low < w.x_high) || !((settings.symmetric ? 0.0 : w.y_low) < w.y_high) ||
      !std::isfinite(w.width() + w.depth()))
    throw InputError(fmt::format("the window of a map, x from {} to {} m and y from {} to {} m, has no area",
                                 w.x_low, w.x_high, w.y_low, w.y_high));
  if (settings.first_runs < 1 || settings.max_runs < settings.first_runs || settings.max_fine < 1)
    throw InputError(fmt::format("a map of {} runs, {} of them fine, cannot begin with {}", settings.max_runs,
                                 settings.max_fine, settings.first_runs));
}

void OutlineFinder::tell(const MapRun& run) {
  if (!std::isfinite(run.margin) || !std::isfinite(run.at.x) || !std::isfinite(run.at.y))
    throw DivergedError(
        fmt::format("the run at x = {} m, y = {} m gave the margin {}", run.at.x, run.at.y, run.margin));
  runs_.push_back(run);
  std::erase_if(pending_, [&](const Proposal& p) {
    return p.at.x == run.at.x && p.at.y == run.at.y && p.fidelity == run.fidelity;
  });
}

int OutlineFinder::asked(Fidelity fidelity) const {
  const auto is_so = [&](const auto& run) { return run.fidelity == fidelity; };
  return static_cast<int>(std::count_if(runs_.begin(), runs_.end(), is_so) +
                          std::count_if(pending_.begin(), pending_.end(), is_so));
}

std::vector<Proposal> OutlineFinder::ask(int count) {
  const bool two = settings_.coarse_cost > 0.0;
  const Frame frame(settings_);
  const Raster raster = frame.raster(kCellsToAsk);
  const std::vector<Point2> nodes = nodes_of(raster);
  const auto all_asked = [&] { return asked(Fidelity::fine) + asked(Fidelity::coarse); };
  std::vector<Proposal> out;
  const auto propose = [&](const Proposal& p) {
    out.push_back(p);
    pending_.push_back(p);
  };
  const auto wanted = [&] {
    return static_cast<int>(out.size()) < count && all_asked() < settings_.max_runs;
  };

  while (wanted() && all_asked() < settings_.first_runs) {
    std::vector<Point2> taken;
    for (const MapRun& r : runs_) taken.push_back(r.at);
    for (const Proposal& p : pending_) taken.push_back(p.at);
    const int node = emptiest(frame, nodes, taken);
    propose({nodes[static_cast<std::size_t>(node)], two ? Fidelity::coarse : Fidelity::fine});
  }
  if (!wanted() || runs_.empty()) return out;

  // Options: a fine run at every node, a coarse run at every node.
  Places options = frame.places(nodes);
  if (two) options = joined(options, frame.places(nodes, 0.0));
  const auto option_of = [&](const Point2& p, Fidelity fidelity) {
    const auto i = std::lround((p.x - raster.x0) / raster.dx), j = std::lround((p.y - raster.y0) / raster.dy);
    const int node = raster.node(std::clamp(static_cast<int>(i), 0, raster.cells_x),
                                 std::clamp(static_cast<int>(j), 0, raster.cells_y));
    return static_cast<Eigen::Index>(node + (fidelity == Fidelity::coarse ? raster.nodes() : 0));
  };
  const auto processes = explain(runs_, settings_, kProcessesToAsk);
  std::vector<Prospect> prospects;
  for (const ConditionedProcess& p : processes)
    prospects.emplace_back(p, raster, options, settings_.of_class);
  const auto run_at = [&](Eigen::Index option) {
    for_each_index(static_cast<int>(prospects.size()),
                   [&](int k) { prospects[static_cast<std::size_t>(k)].run_at(option); });
  };
  for (const Proposal& p : pending_)
    if (p.fidelity == Fidelity::fine || two) run_at(option_of(p.at, p.fidelity));

  while (wanted()) {
    std::vector<bool> allowed(static_cast<std::size_t>(options.size()), true);
    if (two) {
      const int pairs = std::min(kPairs, settings_.max_fine);
      const int fine = asked(Fidelity::fine), left = settings_.max_runs - all_asked();
      const bool shaped = asked(Fidelity::coarse) >= std::min(kCoarseFirst, settings_.max_runs - pairs);
      const bool more_fine = shaped && fine < settings_.max_fine, alone = (fine >= kPairs);
      const bool room_for_coarse = (left > pairs - fine);
      for (int n = 0; n < raster.nodes(); ++n) {
        allowed[static_cast<std::size_t>(n)] = more_fine && alone;
        if (!room_for_coarse) allowed[static_cast<std::size_t>(n + raster.nodes())] = false;
      }
      const double near = margin_of_nearer_half(runs_);
      for (const MapRun& run : runs_)
        if (more_fine && run.fidelity == Fidelity::coarse && std::abs(run.margin) <= near)
          allowed[static_cast<std::size_t>(option_of(run.at, Fidelity::fine))] = true;
    }
    const auto once = [&](const auto& run) {  // the same run gives the same margin, however noisy its place
      if (run.fidelity == Fidelity::fine || two)
        allowed[static_cast<std::size_t>(option_of(run.at, run.fidelity))] = false;
    };
    std::for_each(runs_.begin(), runs_.end(), once);
    std::for_each(pending_.begin(), pending_.end(), once);
    Eigen::Index best = -1;
    double most = -1.0;
    for (Eigen::Index n = 0; n < options.size(); ++n) {
      if (!allowed[static_cast<std::size_t>(n)]) continue;
      double gain = 0.0;
      for (const Prospect& p : prospects) gain += p.gain(n);
      if (n >= raster.nodes()) gain /= settings_.coarse_cost;
      if (gain > most) {
        most = gain;
        best = n;
      }
    }
    if (best < 0) break;  // neither a coarse nor a fine run is left to make
    propose({nodes[static_cast<std::size_t>(best % raster.nodes())],
             best < raster.nodes() ? Fidelity::fine : Fidelity::coarse});
    run_at(best);
  }
  return out;
}

Outline OutlineFinder::outline() const {
  if (runs_.empty()) throw InputError("a map without runs has no outline");
  const Frame frame(settings_);
  const auto processes = explain(runs_, settings_, kProcesses);
  Raster raster;
  Places nodes;
  Eigen::VectorXd mean, square;
  for (int cells = kCells;; cells /= 2) {
    raster = frame.raster(cells);
    nodes = frame.places(nodes_of(raster));
    mean = square = Eigen::VectorXd::Zero(nodes.size());
    std::size_t most = 0;
    for (const ConditionedProcess& p : processes) {
      const auto f = p.at(nodes);
      most = std::max(most, unsure_nodes(f).size());
      mean += f.mean / static_cast<double>(processes.size());
      square += (f.variance + f.mean.cwiseAbs2()) / static_cast<double>(processes.size());
    }
    if (most <= kMostUnsure || cells <= kMostUnsure) break;
  }

  std::vector<Measures> all(processes.size() * kDraws);
  for_each_index_dynamic(static_cast<int>(processes.size()), [&](int k) {
    draw(processes[static_cast<std::size_t>(k)], raster, nodes, settings_.of_class, settings_.seed, k,
         std::span(all).subspan(static_cast<std::size_t>(k) * kDraws, kDraws));
  });
  Outline out;
  out.area = estimate(all, &Measures::area, frame.whole());
  out.half_width = estimate(all, &Measures::half_width, 1.0);
  out.length_before = estimate(all, &Measures::before, 1.0);
  out.length_behind = estimate(all, &Measures::behind, 1.0);

  const Eigen::VectorXd deviation = (square - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  const auto whole = [&](const Eigen::VectorXd& values) {
    return whole_plane({raster, {values.data(), values.data() + values.size()}}, settings_.symmetric);
  };
  const RasterValues expected = whole(mean), least = whole(mean - kQuantile * deviation),
                     most = whole(mean + kQuantile * deviation);
  out.outline = positive_outlines(expected.raster, expected.values);
  out.sure = positive_outlines(least.raster, least.values);
  out.possible = positive_outlines(most.raster, most.values);
  out.reaches_sides = reaches_sides(expected.raster, expected.values);
  for (const Point2& node : nodes_of(raster)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const MapRun& r : runs_)
      nearest = std::min(
          nearest, std::hypot(r.at.x - node.x, (settings_.symmetric ? std::abs(r.at.y) : r.at.y) - node.y));
    out.widest_gap = std::max(out.widest_gap, 2.0 * nearest);
  }
  return out;
}

bool OutlineFinder::is_finished(const Outline& outline) const {
  const int runs = asked(Fidelity::fine) + asked(Fidelity::coarse);
  if (runs >= settings_.max_runs && pending_.empty()) return true;
  const bool tied =
      settings_.coarse_cost == 0.0 ||
      asked(Fidelity::fine) >= std::min(kPairs, settings_.max_fine);  // else the coarse ones speak
  return tied && runs > settings_.first_runs &&
         outline.area.error <= settings_.area_error * outline.area.value;
}

std::vector<double> OutlineFinder::chances(std::span<const Point2> places) const {
  return chances_of(places, runs_, settings_);
}

std::optional<RasterValues> OutlineFinder::chance_map(const std::array<double, 2>& arrival_error) const {
  const Frame frame(settings_);
  const Raster raster = frame.raster(kCellsToAsk);
  const bool spread = arrival_error[0] > 0.0 || arrival_error[1] > 0.0;
  std::vector<Point2> places;
  for (const Point2& node : nodes_of(raster)) {
    if (!spread) places.push_back(node);
    else
      for (const double x : normal_steps(arrival_error[0]))
        for (const double y : normal_steps(arrival_error[1])) places.push_back({node.x + x, node.y + y});
  }
  const std::vector<double> each = chances_of(places, runs_, settings_);
  const std::size_t together = each.size() / static_cast<std::size_t>(raster.nodes());
  std::vector<double> chance(static_cast<std::size_t>(raster.nodes()), 0.0);
  for (std::size_t n = 0; n < each.size(); ++n)
    chance[n / together] += each[n] / static_cast<double>(together);
  return whole_plane({raster, std::move(chance)}, settings_.symmetric);
}

/// A run that stands against all others also bends the process that judges it: the judgement is that of the
/// others.
std::vector<Contradiction> OutlineFinder::contradictions() const {
  std::vector<MapRun> runs = runs_;
  std::sort(runs.begin(), runs.end(), comes_first);
  std::vector<double> suspect(runs.size(), 0.0);
  const auto processes = explain(runs, settings_, kProcesses);
  for (const ConditionedProcess& p : processes) {
    const Eigen::ArrayXd z = p.left_out();
    for (std::size_t n = 0; n < runs.size(); ++n)
      suspect[n] += chance_of_verdict(runs[n], normal_share(z[static_cast<Eigen::Index>(n)])) /
                    static_cast<double>(processes.size());
  }
  std::vector<Contradiction> out;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    if (suspect[n] > kSuspicion || runs.size() < 2) continue;
    std::vector<MapRun> others = runs;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(n));
    const double ejected = chances_of(std::span(&runs[n].at, 1), others, settings_)[0];
    if (const double chance = chance_of_verdict(runs[n], ejected); chance < kContradiction)
      out.push_back({runs[n], chance});
  }
  return out;
}

}  // namespace ejecta
