#include "sorter/sorting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "case/load.hpp"
#include "sorter/alone.hpp"
#include "sorter/plan_view.hpp"

using namespace ejecta;

/// The laws of chance that a whole sorter must obey, exactly (../shared/reference-sorter.md, S1), and its
/// books.
namespace {

Case machine(double size, double per_m2, double eject_share, Presentation presentation) {
  Case c = load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml");
  c.feed.presentation = presentation;
  c.classes.resize(2);
  for (ParticleClassSpec& k : c.classes) {
    k.form = ParticleForm::box;
    k.size = size;
  }
  c.classes[0].share = eject_share;
  c.classes[1].share = 1.0 - eject_share;
  const double mass = 2700.0 * std::pow(size, 3);
  c.sorter.throughput = per_m2 * mass * c.launch.belt_speed * c.sorter.belt_width;
  return c;
}

std::int64_t cells_for(const Feed& feed, double particles) {
  return static_cast<std::int64_t>(std::ceil(particles / feed.mean_count()));
}

/// What stands alone among those far enough from the belt's edges to have neighbours on all sides.
Share alone_inside(const Case& c, double gap, double particles) {
  const Feed feed(c);
  const std::int64_t cells = cells_for(feed, particles);
  const double inside = 0.5 * c.sorter.belt_width - 3.0 * c.classes[0].size - gap;
  std::vector<std::array<double, 2>> counts(static_cast<std::size_t>(cells));
  for_each_index_dynamic(static_cast<int>(cells), [&](int cell) {
    const auto list = feed.cells(cell - 1, cell + 2);
    const auto single = standing_alone(list, gap);
    for (std::size_t n = 0; n < list.size(); ++n) {
      if (feed.cell_of(list[n].x) != cell || std::abs(list[n].y) > inside) continue;
      counts[static_cast<std::size_t>(cell)][0] += single[n];
      counts[static_cast<std::size_t>(cell)][1] += 1.0;
    }
  });
  ShareSums sums;
  for (const auto& [part, whole] : counts) sums.add(part, whole, whole);
  return sums.share();
}

double standard_error(const Share& s) { return (s.high - s.low) / (2.0 * 1.959964); }

/// Particles per area between the edges: their centres keep half a diagonal from them.
double density_inside(const Case& c, double per_m2) {
  return per_m2 * c.sorter.belt_width / (c.sorter.belt_width - std::numbers::sqrt2 * c.classes[0].size);
}

TEST(StandingAlone, OfIndependentSquaresIsTheExcludedArea) {
  const double a = 10e-3, gap = 1e-3;
  const double excluded =
      2 * a * a + 16 * a * a / (2 * std::numbers::pi) + 8 * a * gap + std::numbers::pi * gap * gap;
  for (const double per_m2 : {100.0, 300.0, 1000.0, 2500.0})
    for (const double share : {0.1, 0.3, 0.5}) {
      const Case c = machine(a, per_m2, share, Presentation::independent);
      const Share found = alone_inside(c, gap, 1e5);
      const double law = std::exp(-density_inside(c, per_m2) * excluded);
      EXPECT_NEAR(found.value, law, 3.0 * standard_error(found)) << per_m2 << " a square metre, " << share;
    }
}

TEST(StandingAlone, IsMoreFrequentInAMonolayer) {
  for (const double per_m2 : {300.0, 1000.0, 2500.0}) {
    const Share poisson = alone_inside(machine(10e-3, per_m2, 0.3, Presentation::independent), 1e-3, 2e4),
                monolayer = alone_inside(machine(10e-3, per_m2, 0.3, Presentation::monolayer), 1e-3, 2e4);
    EXPECT_GT(monolayer.low, poisson.high) << per_m2;
  }
}

/// A tier that ejects what is over an open valve, and nothing else: the area of influence is pitch times the
/// belt's way while it is open.
Ejection over_open_valve(double pitch, double lead) {
  return {.fly =
              [=](std::span<const Flyer> flyers) {
                std::vector<FlightEnd> ends;
                for (const Flyer& f : flyers) {
                  FlightEnd& end = ends.emplace_back();
                  end.clearance = -1.0;
                  for (const Blow& b : f.blows)
                    if (std::abs(f.y - b.y) < 0.5 * pitch && f.at - lead >= b.pulse.from &&
                        f.at - lead < b.pulse.to)
                      end.clearance = 1.0;
                }
                return ends;
              },
          .reach = [=](const FeedParticle&) { return pitch; }};
}

/// Particles as small as points, each shot at alone by one valve.
Case of_points(double per_m2, double share) {
  Case c = machine(0.2e-3, per_m2, share, Presentation::independent);
  c.camera = {.pixels = 20000, .gap = 0.0, .least_pixels = 1};
  c.controller = {.duration = 8e-3, .step = 0.0, .lead = 4e-3, .valves = 1};
  c.manifold = {.valves = 55};
  return c;
}

Products sort_all(const Case& c, const Ejection& ejection, double particles) {
  const Sorter sorter(c, ejection);
  const auto cells = static_cast<int>(cells_for(sorter.feed(), particles));
  constexpr int kStretch = 2;
  std::vector<SortedStretch> pieces(static_cast<std::size_t>((cells + kStretch - 1) / kStretch));
  for_each_index_dynamic(static_cast<int>(pieces.size()), [&](int n) {
    pieces[static_cast<std::size_t>(n)] = sorter.sort(n * kStretch, std::min(cells, (n + 1) * kStretch));
  });
  Products products;
  for (const SortedStretch& piece : pieces)
    for (const Tally& cell : piece.cells) products.add(cell, c.classes);
  return products;
}

TEST(CoEjection, LosesWhatPoissonShotsTake) {
  const double pitch = 10e-3;
  for (const double per_m2 : {300.0, 1000.0, 3000.0, 8000.0})
    for (const double share : {0.1, 0.3, 0.5}) {
      const Case c = of_points(per_m2, share);
      const double influence = c.launch.belt_speed * c.controller.duration * pitch, shots = share * per_m2;
      const Products p = sort_all(c, over_open_valve(pitch, 0.0), 1e5);
      const Share loss = p.sums[Products::loss].share(), purity = p.sums[Products::purity].share(),
                  recovery = p.sums[Products::recovery].share();
      const double lost = 1.0 - std::exp(-shots * influence);
      EXPECT_NEAR(loss.value, lost, 3.0 * standard_error(loss)) << per_m2 << ", " << share;
      const double pure = 1.0 / (1.0 + (1.0 - share) / share * lost);
      EXPECT_NEAR(purity.value, pure, 3.0 * standard_error(purity)) << per_m2 << ", " << share;
      EXPECT_GT(recovery.value, 0.995);
    }
}

TEST(DeadValves, CostInProportionWhileOneValveServesAParticle) {
  Case c = of_points(300.0, 0.3);
  c.manifold.dead = 0.2;
  const Share recovery = sort_all(c, over_open_valve(10e-3, 0.0), 3e4).sums[Products::recovery].share();
  // A dead valve's particles may lie under a neighbour's shot as long as that is theirs too: here it is not.
  EXPECT_NEAR(recovery.value, 0.8, 0.01);
}

TEST(Books, EveryParticleAndItsMassHasOneFate) {
  const Case c = load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml");
  const auto source = make_jet_source(c);
  const Sorter sorter(c, fast_ejection(c, *source));
  const SortedStretch sorted = sorter.sort(0, 3);
  for (std::int64_t cell = 0; cell < 3; ++cell) {
    std::array<double, 2> number{}, mass{};
    for (const FeedParticle& p : sorter.feed().cells(cell, cell + 1)) {
      number[static_cast<std::size_t>(p.kind)] += 1.0;
      mass[static_cast<std::size_t>(p.kind)] += p.mass;
    }
    const Tally& tally = sorted.cells[static_cast<std::size_t>(cell)];
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(tally.number(k), number[k]);
      EXPECT_NEAR(tally.mass(k), mass[k], 1e-12 * mass[k]);
    }
  }
}

