#include "simulation/drawing.hpp"

#include <nlohmann/json.hpp>

#include "case/copies.hpp"
#include "jet/source.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/prospect.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json in_plane(const Vec3& v) { return {v.x(), v.z()}; }

/// Until it has passed the plate, else until the run ends.
Json path_of(const Case& c, const FlightState& start, const Splitter* plate) {
  double until = c.run.end_time;
  if (plate && start.velocity.x() > 0.0)
    until = 1.1 * (plate->edge().x() - start.position.x()) / start.velocity.x();
  constexpr int kPoints = 40;
  Json points = Json::array();
  for (int n = 0; n <= kPoints; ++n)
    points.push_back(in_plane(free_flight(start, c.environment.gravity, until * n / kPoints)));
  return points;
}

}  // namespace

Json drawing_of(const Case& c, const Scene& scene) {
  const Company company = company_of(scene);
  const Splitter* plate = scene.splitter ? &*scene.splitter : nullptr;
  Json j{{"bodies", Json::array()}};
  const bool flow = c.flow.solver != FlowSolver::none;
  const auto& x = c.grid.axis[0].points;
  const auto& z = c.grid.axis[2].points;
  if (flow && !x.empty() && !z.empty()) j["box"] = {{x.front(), z.front()}, {x.back(), z.back()}};
  if (flow && has_jet(c)) j["nozzle"] = in_plane(c.jet.nozzle);
  if (plate) j["plate"] = in_plane(plate->edge());
  const Case all = with_first_copies(c);
  for (std::size_t n = 0; n < company.bodies.size(); ++n) {
    const Body& body = company.bodies[n];
    const Reach reach = reach_of(body);
    Json b{{"name", body.name}, {"low", in_plane(reach.low)}, {"high", in_plane(reach.high)}};
    b["path"] =
        body.motion == Motion::fixed ? Json{in_plane(body.position)} : path_of(all, company.starts[n], plate);
    j["bodies"].push_back(std::move(b));
  }
  return j;
}

}  // namespace ejecta
