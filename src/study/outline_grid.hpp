#pragma once
#include "study/map_method.hpp"

namespace ejecta {

/// A fine run at every place of a regular grid that lies in the window, as the paper made its maps (3.2):
/// nothing is chosen and nothing assumed of the margin but that it is linear between runs. It costs several
/// times the runs of an OutlineFinder, and is what those are held against.
///
/// Errors are the root mean square by which the four grids of twice the steps differ: four times the error of
/// this grid where the margin is smooth, twice where it has kinks. Without `sure` and `possible`.
class OutlineGrid final : public MapMethod {
 public:
  /// Throws InputError for a window that holds fewer than three rows or columns of the grid.
  explicit OutlineGrid(const MapSettings& settings);

  /// Coarsely spread places come first, so that a map that is watched shows its shape early.
  std::vector<Proposal> ask(int count) override;
  /// Throws InputError for a place that is none of the grid's.
  void tell(const MapRun& run) override;
  Outline outline() const override;
  bool is_finished(const Outline& outline) const override;
  /// None: there is nothing that could contradict a run.
  std::vector<Contradiction> contradictions() const override { return {}; }
  /// Nothing: one run at each place tells no chance.
  std::optional<RasterValues> chance_map(const std::array<double, 2>&) const override { return {}; }

  int places() const { return raster_.nodes(); }

 private:
  /// Of the whole window; a place without a margin, as long as it runs or because it failed, has that of the
  /// nearest one.
  RasterValues margins() const;

  MapSettings settings_;
  Raster raster_;  ///< upper half alone where the map is symmetric
  std::vector<int> order_;
  std::size_t asked_ = 0;
  std::vector<std::optional<double>> told_;
};

}  // namespace ejecta
