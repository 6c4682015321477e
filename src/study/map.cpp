#include "study/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "case/problem.hpp"
#include "case/symmetry.hpp"
#include "output/output_file.hpp"
#include "study/map_case.hpp"
#include "study/map_method.hpp"
#include "study/map_result.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

MapSettings settings_of(const Case& c) {
  const MapSpec& m = c.map;
  MapSettings s;
  s.window = {m.along[0], m.along[1], m.across[0], m.across[1]};
  s.symmetric = map_is_symmetric(c);
  if (s.symmetric) s.window.y_high = std::max(m.across[1], -m.across[0]);
  s.step_x = m.grid[0];
  s.step_y = m.grid[1];
  s.coarse_cost = m.is_on_grid() ? 0.0 : coarse_cost(c);
  s.first_runs = std::min(s.first_runs, m.max_runs);
  s.max_runs = m.max_runs;
  s.max_fine = std::min(m.max_fine_runs, m.max_runs);
  s.area_error = m.area_error;
  s.seed = static_cast<std::uint64_t>(m.seed);
  s.of_class = m.is_of_class();
  return s;
}

class MapMaker {
 public:
  MapMaker(const Case& base, TaskStore& store, const MapWorkers& workers)
      : base_(base),
        store_(store),
        workers_(workers),
        settings_(settings_of(base)),
        method_(make_map_method(settings_)) {}

  MapEnd make() {
    refuse_what_cannot_run();
    start_ = wall_seconds();
    spent_before_ = time_spent();
    for (;;) {
      const std::vector<Proposal> asked = method_->ask(base_.map.runs_at_once);
      if (asked.empty()) return conclude(MapEnd::runs_used_up);
      std::vector<NewTask> tasks;
      for (const Proposal& p : asked) tasks.push_back({map_run_case(base_, p), labels_of(p)});
      const std::vector<std::size_t> places = store_.add(tasks);
      const bool finished = workers_.run(store_, places);
      for (std::size_t n = 0; n < asked.size(); ++n) take(asked[n], places[n]);
      if (!finished) return MapEnd::stopped;
      if (std::none_of(runs_.begin(), runs_.end(), [](const MapPoint& r) { return r.flight.has_value(); }))
        throw Error(fmt::format("none of the first {} runs of the map came to an end: {}", runs_.size(),
                                runs_.front().reason));
      const Outline outline = method_->outline();
      if (method_->is_finished(outline)) return conclude(MapEnd::finished);
      show(outline, {}, "running");
    }
  }

 private:
  /// By earlier calls on the same map, s.
  double time_spent() const {
    std::error_code none;
    const std::filesystem::path path = store_.path() / "result.json";
    if (!std::filesystem::exists(path, none)) return 0.0;
    const Json r = Json::parse(output::read_file(path), nullptr, false);
    return r.is_object() ? r.value("wall_time_s", 0.0) : 0.0;
  }

  Json labels_of(const Proposal& p) const {
    return {{"x_m", p.at.x},
            {"y_m", p.at.y},
            {"refinement", p.fidelity == Fidelity::coarse ? base_.map.coarse_refinement : 1.0}};
  }

  /// The middle of the window, its ends along and its corners, in both fidelities: what holds in the middle
  /// and not there is a fault of the window.
  void refuse_what_cannot_run() const {
    if (!workers_.further) return;
    const Window& w = settings_.window;
    const double low = settings_.symmetric ? 0.0 : w.y_low, middle = 0.5 * (w.x_low + w.x_high);
    const struct {
      const char* key;
      Point2 at;
    } places[]{{"", {middle, low}},
               {"map.along", {w.x_low, low}},
               {"map.along", {w.x_high, low}},
               {"map.across", {w.x_low, w.y_high}},
               {"map.across", {w.x_high, w.y_high}}};
    std::set<std::string> told;
    std::vector<Problem> all;
    for (const Fidelity fidelity : {Fidelity::fine, Fidelity::coarse}) {
      if (fidelity == Fidelity::coarse && settings_.coarse_cost == 0.0) continue;
      for (const auto& [key, at] : places)
        for (Problem p : workers_.further(map_run_case(base_, {at, fidelity}))) {
          if (p.severity != Severity::error || !told.insert(p.what).second) continue;
          p.what = fmt::format("the {} run of the map at x = {:.4g} mm, y = {:.4g} mm: {}{}",
                               fidelity == Fidelity::fine ? "fine" : "coarse", 1e3 * at.x, 1e3 * at.y,
                               *key ? p.key + ": " : "", p.what);
          if (*key) p.key = key;
          if (fidelity == Fidelity::coarse && !*key) p.key = "map.coarse_refinement";
          if (workers_.place) p.place = workers_.place(p.key);
          all.push_back(std::move(p));
        }
    }
    if (!all.empty()) throw CaseError(std::move(all));
  }

