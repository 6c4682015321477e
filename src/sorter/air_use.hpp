#pragma once
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// What one opening of a valve takes from the supply, by the exact relations of its nozzle.
class AirUse {
 public:
  explicit AirUse(const Case& c);
  double mass(double lasts) const;       ///< kg, of a command that lasts `lasts`, s
  double normal_m3(double mass) const;   ///< at 0 C and 101325 Pa
  double least_work(double mass) const;  ///< J, to compress it at the ambient temperature

 private:
  Case case_;
  std::vector<double> mass_;  ///< kg, by the length of the command
};

}  // namespace ejecta
