#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/vec.hpp"

namespace ejecta {

/// A rotation drawn uniformly, from three numbers uniform in [0, 1) (Shoemake 1992, Graphics Gems III).
inline Quat uniform_rotation(double u, double v, double w) {
  const double a = 2 * std::numbers::pi * v, b = 2 * std::numbers::pi * w;
  return Quat(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
              std::sqrt(u) * std::sin(b));
}

/// Random numbers by counting: the n-th number of a stream is a pure function of seed, stream and n, so that
/// any order of work and any number of threads give the same draws. Philox 4x32 with ten rounds (Salmon et
/// al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  /// 128 random bits.
  std::array<std::uint32_t, 4> bits(std::uint64_t n) const {
    std::uint32_t key0 = low(seed_), key1 = high(seed_);
    std::array<std::uint32_t, 4> c{low(n), high(n), low(stream_), high(stream_)};
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
      c = {high(b) ^ c[1] ^ key0, low(b), high(a) ^ c[3] ^ key1, low(a)};
      key0 += 0x9E3779B9;
      key1 += 0xBB67AE85;
    }
    return c;
  }

  /// In the open interval (0, 1), on a grid of 2^-52.
  double uniform(std::uint64_t n) const {
    const auto b = bits(n);
    return unit(b[0], b[1]);
  }

  /// Two independent draws of the normal distribution (Box and Muller 1958).
  std::array<double, 2> normals(std::uint64_t n) const {
    const auto b = bits(n);
    const double radius = std::sqrt(-2.0 * std::log(unit(b[0], b[1])));
    const double angle = 2.0 * std::numbers::pi * unit(b[2], b[3]);
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  double normal(std::uint64_t n) const { return normals(n)[0]; }

 private:
  static std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
  static std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
  static double unit(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t whole = ((std::uint64_t{a} << 32) | b) >> 12;  // 52 bits and a half: never 0 or 1
    return (static_cast<double>(whole) + 0.5) * 0x1p-52;
  }

  std::uint64_t seed_, stream_;
};

}  // namespace ejecta
