#include "base/clock.hpp"

#include <gtest/gtest.h>

namespace ejecta {
namespace {

TEST(Clock, LandsOnEventsAndNeverTakesATinyStep) {
  Clock clock;
  clock.add_event(1.0);
  clock.add_event(0.25);
  double least = 1.0;
  bool landed = false;
  while (clock.time() < 1.0) {
    const double dt = clock.land_on_events(0.1);
    least = std::min(least, dt);
    clock.tick(dt);
    landed = landed || clock.time() == 0.25;
  }
  EXPECT_TRUE(landed);
  EXPECT_EQ(clock.time(), 1.0);
  EXPECT_GE(least, 0.05);
}

TEST(Clock, EventsThatDifferByRoundingAreOne) {
  ASSERT_NE(0.001 * 11, 0.0002 * 55);
  for (const bool fields_first : {true, false}) {
    Clock clock;
    clock.add_events_every(fields_first ? 0.001 : 0.0002, 0.0, 0.02);
    clock.add_events_every(fields_first ? 0.0002 : 0.001, 0.0, 0.02);
    clock.add_event(0.0002 * 55);
    clock.add_event(0.001 * 11);
    while (clock.time() < 0.02) {
      const double dt = clock.land_on_events(1e-4);
      ASSERT_GT(dt, 0.9e-4) << clock.time();
      clock.tick(dt);
    }
  }
}

}  // namespace
}  // namespace ejecta
