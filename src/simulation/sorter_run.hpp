#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "simulation/sorter_result.hpp"
#include "sorter/sorting.hpp"

namespace ejecta {

/// The directory of a sorter: state.json says how far it is, and of what.
class SorterDirectory {
 public:
  /// `input`: of the case, as a sum; `force`: start anew. Throws InputError where another thing lies there.
  SorterDirectory(std::filesystem::path path, std::string input, bool force);
  /// Throws InputError where the case was another.
  SorterState read(std::size_t kinds) const;
  void write(const SorterState& state) const;
  std::filesystem::path file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path state() const { return path_ / "state.json"; }
  std::filesystem::path path_;
  std::string input_;
};

/// Cells that are computed in one piece.
inline constexpr std::int64_t kSorterPiece = 4;

/// Cells of belt until about sorter.particles have passed, or until the file of the feed ends.
std::int64_t cells_of_sorter(const Case& c, const Feed& feed);

/// What will pass: expected values, of a feed from a file what it holds.
struct SorterForecast {
  double particles = 0.0, belt = 0.0, time = 0.0;  ///< belt: m that passes; s
  double mass = 0.0, cover = 0.0;                  ///< kg; share of the belt
};
SorterForecast sorter_forecast(const Case& c);

/// Goes on from `state` to `cells`, a portion at a time on all threads, each the same whatever came before
/// it. keep(state) after every portion; false: stop() said so first. Throws InputError.
bool run_sorter(const Case& c, const Sorter& sorter, std::int64_t cells, SorterState& state,
                const std::function<void(const SorterState&)>& keep, const std::function<bool()>& stop);

}  // namespace ejecta
