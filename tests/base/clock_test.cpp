#include "base/clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ejecta {
namespace {

TEST(Clock, LandsOnEventsAndNeverTakesATinyStep) {
  Clock clock;
  clock.add_event(1.0);
  clock.add_event(0.25);
  double least = 1.0;
  bool landed = false;
  while (clock.time() < 1.0) {
    const Step step = clock.next(0.1);
    least = std::min(least, step.dt);
    clock.tick(step);
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
      const Step step = clock.next(1e-4);
      ASSERT_GT(step.dt, 0.9e-4) << clock.time();
      clock.tick(step);
    }
  }
}

/// The steps of a model that asks for `asked(time)`.
template <class Asked>
std::vector<double> steps_to(double end, double interval, const Asked& asked) {
  Clock clock;
  clock.add_events_every(interval, 0.0, end);
  clock.add_event(end);
  std::vector<double> steps;
  while (clock.time() < end) {
    const Step step = clock.next(asked(clock.time()));
    EXPECT_LE(step.dt, asked(clock.time()) * (1 + 1e-9));
    steps.push_back(step.dt);
    clock.tick(step);
  }
  return steps;
}

/// The forces of a run answer a sudden short step: the last ones must be like those before.
TEST(Clock, MeetsAnEventWithoutAJolt) {
  for (double end = 20.0; end < 21.0; end += 0.003) {
    const auto steps = steps_to(end, 0.0, [](double) { return 1.0; });
    for (std::size_t n = 1; n < steps.size(); ++n) {
      ASSERT_GE(steps[n], 0.8) << end << ' ' << n;
      ASSERT_NEAR(steps[n], steps[n - 1], 0.2) << end << ' ' << n;
    }
    ASSERT_LE(steps.size(), std::ceil(end) + 1.0);
  }
}

/// While the step itself changes by a per cent from one to the next.
TEST(Clock, MeetsAnEventWithoutAJoltWhileTheStepChanges) {
  for (const double sign : {1.0, -1.0})
    for (double end = 20.0; end < 21.0; end += 0.003) {
      const auto asked = [&](double t) { return std::exp(sign * 0.01 * (t - 20.0)); };
      const auto steps = steps_to(end, 0.0, asked);
      double t = 0.0;
      for (const double dt : steps_to(end, 0.0, asked)) {
        ASSERT_GE(dt, 0.75 * asked(t)) << sign << ' ' << end << ' ' << t;
        t += dt;
      }
    }
}

TEST(Clock, StepsThatFitStayAsTheyAre) {
  for (const double dt : steps_to(1.0, 0.1, [](double) { return 0.0125; })) ASSERT_NEAR(dt, 0.0125, 1e-12);
}

/// As many as a run could never see cost nothing.
TEST(Clock, DenseEventsAreNotStored) {
  Clock clock;
  clock.add_events_every(1e-13, 0.0, 1.0);
  clock.add_events_every(1e-300, 0.5, 1.0);
  for (int n = 1; n < 1000; ++n) {
    const Step step = clock.next(1e-3);
    ASSERT_NEAR(step.dt, 1e-13, 1e-18);
    clock.tick(step);
  }
  clock.restore(0.75, 1000);  // where neighbouring events are nearer than neighbouring numbers
  const Step step = clock.next(1e-3);
  EXPECT_GT(step.dt, 0.0);
  clock.tick(step);
  EXPECT_GT(clock.time(), 0.75);
  clock.restore(1.1, 1001);
  EXPECT_EQ(clock.next(1e-3).dt, 1e-3);
}

}  // namespace
}  // namespace ejecta
