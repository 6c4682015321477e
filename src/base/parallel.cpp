#include "base/parallel.hpp"

#include <omp.h>
#include <xmmintrin.h>

#include <array>
#include <memory>

#include "base/storage.hpp"

namespace ejecta {
namespace {

/// Numbers too small for full precision become zero, in every program from its first line (threads inherit
/// it): ahead of a wave fields fade through them, and the processor is ten times slower there.
[[maybe_unused]] const bool denormals_flushed = [] {
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
  return true;
}();

}  // namespace

int thread_count() { return omp_get_max_threads(); }

void set_thread_count(int threads) { omp_set_num_threads(threads); }

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

std::vector<double>& partial_sums(int count) {
  thread_local std::vector<double> sums;
  if (sums.size() < static_cast<std::size_t>(count)) sums.resize(static_cast<std::size_t>(count));
  return sums;
}

}  // namespace detail
}  // namespace ejecta
