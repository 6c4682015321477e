#include "study/map_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "case/load.hpp"
#include "case/outline_file.hpp"
#include "case/symmetry.hpp"
#include "study/map_class.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

/// Steps of the paper's own maps (3.2): across and along.
constexpr double kPaperAcross = 0.5e-3, kPaperAlong = 3e-3;

Json polygon_json(const Polygon& polygon) {
  Json points = Json::array();
  for (const Point2& p : polygon) points.push_back({p.x, p.y});
  return points;
}

Json polygons_json(const std::vector<Polygon>& polygons) {
  Json all = Json::array();
  for (const Polygon& p : polygons) all.push_back(polygon_json(p));
  return all;
}

/// The largest: a map has one outline, unless it has islands or holes, which are listed beside it.
Polygon main_outline(const std::vector<Polygon>& outlines) {
  const auto largest =
      std::max_element(outlines.begin(), outlines.end(),
                       [](const Polygon& a, const Polygon& b) { return signed_area(a) < signed_area(b); });
  return largest == outlines.end() ? Polygon{} : *largest;
}

/// At each 3 mm along, the first and last 0.5 mm across at which the body is ejected.
Json paper_rows(const Outline& outline, const Window& window, bool symmetric) {
  Json rows = Json::array();
  const double y_low = symmetric ? -window.y_high : window.y_low;
  for (auto i = std::lround(std::ceil(window.x_low / kPaperAlong)); double(i) * kPaperAlong <= window.x_high;
       ++i) {
    const double x = double(i) * kPaperAlong;
    double first = NAN, last = NAN;
    for (auto j = std::lround(std::ceil(y_low / kPaperAcross)); double(j) * kPaperAcross <= window.y_high;
         ++j) {
      const double y = double(j) * kPaperAcross;
      if (!is_inside(outline.outline, {x, y})) continue;
      if (std::isnan(first)) first = y;
      last = y;
    }
    if (!std::isnan(first)) rows.push_back({{"x_m", x}, {"y_low_m", first}, {"y_high_m", last}});
  }
  return rows;
}

/// Averaged over the plate's error, evenly distributed, to second order: a change of the area that is even in
/// the error counts by a third of half its second derivative.
double averaged_area(const MapSummary& m) {
  double area = m.outline.area.value;
  for (const MapPlate& plate : m.plates) area += (plate.outline.area.value - m.outline.area.value) / 6.0;
  return area;
}

/// At the nodes of a raster, row by row from the lowest y, with the places of equal chance.
Json chance_json(const RasterValues& chance) {
  const Raster& r = chance.raster;
  Json x = Json::array(), y = Json::array(), rows = Json::array(), contours = Json::array();
  for (int i = 0; i <= r.cells_x; ++i) x.push_back(r.x(i));
  for (int j = 0; j <= r.cells_y; ++j) {
    y.push_back(r.y(r.node(0, j)));
    const auto row = chance.values.begin() + r.node(0, j);
    rows.push_back(std::vector<double>(row, row + r.row()));
  }
  for (const double level : {0.1, 0.5, 0.9}) {
    std::vector<double> above = chance.values;
    for (double& value : above) value -= level;
    contours.push_back({{"chance", level}, {"outlines_m", polygons_json(positive_outlines(r, above))}});
  }
  return {{"x_m", x}, {"y_m", y}, {"chance", rows}, {"contours", contours}};
}

/// What a run of a class was made with.
void add_member(const MapSpec& map, const Point2& at, Json& run) {
  if (!map.is_of_class()) return;
  const ClassMember member = drawn_member(map, at);
  run["size_factor"] = member.size_factor;
  run["turn_wxyz"] = {member.turn.w(), member.turn.x(), member.turn.y(), member.turn.z()};
}

void add_measured(const MapSummary& m, Json& r) {
  if (m.base.map.measured.empty()) return;
  std::vector<Problem> problems;  // told when the case was read
  Polygon outline;
  for (const auto& [x, y] : read_outline_file(beside_case(m.base, m.base.map.measured), problems))
    outline.push_back({x, y});
  const double area = std::abs(signed_area(outline));
  r["measured"] = {{"file", m.base.map.measured},
                   {"area_m2", area},
                   {"area_ratio", area > 0.0 ? r["area_m2"].get<double>() / area : 0.0},
                   {"outline_m", polygon_json(outline)}};
}

}  // namespace