TEST(Stretches, DoNotDependOnWhereTheyAreCut) {
  const Case c = load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml");
  const auto source = make_jet_source(c);
  const Sorter sorter(c, fast_ejection(c, *source));
  const SortedStretch whole = sorter.sort(0, 4);
  std::vector<Tally> pieces;
  for (const auto& [from, to] : {std::pair{0, 1}, {1, 3}, {3, 4}})
    for (const Tally& cell : sorter.sort(from, to).cells) pieces.push_back(cell);
  ASSERT_EQ(pieces.size(), whole.cells.size());
  for (std::size_t n = 0; n < pieces.size(); ++n) EXPECT_EQ(pieces[n].values(), whole.cells[n].values()) << n;
}

/// A pulse longer than a cell of belt, a command long before its object: the same, wherever the belt is cut.
TEST(Stretches, HoldAllThatLongCommandsDo) {
  Case c = load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml");
  c.controller.duration = 0.4;
  c.controller.lead = 0.3;
  c.sorter.encounters = false;  // all would be pushed, and near each other
  const auto source = make_jet_source(c);
  const Sorter sorter(c, fast_ejection(c, *source));
  EXPECT_GT(sorter.halo(), 3);
  double air = 0.0;
  for (std::int64_t cell = 0; cell < 12; ++cell) air += sorter.sort(cell, cell + 1).cells[0].air;
  double whole = 0.0;
  for (const Tally& cell : sorter.sort(0, 12).cells) whole += cell.air;
  EXPECT_NEAR(air, whole, 2e-3 * whole);
  // Nearly all valves are open nearly all the time.
  const double time = 12 * sorter.feed().cell_length() / c.launch.belt_speed;
  const double all = c.manifold.valves * sorter.air_use().mass(time);
  EXPECT_LT(whole, all);
  EXPECT_GT(whole, 0.85 * all);
}

/// The intervals of few cells: made of draws whose truth is known.
TEST(Intervals, CoverTheTruthOfFewPieces) {
  for (const int pieces : {2, 4, 8, 20}) {
    int covered = 0;
    constexpr int kTrials = 400;
    for (int trial = 0; trial < kTrials; ++trial) {
      const CounterRandom random(5, static_cast<std::uint64_t>(1000 * pieces + trial));
      ShareSums sums;
      std::uint64_t at = 0;
      for (int piece = 0; piece < pieces; ++piece) {
        // Neighbours share their fate: five at a time.
        double part = 0.0;
        for (int group = 0; group < 20; ++group) part += 5.0 * (random.uniform(at++) < 0.3);
        sums.add(part, 100.0, 100.0);
      }
      const Share s = sums.share();
      covered += s.low <= 0.3 && 0.3 <= s.high;
    }
    EXPECT_GE(covered, static_cast<int>(0.925 * kTrials)) << pieces;
  }
  ShareSums one;
  one.add(30.0, 100.0, 100.0);
  EXPECT_EQ(one.share().low, 0.0);
  EXPECT_EQ(one.share().high, 1.0);
}

}  // namespace
