#include "base/parallel.hpp"

#include <sched.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>

#include "base/storage.hpp"
#include "base/team.hpp"

namespace ejecta {
namespace {

int threads_at_start() {
  const char* asked = std::getenv("OMP_NUM_THREADS");  // the name that job schedulers set
  const int threads = asked ? std::atoi(asked) : 0;
  return threads > 0 ? threads : core_count();
}

struct Caller {
  int threads = threads_at_start();
  bool in_loop = false;  // a loop inside a loop runs on the thread that meets it
  std::unique_ptr<detail::Team> team;
};
thread_local Caller caller;

}  // namespace

int core_count() {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof cores, &cores) == 0 ? std::max(1, CPU_COUNT(&cores)) : 1;
}

int thread_count() { return caller.threads; }

void set_thread_count(int threads) { caller.threads = std::max(1, threads); }

void flush_denormals() {
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
}

Real* thread_scratch(std::size_t count, int slot) {
  struct Buffer {
    std::unique_ptr<void, FreeStorage> data;
    std::size_t count = 0;
  };
  thread_local std::array<Buffer, 4> buffers;
  Buffer& b = buffers.at(static_cast<std::size_t>(slot));
  if (b.count < count) {
    b.data = allocate_storage(count * sizeof(Real));
    b.count = count;
  }
  return static_cast<Real*>(b.data.get());
}

namespace detail {

void run_pieces(int pieces, PieceBody body, const void* kernel) {
  Caller& c = caller;
  if (!c.in_loop) flush_denormals();
  if (c.in_loop || c.threads == 1 || pieces <= 1) {
    for (int piece = 0; piece < pieces; ++piece) body(kernel, piece);
    return;
  }
  if (!c.team || c.team->size() != c.threads) {
    c.team.reset();
    c.team = std::make_unique<Team>(c.threads);
  }
  struct InLoop {
    bool& in_loop;
    explicit InLoop(bool& flag) : in_loop(flag) { in_loop = true; }
    ~InLoop() { in_loop = false; }
  } const in_loop(c.in_loop);
  c.team->run(pieces, body, kernel);
}

std::vector<double>& partial_sums(int count) {
  thread_local std::vector<double> sums;
  if (sums.size() < static_cast<std::size_t>(count)) sums.resize(static_cast<std::size_t>(count));
  return sums;
}

}  // namespace detail
}  // namespace ejecta
