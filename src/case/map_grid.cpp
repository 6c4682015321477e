#include "case/map_grid.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

constexpr double kHair = 1e-9;  // of a step: the window's ends count
constexpr double kMost = 1e6;   // more rows than anyone runs

}  // namespace

MapGrid map_grid(const std::array<double, 2>& along, const std::array<double, 2>& across,
                 const std::array<double, 2>& steps) {
  const auto first = [](double low, double step) {
    return static_cast<int>(std::clamp(std::ceil(low / step - kHair), -kMost, kMost));
  };
  const auto last = [](double high, double step) {
    return static_cast<int>(std::clamp(std::floor(high / step + kHair), -kMost, kMost));
  };
  return {first(along[0], steps[0]), last(along[1], steps[0]), first(across[0], steps[1]),
          last(across[1], steps[1])};
}

}  // namespace ejecta
