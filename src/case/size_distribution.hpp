#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// How large particles are: a law of sizes made ready to draw from.
class SizeDistribution {
 public:
  /// As the keys of a class of particles or of grains say; `sieves`: CSV file, read for that law alone.
  /// Throws InputError where it is no distribution.
  SizeDistribution(SizeLaw law, double size, double size_to, double spread, const std::string& sieves);

  /// Of the share `u` (0 to 1) of the particles, by number, that are smaller; m.
  double quantile(double u) const;
  /// Mean of the `power` of the size over the particles, by number, m^power.
  double mean_power(int power) const;

 private:
  void tabulate(const std::vector<double>& size, const std::vector<double>& finer);
  SizeLaw law_;
  double size_, size_to_, spread_;
  std::vector<double> finer_, sizes_;  ///< by number, ascending: where no formula gives it
};

/// Of a section with the keys `sizes`, `size`, `size_to`, `spread` and `sieves`, a file beside the case.
template <class Spec>
SizeDistribution size_distribution(const Spec& s, const std::string& folder) {
  return {s.sizes, s.size, s.size_to, s.spread, (std::filesystem::path(folder) / s.sieves).string()};
}

}  // namespace ejecta
