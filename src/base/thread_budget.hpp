#pragma once
#include <xmmintrin.h>

#include "base/parallel.hpp"

namespace ejecta {

/// So many threads for the loops that the calling thread starts, as long as this lives; 0: leaves them. As
/// long the thread flushes denormals, as its team does; then it rounds as before: it may be that of a foreign
/// program.
class ThreadBudget {
 public:
  explicit ThreadBudget(int threads) : rounding_(_mm_getcsr()), before_(thread_count()) {
    flush_denormals();
    if (threads > 0) set_thread_count(threads);
  }
  ~ThreadBudget() {
    set_thread_count(before_);
    _mm_setcsr(rounding_);
  }
  ThreadBudget(const ThreadBudget&) = delete;
  ThreadBudget& operator=(const ThreadBudget&) = delete;

 private:
  unsigned rounding_;
  int before_;
};

}  // namespace ejecta
