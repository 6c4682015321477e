#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>

#include "base/parallel.hpp"

namespace ejecta {

/// Number of blocks of `block` items.
inline int block_count(int count, int block) { return (count + block - 1) / block; }

/// kernel(b, begin, end) for each block of items, in parallel if there is more than one: waking threads costs
/// more than a small block. What a block sums does not depend on the number of threads.
template <class Kernel>
void for_each_block(int count, int block, const Kernel& kernel) {
  const int blocks = block_count(count, block);
  const auto run = [&](int b) { kernel(b, b * block, std::min((b + 1) * block, count)); };
  if (blocks == 1) return run(0);
  if (blocks > 1) for_each_index(blocks, run);
}

/// The largest value(n) of count items, at least `least`: the same for any number of threads.
template <class Value>
double largest_of(int count, int block, double least, const Value& value) {
  const int blocks = block_count(count, block);
  double* largest = detail::partial_sums(blocks).data();
  for_each_block(count, block, [&](int b, int begin, int end) {
    double most = least;
    for (int n = begin; n < end; ++n) most = std::max(most, value(static_cast<std::size_t>(n)));
    largest[b] = most;
  });
  return std::accumulate(largest, largest + blocks, least, [](double a, double b) { return std::max(a, b); });
}

}  // namespace ejecta
