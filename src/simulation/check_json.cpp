#include <nlohmann/json.hpp>

#include "case/copies.hpp"
#include "case/extent.hpp"
#include "case/words.hpp"
#include "flow/model/flow_model.hpp"
#include "jet/source.hpp"
#include "simulation/assumptions.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "simulation/sorter_run.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json list(const Span& s) { return {s.from, s.to}; }

Json body_json(const Case& c, const Company& company, const Grid* grid, std::size_t n,
               const Splitter* plate) {
  const BodySpec& spec = c.bodies[n];
  const Body& body = company.bodies[n];
  Json j{{"name", spec.name},
         {"shape", word(spec.shape)},
         {"motion", word(spec.motion)},
         {"size_m", list(body_size(body))},
         {"volume_m3", body.shape.mass_properties().volume},
         {"mass_kg", body.mass}};
  const bool jet = grid && has_jet(c);
  if (grid) {
    const Resolution r =
        resolution_of(*grid, body, spec.on_belt ? place_of_interest(c, spec) : body.position);
    j["cells_across"] = r.cells;
    j["smallest_feature_m"] = r.width.size;
  }
  if (body.motion == Motion::fixed || !(spec.on_belt || plate || jet)) return j;
  const Prospect p = prospect_of(c, company, n, plate);
  if (p.in_box) j["in_box_s"] = list(*p.in_box);
  if (jet && p.over_jet) j["over_jet_s"] = list(*p.over_jet);
  if (jet && !p.over_jet && p.beside < 1e300) j["beside_jet_m"] = p.beside;
  if (p.at_plate) {
    j["at_plate_s"] = *p.at_plate;
    j["above_edge_m"] = p.above_edge;
  }
  return j;
}

}  // namespace

Json problem_json(const Problem& p) {
  Json j{{"severity", p.severity == Severity::error ? "error" : "warning"}, {"key", p.key}, {"what", p.what}};
  for (const auto& [name, text] :
       {std::pair{"expected", p.expected}, {"nearest", p.nearest}, {"example", p.example}})
    if (!text.empty()) j[name] = text;
  if (p.place.source) {
    j["file"] = p.place.source->name;
    j["line"] = p.place.line_number();
    j["column"] = p.place.column() + 1;
  }
  return j;
}

Json problems_json(const std::vector<Problem>& list) {
  Json all = Json::array();
  for (const Problem& p : list) all.push_back(problem_json(p));
  return all;
}

Json check_json(const Case& c, const Scene& scene, const std::vector<Problem>& warnings, double bandwidth) {
  Json j{{"case", c.path}, {"title", c.run.title}, {"solver", word(c.flow.solver)}};
  const Company company = company_of(scene);
  std::optional<Grid> grid;
  if (c.sorter.enabled) {
    const SorterForecast f = sorter_forecast(c);
    j["sorter"] = {{"particles", f.particles},
                   {"belt_m", f.belt},
                   {"time_s", f.time},
                   {"fed_kg", f.mass},
                   {"cover", f.cover}};
  } else if (c.flow.solver != FlowSolver::none) {
    grid.emplace(make_grid(c));
    const Forecast f = forecast(c, company);
    j["turbulence"] = word(c.flow.turbulence);
    j["cells"] = f.cells;
    j["smallest_cell_m"] = f.smallest_cell;
    if (f.knows_step) {
      j["flow_steps"] = f.steps;
      j["time_step_s"] = f.time_step;
      j["flow_until_s"] = f.air_until;
      j["expected_wall_time_s"] =
          expected_seconds(c, f, bandwidth, scene.particles.bodies().subspan(scene.bodies));
    }
    j["memory_bytes"] = f.memory;
    j["disk_bytes"] = f.disk;
  }
  const Case all = with_first_copies(c);
  const Splitter* plate = scene.splitter ? &*scene.splitter : nullptr;
  j["bodies"] = Json::array();
  for (std::size_t n = 0; n < all.bodies.size(); ++n)
    j["bodies"].push_back(body_json(all, company, grid ? &*grid : nullptr, n, plate));
  if (grid && has_jet(c)) {
    const ValveProspect v = prospect_of_valve(c);
    j["valve"] = {{"supply_gauge_Pa", c.valve.supply_pressure - c.environment.pressure},
                  {"open_s", list(v.open)},
                  {"widest", v.widest},
                  {"widest_s", list(v.widest_at)}};
  }
  if (plate) {
    const Vec3 edge = plate->edge() - c.jet.nozzle;
    j["plate"] = {{"edge_from_nozzle_m", {edge.x(), edge.z()}}};
  }
  j["assumptions"] = Json::array();
  for (const output::Assumption& a : assumptions(c))
    j["assumptions"].push_back({{"key", a.key}, {"value", a.value}, {"what", a.what}, {"reason", a.reason}});
  j["problems"] = problems_json(warnings);
  return j;
}

}  // namespace ejecta
