#include "base/parallel.hpp"

#include <omp.h>

namespace ejecta {

int thread_count() { return omp_get_max_threads(); }

void set_thread_count(int threads) { omp_set_num_threads(threads); }

namespace detail {

std::vector<double>& partial_sums(int count) {
  thread_local std::vector<double> sums;
  if (sums.size() < static_cast<std::size_t>(count)) sums.resize(static_cast<std::size_t>(count));
  return sums;
}

}  // namespace detail
}  // namespace ejecta
