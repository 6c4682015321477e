#pragma once
#include <utility>
#include <vector>

#include "base/vec.hpp"

namespace ejecta {

/// Finds pairs of balls nearer than a distance in O(n): sorts them into cells of a lattice and looks into the
/// 27 cells around each. Keeps its buffers.
class NeighbourSearch {
 public:
  struct Item {
    Vec3 centre{0, 0, 0};
    double radius = 0.0;
    int body = 0;  ///< items of one body are no neighbours
  };

  /// All pairs (i, j), i < j, of different bodies with gap < reach, sorted.
  const std::vector<std::pair<int, int>>& find(const std::vector<Item>& items, double reach);

 private:
  void sort_into_cells(const std::vector<Item>& items, double edge);
  void neighbours_of(const std::vector<Item>& items, int i, double reach,
                     std::vector<std::pair<int, int>>& out) const;

  struct Lattice {
    Vec3 origin{0, 0, 0};
    double edge = 1.0;
    int n[3] = {1, 1, 1};
  } lattice_;
  struct Sorted {
    Item item;
    int index = 0;
  };
  std::vector<int> cell_of_, first_, cursor_;
  std::vector<Sorted> sorted_;                           // by cell, so that a search reads on and on
  std::vector<std::vector<std::pair<int, int>>> found_;  // by block of items
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace ejecta
