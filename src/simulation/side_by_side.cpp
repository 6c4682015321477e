#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include "simulation/forecast.hpp"

namespace ejecta {
namespace {

/// Bytes that programs may still take without swapping.
double available_memory() {
  std::ifstream info("/proc/meminfo");
  std::string name;
  double kilobytes = 0.0;
  for (std::string rest; info >> name >> kilobytes && std::getline(info, rest);)
    if (name == "MemAvailable:") return 1024.0 * kilobytes;
  return 1e300;
}

}  // namespace

int runs_side_by_side(const Case& c) {
  const double cores = std::max(1u, std::thread::hardware_concurrency());
  const double fitting = available_memory() / std::max(1.0, forecast(c).memory);
  return static_cast<int>(std::clamp(fitting, 1.0, cores));
}

}  // namespace ejecta