Json map_result(const MapSummary& m) {
  const Outline& o = m.outline;
  Json r;
  r["title"] = m.base.run.title;
  r["kind"] = "map";
  r["state"] = m.state;
  r["area_m2"] = averaged_area(m);
  r["area_error_m2"] = o.area.error;
  r["half_width_across_m"] = o.half_width.value;
  r["half_width_across_error_m"] = o.half_width.error;
  r["length_before_m"] = o.length_before.value;
  r["length_before_error_m"] = o.length_before.error;
  r["length_behind_m"] = o.length_behind.value;
  r["length_behind_error_m"] = o.length_behind.error;
  r["area_of_plate_as_given_m2"] = o.area.value;
  r["widest_gap_m"] = o.widest_gap;
  r["reaches_sides"] = o.reaches_sides;
  r["outline_m"] = polygon_json(main_outline(o.outline));
  r["outlines_m"] = polygons_json(o.outline);
  r["sure_m"] = polygons_json(o.sure);
  r["possible_m"] = polygons_json(o.possible);
  r["paper_resolution"] = paper_rows(o, m.settings.window, m.settings.symmetric);
  r["symmetric"] = m.settings.symmetric;
  const double y_low = m.settings.symmetric ? -m.settings.window.y_high : m.settings.window.y_low;
  r["window_m"] = {{m.settings.window.x_low, m.settings.window.x_high}, {y_low, m.settings.window.y_high}};
  r["footprint_m"] = polygon_json(footprint(m.base));
  r["body"] = m.base.bodies.at(mapped_body(m.base)).name;
  r["jet_half_radius_m"] = m.base.jet.spreading * m.base.launch.stand_off;
  r["plates"] = Json::array();
  for (const MapPlate& plate : m.plates)
    r["plates"].push_back({{"edge_moved_m", {plate.at.x, plate.at.z}},
                           {"area_m2", plate.outline.area.value},
                           {"area_error_m2", plate.outline.area.error},
                           {"outlines_m", polygons_json(plate.outline.outline)}});
  if (m.chance) r["chance"] = chance_json(*m.chance);
  add_measured(m, r);
  const auto count = [&](Fidelity f) {
    return std::count_if(m.runs.begin(), m.runs.end(),
                         [&](const MapPoint& run) { return run.fidelity == f && run.flight; });
  };
  r["runs_fine"] = count(Fidelity::fine);
  r["runs_coarse"] = count(Fidelity::coarse);
  r["runs"] = Json::array();
  double seconds = 0.0;
  for (const MapPoint& run : m.runs) {
    Json j{{"x_m", run.at.x},
           {"y_m", run.at.y},
           {"refinement", run.fidelity == Fidelity::coarse ? m.base.map.coarse_refinement : 1.0},
           {"clearance_m", run.flight ? Json(run.flight->clearance()) : Json(nullptr)},
           {"outcome",
            run.flight ? (run.flight->clearance() > 0.0 ? "ejected" : "not ejected") : word(run.state)},
           {"directory", run.directory},
           {"fine", run.fidelity == Fidelity::fine},
           {"wall_time_s", run.wall_time}};
    if (!run.reason.empty()) j["reason"] = run.reason;
    add_member(m.base.map, run.at, j);
    r["runs"].push_back(std::move(j));
    seconds += run.wall_time;
  }
  r["contradictions"] = Json::array();
  for (const Contradiction& c : m.contradictions)
    r["contradictions"].push_back({{"x_m", c.run.at.x},
                                   {"y_m", c.run.at.y},
                                   {"clearance_m", c.run.margin},
                                   {"fine", c.run.fidelity == Fidelity::fine},
                                   {"chance", c.chance}});
  if (m.mirror)
    r["mirror_check"] = {{"x_m", m.mirror->at.x},
                         {"y_m", m.mirror->at.y},
                         {"clearance_m", m.mirror->clearance},
                         {"clearance_mirrored_m", m.mirror->mirrored},
                         {"contradicts", m.mirror->contradicts()}};
  r["history"] = Json::array();
  for (const MapHistory& h : m.history)
    r["history"].push_back({{"runs", h.runs}, {"area_m2", h.area.value}, {"area_error_m2", h.area.error}});
  r["summary"] = map_sentence(r);
  r["runs_wall_time_s"] = seconds;
  r["wall_time_s"] = m.wall_time;
  return r;
}

std::string map_sentence(const Json& r) {
  const double area = 1e6 * r["area_m2"].get<double>(), error = 1e6 * r["area_error_m2"].get<double>();
  const int fine = r["runs_fine"], coarse = r["runs_coarse"];
  std::string text;
  if (r.contains("chance"))
    text = fmt::format(
        "{} is ejected from {:.0f} ± {:.0f} mm² around the jet, its chance of ejection integrated",
        r["body"].get<std::string>(), area, error);
  else if (area <= 0.0)
    text = fmt::format("{} is ejected from nowhere in the window", r["body"].get<std::string>());
  else
    text = fmt::format(
        "{} is ejected from {:.0f} ± {:.0f} mm² around the jet: {:.1f} mm to either side, {:.1f} mm before "
        "and {:.1f} mm behind it",
        r["body"].get<std::string>(), area, error, 1e3 * r["half_width_across_m"].get<double>(),
        1e3 * r["length_before_m"].get<double>(), 1e3 * r["length_behind_m"].get<double>());
  text += coarse > 0 ? fmt::format(" ({} fine and {} coarse runs)", fine, coarse)
                     : fmt::format(" ({} runs)", fine);
  if (r["reaches_sides"].get<bool>()) text += "; it goes on beyond the window";
  if (const std::size_t n = r["contradictions"].size(); n > 0)
    text += fmt::format("; {} run{} contradict{} it", n, n == 1 ? "" : "s", n == 1 ? "s" : "");
  if (r.contains("mirror_check") && r["mirror_check"]["contradicts"])
    text += "; its mirror image is not what the case claims";
  return text + ".";
}

}  // namespace ejecta
