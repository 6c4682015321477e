#include "study/design.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/random.hpp"

namespace ejecta {
namespace {

/// Primitive polynomial (its inner coefficients as bits) and first direction numbers of a dimension beyond
/// the first: new-joe-kuo-6 of Joe & Kuo 2008.
struct Direction {
  int degree;
  std::uint32_t polynomial;
  std::array<std::uint32_t, 6> m;
};
constexpr std::array<Direction, kSobolDimensions - 1> kDirections{{{1, 0, {1}},
                                                                   {2, 1, {1, 3}},
                                                                   {3, 1, {1, 3, 1}},
                                                                   {3, 2, {1, 1, 1}},
                                                                   {4, 1, {1, 1, 3, 3}},
                                                                   {4, 4, {1, 3, 5, 13}},
                                                                   {5, 2, {1, 1, 5, 5, 17}},
                                                                   {5, 4, {1, 1, 5, 5, 5}},
                                                                   {5, 7, {1, 1, 7, 11, 19}},
                                                                   {5, 11, {1, 1, 5, 1, 1}},
                                                                   {5, 13, {1, 1, 1, 3, 11}},
                                                                   {5, 14, {1, 3, 5, 5, 31}},
                                                                   {6, 1, {1, 3, 3, 9, 7, 49}},
                                                                   {6, 13, {1, 1, 1, 15, 21, 21}},
                                                                   {6, 16, {1, 3, 1, 13, 27, 49}}}};

std::array<std::uint32_t, 32> direction_numbers(int dimension) {
  std::array<std::uint32_t, 32> v{};
  if (dimension == 0) {
    for (std::size_t b = 0; b < 32; ++b) v[b] = 1u << (31 - b);
    return v;
  }
  const Direction& d = kDirections[static_cast<std::size_t>(dimension - 1)];
  const auto s = static_cast<std::size_t>(d.degree);
  for (std::size_t b = 0; b < 32; ++b) {
    if (b < s) {
      v[b] = d.m[b] << (31 - b);
      continue;
    }
    v[b] = v[b - s] ^ (v[b - s] >> s);
    for (std::size_t k = 1; k < s; ++k)
      if ((d.polynomial >> (s - 1 - k)) & 1u) v[b] ^= v[b - k];
  }
  return v;
}

}  // namespace

Samples latin_hypercube(int samples, int dimensions, std::int64_t seed) {
  const auto n = static_cast<std::size_t>(samples), m = static_cast<std::size_t>(dimensions);
  Samples points(n, std::vector<double>(m));
  for (std::size_t d = 0; d < m; ++d) {
    const CounterRandom random(static_cast<std::uint64_t>(seed), d);
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i)  // Fisher and Yates
      std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform(i) * double(i))]);
    for (std::size_t i = 0; i < n; ++i)
      points[i][d] = (double(order[i]) + random.uniform(n + 1 + i)) / double(n);
  }
  return points;
}

Samples sobol(int samples, int dimensions, std::int64_t seed) {
  const auto n = static_cast<std::size_t>(samples), m = static_cast<std::size_t>(dimensions);
  Samples points(n, std::vector<double>(m));
  for (std::size_t d = 0; d < m; ++d) {
    const auto v = direction_numbers(static_cast<int>(d));
    const double shift = CounterRandom(static_cast<std::uint64_t>(seed), d).uniform(0);
    std::uint32_t x = 0;
    for (std::size_t i = 0; i < n; ++i) {
      points[i][d] = std::fmod(double(x) * 0x1p-32 + shift, 1.0);
      std::size_t bit = 0;  // Gray code: the lowest zero of i
      while ((i >> bit) & 1u) ++bit;
      x ^= v[bit];
    }
  }
  return points;
}

}  // namespace ejecta
