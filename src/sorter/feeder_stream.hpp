#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "sorter/feeder.hpp"

namespace ejecta {

/// The endless stream of a feeder, in portions that are functions of their number alone. A portion is some
/// batches: what comes over the lip while a cell of belt passes. It is computed with `run_in` batches more at
/// either end, and only its own are kept: so every particle is in one portion, on its way as in that portion.
class FeederStream {
 public:
  /// What lies on the tray in a batch: a function of its number.
  using Tray = std::function<std::vector<FeedParticle>(std::int64_t batch)>;
  FeederStream(const Case& c, const std::vector<ParticleClass>& classes, double cell_length, Tray tray,
               std::int64_t run_in = 1);

  /// Those that the camera sees in cells [first, last) of the belt, cell after cell.
  std::vector<FeedParticle> cells(std::int64_t first, std::int64_t last) const;
  /// Those of a batch, wherever they come to lie.
  std::vector<FeedParticle> batch(std::int64_t number) const;
  /// Computes what `cells` of these will need, side by side.
  void prepare(std::int64_t first, std::int64_t last) const;

  static constexpr std::int64_t kBatches = 8;  ///< of a portion
 private:
  using Portion = std::vector<std::vector<FeedParticle>>;  // by batch
  std::shared_ptr<const Portion> compute(std::int64_t portion) const;
  std::shared_ptr<const Portion> portion(std::int64_t number) const;
  std::int64_t first_batch(std::int64_t cell) const;
  std::int64_t last_batch(std::int64_t cell) const;

  Feeder feeder_;
  double cell_length_, speed_;
  std::int64_t run_in_;
  Tray tray_;
  mutable std::mutex guard_;
  mutable std::map<std::int64_t, std::shared_ptr<const Portion>> kept_;
};

}  // namespace ejecta
