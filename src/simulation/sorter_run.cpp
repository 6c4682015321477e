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

/// work(piece) for each, side by side; the first that cannot be done says why.
void for_each_piece(int pieces, const std::function<void(int)>& work) {
  std::vector<std::string> failed(static_cast<std::size_t>(pieces));
  for_each_index_dynamic(pieces, [&](int n) {
    try {
      work(n);
    } catch (const InputError& e) {
      failed[static_cast<std::size_t>(n)] = e.what();
    }
  });
  for (const std::string& why : failed)
    if (!why.empty()) throw InputError(why);
}

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
  try {
    const auto json = nlohmann::ordered_json::parse(output::read_file(state()));
    if (json.at("input_sha256").get<std::string>() != input_)
      throw InputError(
          fmt::format("{} holds the results of another case, or of this one before it was changed\n"
                      "  expected: --force, to start anew, or another --out",
                      path_.string()));
    return sorter_state(json, kinds);
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{} is damaged\n  expected: --force, to start anew", state().string()));
  }
}

void SorterDirectory::write(const SorterState& s) const {
  nlohmann::ordered_json json{{"input_sha256", input_}};
  json.update(json_of(s));
  output::write_file(state(), json.dump());
}

std::int64_t cells_of_sorter(const Case& c, const Feed& feed) {
  if (feed.cells_of_file() > 0) return feed.cells_of_file();
  return std::max<std::int64_t>(1,
                                static_cast<std::int64_t>(std::ceil(c.sorter.particles / feed.mean_count())));
}

SorterForecast sorter_forecast(const Case& c) {
  const Feed feed(c);
  const std::int64_t cells = cells_of_sorter(c, feed);
  SorterForecast f{.belt = static_cast<double>(cells) * feed.cell_length()};
  f.time = f.belt / c.launch.belt_speed;
  double area = 0.0;
  if (feed.cells_of_file() > 0) {
    for (const FeedParticle& p : feed.cells(0, cells)) {
      f.particles += 1.0;
      f.mass += p.mass;
      area += plan_area(p);
    }
  } else {
    for (std::size_t k = 0; k < c.classes.size(); ++k) {
      const double count = feed.mean_count(k) * static_cast<double>(cells);
      f.particles += count;
      f.mass += count * feed.classes()[k].mean_mass();
      area += count * feed.classes()[k].mean_area();
    }
  }
  f.cover = area / (f.belt * c.sorter.belt_width);
  return f;
}

bool run_sorter(const Case& c, const Sorter& sorter, std::int64_t cells, SorterState& state,
                const std::function<void(const SorterState&)>& keep, const std::function<bool()>& stop) {
  const auto halo = static_cast<std::size_t>(sorter.halo());
  if (state.vessel.empty()) state.vessel.assign(halo + 1, sorter.vessel().full());
  while (state.cells < cells) {
    if (stop()) return false;
    const double began = wall_seconds();
    const std::int64_t until = std::min(cells, state.cells + kSorterPiece * kPieces);
    const auto pieces = static_cast<int>((until - state.cells + kSorterPiece - 1) / kSorterPiece);
    const auto first_of = [&](int n) { return std::min(state.cells + n * kSorterPiece, until); };
    sorter.prepare(state.cells, until);
    // Of a vessel: what all valves do, side by side, then what it leaves, cell after cell.
    std::vector<double> vessel = state.vessel;  // at the beginnings of the cells, from the halo of the first
    if (sorter.vessel().is_there()) {
      std::vector<ValvePulses> pulses(static_cast<std::size_t>(pieces));
      for_each_piece(pieces, [&](int n) {
        pulses[static_cast<std::size_t>(n)] = sorter.pulses(first_of(n), first_of(n + 1));
      });
      for (int n = 0; n < pieces; ++n)
        for (std::int64_t cell = first_of(n); cell < first_of(n + 1); ++cell)
          vessel.push_back(sorter.vessel().after(pulses[static_cast<std::size_t>(n)], sorter.comes_at(cell),
                                                 sorter.comes_at(cell + 1), vessel.back()));
    } else {
      vessel.resize(vessel.size() + static_cast<std::size_t>(until - state.cells), vessel.back());
    }
    std::vector<SortedStretch> sorted(static_cast<std::size_t>(pieces));
    for_each_piece(pieces, [&](int n) {
      sorted[static_cast<std::size_t>(n)] =
          sorter.sort(first_of(n), first_of(n + 1), 0, vessel[static_cast<std::size_t>(n * kSorterPiece)]);
    });
    for (const SortedStretch& piece : sorted)
      for (const Tally& cell : piece.cells) state.products.add(cell, c.classes);
    state.cells = until;
    state.vessel.assign(vessel.end() - static_cast<std::ptrdiff_t>(halo) - 1, vessel.end());
    state.lowest_vessel = std::min(state.lowest_vessel, *std::min_element(vessel.begin(), vessel.end()));
    state.wall_time += wall_seconds() - began;
    keep(state);
  }
  return true;
}

}  // namespace ejecta
