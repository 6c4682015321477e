#pragma once
#include <utility>
#include <vector>

#include "base/vec.hpp"

namespace ejecta {

/// Finds pairs of balls nearer than a distance in O(n): sorts them into cells of a lattice and looks from
/// each into the rest of its cell and the 13 neighbouring cells that come after it. The few that are much
/// larger than most (lumps among grains) look into all cells that they reach. Keeps its buffers.
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
  void set_large_apart(const std::vector<Item>& items);
  void sort_into_cells(const std::vector<Item>& items, double edge);
  void find_of_large(const std::vector<Item>& items, std::size_t n, double reach,
                     std::vector<std::pair<int, int>>& pairs) const;
  /// Positions (in the order of cells) of the neighbours that come after position p, into `near`; how many.
  std::size_t neighbours_after(int p, double reach, std::vector<int>& near) const;
  void sort_pairs(int items);

  struct Lattice {
    Vec3 origin{0, 0, 0};
    double edge = 1.0;
    int n[3] = {1, 1, 1};
  } lattice_;
  struct Sorted {
    double x = 0, y = 0, z = 0, radius = 0;
    int body = 0, index = 0, cell = 0;
  };
  struct Found {
    std::vector<int> near;
    std::vector<std::pair<int, int>> pairs;
  };
  std::vector<int> small_, large_;  // items
  double largest_small_ = 0.0;      // m, radius
  std::vector<double> radii_;       // scratch
  std::vector<int> cell_of_, first_, cursor_;
  std::vector<Sorted> sorted_;  // by cell, so that a search reads on and on
  std::vector<Found> found_;    // by block of items
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace ejecta
