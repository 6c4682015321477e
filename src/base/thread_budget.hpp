#pragma once
#include "base/parallel.hpp"

namespace ejecta {

/// So many threads for the loops that the calling thread starts, as long as this lives; 0: leaves them. The
/// thread flushes denormals from here on, as its team does: a thread of a foreign program may not yet.
class ThreadBudget {
 public:
  explicit ThreadBudget(int threads) : before_(thread_count()) {
    flush_denormals();
    if (threads > 0) set_thread_count(threads);
  }
  ~ThreadBudget() { set_thread_count(before_); }
  ThreadBudget(const ThreadBudget&) = delete;
  ThreadBudget& operator=(const ThreadBudget&) = delete;

 private:
  int before_;
};

}  // namespace ejecta
