#pragma once
#include "study/map_method.hpp"

namespace ejecta {

/// Finds where a margin is positive with few runs (docs/theory/maps.md).
class OutlineFinder final : public MapMethod {
 public:
  /// Throws InputError for a window without area and numbers of runs that are none.
  explicit OutlineFinder(const MapSettings& settings);

  std::vector<Proposal> ask(int count) override;
  /// Runs that nobody asked for are welcome.
  void tell(const MapRun& run) override;
  Outline outline() const override;
  bool is_finished(const Outline& outline) const override;
  std::vector<Contradiction> contradictions() const override;
  std::optional<RasterValues> chance_map(const std::array<double, 2>& arrival_error) const override;

  /// Probability that a fine run ejects at these places, noise included.
  std::vector<double> chances(std::span<const Point2> places) const;

 private:
  int asked(Fidelity fidelity) const;
  MapSettings settings_;
  std::vector<MapRun> runs_;
  std::vector<Proposal> pending_;
};

}  // namespace ejecta
