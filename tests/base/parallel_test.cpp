#include "base/parallel.hpp"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/thread_budget.hpp"

namespace ejecta {
namespace {

constexpr unsigned kFlushes = 0x8040;  // bits of the processor's mode: results and arguments

double a_sum() {
  const Range3 r{0, 37, 0, 11, 0, 23};
  return reduce_sum(r, [](int i, int j, int k) { return Real(1) / Real(1 + i + 3 * j + 7 * k); });
}

TEST(Parallel, SumsHaveTheSameBitsForAnyNumberOfThreads) {
  const double alone = [] {
    const ThreadBudget one(1);
    return a_sum();
  }();
  for (const int threads : {2, 3, 7}) {
    const ThreadBudget budget(threads);
    for (int n = 0; n < 50; ++n) EXPECT_EQ(a_sum(), alone) << threads;
  }
}

TEST(Parallel, EveryEntryIsVisitedOnceWhateverTheThreadsAreBusyWith) {
  const ThreadBudget budget(3);
  for (const int count : {0, 1, 2, 5, 97}) {
    std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
    const auto visit = [&](int n) { ++visits[static_cast<std::size_t>(n)]; };
    for (int repeat = 0; repeat < 300; ++repeat) {
      for_each_index(count, visit);
      for_each_index_dynamic(count, visit);
      for_each_chunk(count, [&](int begin, int end) {
        for (int n = begin; n < end; ++n) visit(n);
      });
    }
    for (const auto& v : visits) EXPECT_EQ(v, 900);
  }
}

TEST(Parallel, APieceThatTakesLongHoldsUpOnlyItself) {
  const ThreadBudget budget(2);
  std::atomic<int> others{0};
  bool all_others_done = false;
  for_each_index(16, [&](int n) {
    if (n > 0) {
      ++others;
      return;
    }
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (others < 15 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
    all_others_done = others == 15;
  });
  EXPECT_TRUE(all_others_done);
}

TEST(Parallel, ALoopInsideALoopRunsOnItsThread) {
  const ThreadBudget budget(3);
  std::atomic<int> sum{0};
  for_each_index(6, [&](int) { for_each_index(5, [&](int n) { sum += n; }); });
  EXPECT_EQ(sum, 60);
}

TEST(Parallel, WhatAPieceThrowsComesToTheCaller) {
  const ThreadBudget budget(3);
  const auto fail = [] {
    for_each_index(12, [](int n) {
      if (n == 7) throw std::runtime_error("seven");
    });
  };
  for (int n = 0; n < 20; ++n) EXPECT_THROW(fail(), std::runtime_error);
  EXPECT_NO_THROW(for_each_index(12, [](int) {}));
}

TEST(Parallel, CallersSideBySideHaveTeamsOfTheirOwn) {
  const double alone = a_sum();
  std::atomic<int> equal{0};
  std::vector<std::thread> callers;
  for (int n = 0; n < 8; ++n)
    callers.emplace_back([&, n] {
      const ThreadBudget budget(1 + n % 3);
      for (int repeat = 0; repeat < 20; ++repeat) equal += a_sum() == alone;
    });
  for (std::thread& c : callers) c.join();
  EXPECT_EQ(equal, 160);
}

TEST(Parallel, ThreadsOfAnyProgramFlushDenormals) {
  std::atomic<int> flushing{0};
  std::thread foreign([&] {
    _mm_setcsr(_mm_getcsr() & ~kFlushes);
    const ThreadBudget budget(3);
    for_each_index(24, [&](int) { flushing += (_mm_getcsr() & kFlushes) == kFlushes; });
  });
  foreign.join();
  EXPECT_EQ(flushing, 24);
}

TEST(Parallel, TheLargestIsFoundAndANanIsSeen) {
  const ThreadBudget budget(3);
  const Range3 r{0, 19, 0, 3, 0, 17};
  const auto value = [](int i, int j, int k) { return Real(i + 100 * j + 1000 * k); };
  EXPECT_EQ(reduce_max(r, value), Real(18 + 200 + 16000));
  EXPECT_TRUE(std::isnan(reduce_max(r, [&](int i, int j, int k) {
    return i == 3 && j == 1 && k == 9 ? std::numeric_limits<Real>::quiet_NaN() : value(i, j, k);
  })));
}

}  // namespace
}  // namespace ejecta
