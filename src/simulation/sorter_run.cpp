#include "simulation/sorter_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "output/output_file.hpp"

namespace ejecta {
namespace {

constexpr std::int64_t kPieces = 8;  ///< pieces between two checkpoints

}  // namespace

SorterDirectory::SorterDirectory(std::filesystem::path path, std::string input, bool force)
    : path_(std::move(path)), input_(std::move(input)) {
  const bool mine = std::filesystem::exists(state());
  std::error_code none;
  if (!mine && !output::holds_no_file(path_, "state.json", none))
    throw InputError(fmt::format("{} is there and is no directory of a sorter\n  expected: another --out",
                                 path_.string()));
  if (mine && force) {  // the state last: it says whose directory this is
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      if (entry.path() != state()) std::filesystem::remove_all(entry.path());
    std::filesystem::remove(state());
  }
  std::filesystem::create_directories(path_);
  if (!std::filesystem::exists(state())) write({});
}

SorterState SorterDirectory::read(std::size_t kinds) const {
  nlohmann::ordered_json json;
  try {
    json = nlohmann::ordered_json::parse(output::read_file(state()));
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{} is damaged\n  expected: --force, to start anew", state().string()));
  }
  if (json.value("input_sha256", "") != input_)
    throw InputError(
        fmt::format("{} holds the results of another case, or of this one before it was changed\n"
                    "  expected: --force, to start anew, or another --out",
                    path_.string()));
  return sorter_state(json, kinds);
}

void SorterDirectory::write(const SorterState& s) const {
  nlohmann::ordered_json json{{"input_sha256", input_}};
  json.update(json_of(s));
  output::write_file(state(), json.dump());
}

std::int64_t cells_of_sorter(const Case& c, const Sorter& sorter) {
  const Feed& feed = sorter.feed();
  if (feed.cells_of_file() > 0) return feed.cells_of_file();
  return std::max<std::int64_t>(1,
                                static_cast<std::int64_t>(std::ceil(c.sorter.particles / feed.mean_count())));
}

bool run_sorter(const Case& c, const Sorter& sorter, std::int64_t cells, SorterState& state,
                const std::function<void(const SorterState&)>& keep, const std::function<bool()>& stop) {
  while (state.cells < cells) {
    if (stop()) return false;
    const double began = wall_seconds();
    const std::int64_t until = std::min(cells, state.cells + kSorterPiece * kPieces);
    const auto pieces = static_cast<int>((until - state.cells + kSorterPiece - 1) / kSorterPiece);
    std::vector<SortedStretch> sorted(static_cast<std::size_t>(pieces));
    std::vector<std::string> failed(static_cast<std::size_t>(pieces));
    sorter.prepare(state.cells, until);
    for_each_index_dynamic(pieces, [&](int n) {
      const std::int64_t first = state.cells + n * kSorterPiece;
      try {
        sorted[static_cast<std::size_t>(n)] = sorter.sort(first, std::min(first + kSorterPiece, until));
      } catch (const InputError& e) {
        failed[static_cast<std::size_t>(n)] = e.what();
      }
    });
    for (const std::string& why : failed)
      if (!why.empty()) throw InputError(why);
    for (const SortedStretch& piece : sorted)
      for (const Tally& cell : piece.cells) state.products.add(cell, c.classes);
    state.cells = until;
    state.wall_time += wall_seconds() - began;
    keep(state);
  }
  return true;
}

}  // namespace ejecta
