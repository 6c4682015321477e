#include "base/team.hpp"

#include <immintrin.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <climits>

#include "base/parallel.hpp"

namespace ejecta::detail {
namespace {

/// How long a thread looks before it sleeps: longer than what the program does between two loops, shorter
/// than a core's time slice by far.
constexpr std::chrono::microseconds kLook{100};

template <class Condition>
bool comes_true_soon(const Condition& condition) {
  if (condition()) return true;
  const auto until = std::chrono::steady_clock::now() + kLook;
  do {
    for (int n = 0; n < 16; ++n) {
      _mm_pause();
      if (condition()) return true;
    }
  } while (std::chrono::steady_clock::now() < until);
  return false;
}

/// Not std::atomic::wait: GCC's yields the core some times first, and who only yields is not woken at once.
void sleep_while(std::atomic<std::uint32_t>& word, std::uint32_t value) {
  syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
}
void wake(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
}

constexpr std::uint64_t packed(std::uint64_t first, std::uint64_t end) { return first | end << 32; }
constexpr std::uint32_t first_of(std::uint64_t pieces) { return static_cast<std::uint32_t>(pieces); }
constexpr std::uint32_t end_of(std::uint64_t pieces) { return static_cast<std::uint32_t>(pieces >> 32); }

/// The first or the last of the pieces left, or -1.
int take(std::atomic<std::uint64_t>& share, bool last) {
  std::uint64_t left = share.load();
  while (first_of(left) < end_of(left)) {
    const std::uint32_t first = first_of(left), end = end_of(left);
    if (share.compare_exchange_weak(left, last ? packed(first, end - 1) : packed(first + 1, end)))
      return static_cast<int>(last ? end - 1 : first);
  }
  return -1;
}

}  // namespace

Team::Team(int threads) : shares_(static_cast<std::size_t>(threads)) {
  for (int n = 1; n < threads; ++n) workers_.emplace_back([this, n] { work(n); });
}

Team::~Team() {
  ends_ = true;
  ++loops_;
  wake(loops_);
  for (std::thread& worker : workers_) worker.join();
}

void Team::run(int pieces, PieceBody body, const void* kernel) {
  body_ = body;
  kernel_ = kernel;
  unfinished_ = static_cast<std::uint32_t>(pieces);
  const auto count = static_cast<std::uint64_t>(pieces), threads = static_cast<std::uint64_t>(size());
  for (std::uint64_t n = 0; n < threads; ++n)
    shares_[n].pieces = packed(count * n / threads, count * (n + 1) / threads);
  ++loops_;
  if (sleepers_ > 0) wake(loops_);
  take_pieces(0);
  if (!comes_true_soon([this] { return unfinished_ == 0; })) {
    caller_sleeps_ = true;
    while (const std::uint32_t left = unfinished_) sleep_while(unfinished_, left);
    caller_sleeps_ = false;
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::work(int self) {
  flush_denormals();
  while (!ends_) {
    const std::uint32_t seen = loops_;
    take_pieces(self);
    if (comes_true_soon([&] { return loops_ != seen; })) continue;
    ++sleepers_;
    while (loops_ == seen) sleep_while(loops_, seen);
    --sleepers_;
  }
}

void Team::take_pieces(int self) {
  for (int n = 0; n < size(); ++n) {
    Share& share = shares_[static_cast<std::size_t>((self + n) % size())];
    for (int piece; (piece = take(share.pieces, n > 0)) >= 0;) run_piece(piece);
  }
}

void Team::run_piece(int piece) {
  try {
    body_(kernel_, piece);
  } catch (...) {
    const std::lock_guard lock(failing_);
    if (!failure_) failure_ = std::current_exception();
  }
  if (--unfinished_ == 0 && caller_sleeps_) wake(unfinished_);
}

}  // namespace ejecta::detail
