#pragma once
#include <array>
#include <string>
#include <vector>

#include "case/problem.hpp"

namespace ejecta {

/// Corners (x, y) of a measured outline of a map, m, from a CSV with the head "x [mm], y [mm]" (see
/// read_csv). What is wrong goes to `problems`, with its line.
std::vector<std::array<double, 2>> read_outline_file(const std::string& file, std::vector<Problem>& problems);

}  // namespace ejecta