  void take(const Proposal& p, std::size_t task) {
    MapPoint run{.at = p.at,
                 .fidelity = p.fidelity,
                 .task = task,
                 .state = store_.state(task),
                 .flight = {},
                 .reason = {},
                 .directory = "runs/" + store_.tasks()[task].hash,
                 .wall_time = 0.0};
    if (run.state == TaskState::done) {
      const Json done = store_.result(task);
      run.flight = map_flight(base_, done.at("result"));
      run.wall_time = done.value("wall_time_s", 0.0);
      method_->tell({p.at, run.flight->clearance(), p.fidelity});
    } else if (run.state != TaskState::waiting && run.state != TaskState::running) {
      run.reason = store_.failure(task);
      if (workers_.note)
        workers_.note(fmt::format("the run at x = {:.1f} mm, y = {:.1f} mm {}: {}", 1e3 * p.at.x,
                                  1e3 * p.at.y, word(run.state), run.reason));
    }
    runs_.push_back(std::move(run));
  }

  /// Of a symmetry that the case claims and does not show: the run nearest to the edge once more, on the
  /// other side. Nothing where it was stopped.
  std::optional<MirrorCheck> check_mirror() {
    const MapPoint* nearest = nullptr;
    const auto rank = [](const MapPoint& r) {  // coarse ones cost less
      return std::pair(r.fidelity == Fidelity::fine, std::abs(r.flight->clearance()));
    };
    for (const MapPoint& run : runs_)
      if (run.flight && run.at.y > 0.0 && (!nearest || rank(run) < rank(*nearest))) nearest = &run;
    if (!nearest) return std::nullopt;
    const Proposal mirror{{nearest->at.x, -nearest->at.y}, nearest->fidelity};
    const std::vector<std::size_t> task = store_.add({{map_run_case(base_, mirror), labels_of(mirror)}});
    if (!workers_.run(store_, task) || store_.state(task.front()) != TaskState::done) return std::nullopt;
    const MapFlight flight = map_flight(base_, store_.result(task.front()).at("result"));
    return MirrorCheck{nearest->at, nearest->flight->clearance(), flight.clearance()};
  }

  /// The same runs against a plate that stands elsewhere.
  Outline outline_for(const PlatePlace& plate) const {
    const std::unique_ptr<MapMethod> other = make_map_method(settings_);
    for (const MapPoint& run : runs_)
      if (run.flight) other->tell({run.at, run.flight->clearance(plate), run.fidelity});
    return other->outline();
  }

  MapEnd conclude(MapEnd end) {
    std::vector<MapPlate> plates;
    const auto [dx, dz] = base_.map.plate_error;
    for (const PlatePlace& plate :
         {PlatePlace{-dx, 0.0}, PlatePlace{dx, 0.0}, PlatePlace{0.0, -dz}, PlatePlace{0.0, dz}})
      if (plate.x != 0.0 || plate.z != 0.0) plates.push_back({plate, outline_for(plate)});
    if (settings_.symmetric && !settings_.of_class && !symmetry_across(base_, mapped_body(base_)).sure)
      mirror_ = check_mirror();
    if (base_.map.is_of_chance()) chance_ = method_->chance_map(base_.map.arrival_error);
    show(method_->outline(), plates, end == MapEnd::finished ? "finished" : "runs used up");
    const bool sound = method_->contradictions().empty() && !(mirror_ && mirror_->contradicts());
    return sound ? end : MapEnd::contradicted;
  }

  void show(const Outline& outline, const std::vector<MapPlate>& plates, const char* state) {
    history_.push_back({static_cast<int>(runs_.size()), outline.area});
    const Json result = map_result({.base = base_,
                                    .settings = settings_,
                                    .state = state,
                                    .outline = outline,
                                    .plates = plates,
                                    .runs = runs_,
                                    .history = history_,
                                    .contradictions = method_->contradictions(),
                                    .mirror = mirror_,
                                    .chance = chance_,
                                    .wall_time = spent_before_ + wall_seconds() - start_});
    store_.write_json("result.json", result);
    if (workers_.show) workers_.show(result);
  }

  const Case& base_;
  TaskStore& store_;
  const MapWorkers& workers_;
  MapSettings settings_;
  std::unique_ptr<MapMethod> method_;
  std::vector<MapPoint> runs_;
  std::vector<MapHistory> history_;
  std::optional<MirrorCheck> mirror_;
  std::optional<RasterValues> chance_;
  double start_ = 0.0, spent_before_ = 0.0;  // s
};

}  // namespace

MapEnd make_map(const Case& base, TaskStore& store, const MapWorkers& workers) {
  return MapMaker(base, store, workers).make();
}

}  // namespace ejecta
