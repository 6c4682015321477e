#include "sorter/feeder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "base/parallel.hpp"
#include "case/load.hpp"
#include "sorter/alone.hpp"
#include "sorter/feed.hpp"

using namespace ejecta;

/// What comes from a feeder's lip: contacts computed, and every particle accounted for.
namespace {

Case behind_a_feeder(double throughput_t_h) {
  Case c = load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml");
  c.feed.presentation = Presentation::feeder;
  c.classes.resize(2);
  for (ParticleClassSpec& k : c.classes) {
    k.form = ParticleForm::box;
    k.size = 20e-3;
    k.flatness = 0.5;
  }
  c.sorter.throughput = throughput_t_h / 3.6;
  return c;
}

FeedParticle on_tray(const ParticleClass& kind, double x, double y) {
  FeedParticle p;
  p.prototype = &kind.prototype(0.5);
  p.mass = kind.mass_of(*p.prototype, 1.0);
  p.x = x;
  p.y = y;
  return p;
}

/// As crowded as 4 t/h on the whole width.
Case narrow_belt() {
  Case c = behind_a_feeder(1.1);
  c.sorter.belt_width = 0.15;
  return c;
}

/// Whoever slides all the way is borne by the belt with m g t in all, however it bounces, and so has the
/// speed u + mu g t.
TEST(Feeder, AFlatBoxSlidesToRestWhereFrictionBringsIt) {
  Case c = behind_a_feeder(1.0);
  c.classes[0].flatness = 0.25;
  c.feed.lip_height = 30e-3;
  const std::vector<ParticleClass> kinds{ParticleClass(c.classes[0], "", 1)};
  const Feeder feeder(c, kinds);
  const FeedParticle p = feeder.run({on_tray(kinds[0], 0.3, 0.05)}, 1).at(0);
  EXPECT_EQ(p.slip, 0.0);
  EXPECT_EQ(p.late, 0.0);
  EXPECT_EQ(p.spin, Vec3::Zero());
  EXPECT_NEAR(p.y, 0.05, 5e-3);
  EXPECT_NEAR(p.x, 0.3 * c.launch.belt_speed / c.feed.lip_speed, 0.06);
  c.feed.lip_distance = 0.3;  // the camera sees it slip
  const FeedParticle early = Feeder(c, kinds).run({on_tray(kinds[0], 0.3, 0.05)}, 1).at(0);
  const double a = c.materials[0].friction * 9.81, u = c.feed.lip_speed;
  EXPECT_NEAR(early.slip, c.launch.belt_speed - std::sqrt(u * u + 2.0 * a * 0.3), 0.15);
  EXPECT_GT(early.late, 5e-3);
}

/// On a tray as fast as the belt nothing slips; what falls from it is still what falls.
TEST(Feeder, ATrayAsFastAsTheBeltDoesNotStandForIt) {
  Case c = behind_a_feeder(1.0);
  c.feed.lip_speed = c.launch.belt_speed;
  c.feed.lip_height = 30e-3;
  const std::vector<ParticleClass> kinds{ParticleClass(c.classes[0], "", 1)};
  FeedParticle p = on_tray(kinds[0], 0.3, 0.05);
  p = Feeder(c, kinds).run({p}, 1).at(0);
  EXPECT_NE(p.tilt.coeffs(), Quat::Identity().coeffs());  // it tipped over the lip
  EXPECT_NEAR(p.x, 0.3, 0.03);
}

std::map<std::uint64_t, FeedParticle> by_id(const std::vector<FeedParticle>& list) {
  std::map<std::uint64_t, FeedParticle> map;
  for (const FeedParticle& p : list) EXPECT_TRUE(map.emplace(p.id, p).second) << "twice: " << p.id;
  return map;
}

bool same_bits(const FeedParticle& a, const FeedParticle& b) {
  return a.x == b.x && a.y == b.y && a.late == b.late && a.tilt.coeffs() == b.tilt.coeffs() &&
         a.spin == b.spin;
}

TEST(Feeder, StretchesAreTheSameBitsHoweverTheyAreCutAndOnAnyThreads) {
  const Case c = behind_a_feeder(1.0);
  const int threads = thread_count();
  set_thread_count(2);
  const Feed feed(c);
  feed.prepare(0, 6);
  const std::vector<FeedParticle> whole = feed.cells(0, 6);
  set_thread_count(1);
  const Feed other(c);
  const std::vector<FeedParticle> last = other.cells(4, 6);  // asked for first
  std::vector<FeedParticle> pieces = other.cells(0, 1);
  for (const auto& piece : {other.cells(1, 4), last}) pieces.insert(pieces.end(), piece.begin(), piece.end());
  set_thread_count(threads);
  ASSERT_EQ(pieces.size(), whole.size());
  EXPECT_GT(whole.size(), 5u);
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_TRUE(same_bits(pieces[n], whole[n])) << n;
}

/// In = on the belt: by number and by mass, of a stretch so long that nobody can lie before or behind it.
TEST(Feeder, EveryParticleOfTheTrayIsOnTheBeltOnce) {
  const Case c = narrow_belt();
  const Feed feed(c);
  const FeederStream stream(c, feed.classes(), feed.cell_length(), [&](std::int64_t batch) {
    return batch < 0 || batch >= 6 ? std::vector<FeedParticle>{} : feed.laid(batch, batch + 1);
  });
  const auto in = by_id(feed.laid(0, 6)), out = by_id(stream.cells(-20, 40));
  ASSERT_EQ(in.size(), out.size());
  EXPECT_GT(in.size(), 15u);
  for (const auto& [id, p] : in) {
    ASSERT_TRUE(out.contains(id));
    EXPECT_EQ(out.at(id).mass, p.mass);
    EXPECT_LT(std::abs(out.at(id).y), 0.5 * c.sorter.belt_width);
  }
}

/// Whom a batch more of run-in does not touch comes to lie in the same place, to the bit.
TEST(Feeder, ARunInOfOneBatchSuffices) {
  const Case c = narrow_belt();
  const Feed feed(c);
  const auto of = [&](std::int64_t run_in) {
    return by_id(FeederStream(
                     c, feed.classes(), feed.cell_length(),
                     [&](std::int64_t batch) { return feed.laid(batch, batch + 1); }, run_in)
                     .batch(0));
  };
  const auto one = of(1), two = of(2);
  ASSERT_EQ(one.size(), two.size());
  EXPECT_GT(one.size(), 2u);
  for (const auto& [id, p] : one) EXPECT_TRUE(same_bits(p, two.at(id))) << id;
}

/// Where particles are drawn independently, of squares of this size exp(-n E) stand alone; those that lay
/// beside each other on the tray are drawn apart by the belt.
TEST(Feeder, ParticlesStandAloneMoreOftenThanByChance) {
  Case c = narrow_belt();
  c.sorter.throughput *= 4.0;
  const Feed feed(c);
  const FeederStream stream(c, feed.classes(), feed.cell_length(),
                            [&](std::int64_t batch) { return feed.laid(batch, batch + 1); });
  std::vector<FeedParticle> list;
  for (std::int64_t batch = 0; batch < FeederStream::kBatches; ++batch)
    for (const FeedParticle& p : stream.batch(batch)) list.push_back(p);
  const std::vector<bool> single = standing_alone(list, c.camera.gap);
  double alone = 0.0, count = 0.0;
  for (std::size_t n = 0; n < list.size(); ++n)
    if (list[n].x > 0.6 && list[n].x < 3.4) {
      alone += single[n];
      count += 1.0;
    }
  const double a = 20e-3, gap = c.camera.gap,
               excluded = 2 * a * a + 16 * a * a / (2 * std::numbers::pi) + 8 * a * gap +
                          std::numbers::pi * gap * gap,
               per_m2 = feed.mean_count() / feed.cell_length() / c.sorter.belt_width,
               law = std::exp(-per_m2 * excluded);
  EXPECT_GT(count, 50.0);
  EXPECT_GT(alone / count, law + 3.0 * std::sqrt(law * (1.0 - law) / count));
}

TEST(Feeder, IsRefusedWhereItsTrayCannotCarryTheFeed) {
  Case c = narrow_belt();
  c.feed.lip_speed = 0.05;
  const std::vector<Problem> problems = check_feed(c);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].key, "sorter.feed.lip_speed");
  c.feed.lip_speed = 0.2;  // as it is told
  EXPECT_NE(problems[0].expected.find("0.1"), std::string::npos) << problems[0].expected;
  EXPECT_TRUE(check_feed(c).empty());
}

}  // namespace
