#pragma once
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// The way of a prescribed body as measured or drawn: what is added to its position and rotation at some
/// times.
struct PathTable {
  std::vector<double> time;   ///< s, ascending
  std::vector<Vec3> way;      ///< m
  std::vector<double> angle;  ///< rad
};

/// Reads a CSV file whose head gives each column its name and unit, e.g. "t [ms], z [mm]"; blank lines and
/// lines that begin with # are passed over. What is wrong goes to `problems`, with its line in that file.
PathTable read_path_file(const std::string& file, std::vector<Problem>& problems);

}  // namespace ejecta
