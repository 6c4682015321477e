#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/state_reader.hpp"
#include "base/vec.hpp"

namespace ejecta {

/// Turbulence and motion where a grain is.
struct EddyAround {
  double k = 0.0, epsilon = 0.0;  ///< m2/s2, m2/s3
  double slip = 0.0;              ///< m/s, of the grain in the mean flow
  double relaxation = 0.0;        ///< s, of the grain
};

/// Dispersion of grains by turbulence: each flies through one eddy after the other, in which the fluid has a
/// velocity of its own beside the mean one, normally distributed with the variance 2 k / 3 along each axis
/// (Gosman & Ioannides 1983, J. Energy 7:482). An eddy lasts twice the Lagrangian time 0.15 k / epsilon, or
/// until the grain has crossed it (C_mu^(3/4) k^(3/2) / epsilon). What follows nearly as fast as the fluid
/// gathers where turbulence is weak, which fluid does not: the walk knows no gradient of k.
class EddyWalk {
 public:
  explicit EddyWalk(std::uint64_t seed) : seed_(seed) {}
  void grow(std::size_t grains) { eddies_.resize(std::max(eddies_.size(), grains)); }
  /// Mean velocity of the eddies that a grain meets over the next dt, m/s. Of different grains in any order.
  Vec3 velocity(std::size_t grain, const EddyAround& around, double dt);

  void add_state(std::vector<double>& to) const;
  void restore(StateReader& in, std::size_t grains);

 private:
  struct Eddy {
    Vec3 velocity{0, 0, 0};  // m/s
    double left = 0.0;       // s, of its life
    std::uint64_t drawn = 0;
  };
  Vec3 draw(std::size_t grain, Eddy& e) const;

  std::uint64_t seed_;
  std::vector<Eddy> eddies_;  // in which each grain is
};

}  // namespace ejecta
