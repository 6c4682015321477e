#pragma once
#include <vector>

namespace ejecta {

/// One axis of the tensor-product grid, in double, without ghosts.
struct Axis {
  int n = 0;
  std::vector<double> face;    ///< n + 1 positions, m
  std::vector<double> centre;  ///< n positions, m
  std::vector<double> width;   ///< n widths, m

  double length() const { return face.back() - face.front(); }
  double smallest() const;
  double largest() const;
  /// Index of the cell that holds x, clamped to [0, n).
  int cell_at(double x) const;
};

/// Blocks between `points`, each with its number of cells and its grading = last cell / first cell
/// (geometric). Throws InputError when points do not increase or counts do not fit.
Axis make_axis(const std::vector<double>& points, const std::vector<int>& cells,
               const std::vector<double>& grading);

}  // namespace ejecta
