#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "case/case.hpp"
#include "case/problem.hpp"
#include "sorter/feeder_stream.hpp"
#include "sorter/particle_class.hpp"

namespace ejecta {

/// The feed as it lies on the belt: an endless strip, cut into cells of one length. What lies in a cell is a
/// function of the seed and the cell's number alone (of a monolayer: of its two neighbours' too; of a feeder:
/// sorter/feeder_stream.hpp), so that any part of the strip can be made at any time.
class Feed {
 public:
  explicit Feed(const Case& c);
  Feed(const Feed&) = delete;  // its feeder asks it for what lies on the tray
  Feed& operator=(const Feed&) = delete;

  /// Particles whose centres lie in [x of cell `first`, x of cell `last`), cell after cell.
  std::vector<FeedParticle> cells(std::int64_t first, std::int64_t last) const;
  /// The same as they are laid: of a feeder on its tray, x from the lip.
  std::vector<FeedParticle> laid(std::int64_t first, std::int64_t last) const;
  /// Of a feeder: computes what these cells need, on all threads.
  void prepare(std::int64_t first, std::int64_t last) const {
    if (feeder_) feeder_->prepare(first, last);
  }
  double cell_length() const { return cell_length_; }
  std::int64_t cell_of(double x) const { return static_cast<std::int64_t>(std::floor(x / cell_length_)); }
  /// Expected number of particles of a class a cell.
  double mean_count(std::size_t kind) const { return mean_count_[kind]; }
  double mean_count() const;
  /// Cells that a feed from a file fills; 0: the strip has no end.
  std::int64_t cells_of_file() const { return file_.empty() ? 0 : cell_of(file_.back().x) + 1; }
  const std::vector<ParticleClass>& classes() const { return classes_; }

 private:
  void read_file(const Case& c);
  FeedParticle drawn_of(std::size_t kind, const CounterRandom& what, std::uint64_t& at) const;
  std::vector<FeedParticle> drawn(std::int64_t cell) const;
  void place(std::int64_t cell, std::vector<FeedParticle>& particles,
             const std::vector<FeedParticle>& beside) const;
  std::vector<FeedParticle> even_cell(std::int64_t cell) const;

  SorterSpec sorter_;
  FeedSpec feed_;
  std::vector<ParticleClass> classes_;
  std::vector<double> mean_count_;
  std::vector<FeedParticle> file_;  ///< x ascending
  double cell_length_ = 0.0;
  double laid_length_ =
      0.0;  ///< m, of a cell where its particles are laid: on the belt, or on a feeder's tray
  std::unique_ptr<const FeederStream> feeder_;
};

/// What is wrong with the feed that a case asks for: shares, sizes, more than the belt carries.
std::vector<Problem> check_feed(const Case& c);

}  // namespace ejecta
