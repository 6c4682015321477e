#include <fmt/format.h>

#include <cmath>

#include "base/parallel.hpp"
#include "case/expression.hpp"
#include "jet/round_jet.hpp"
#include "simulation/assumptions.hpp"
#include "simulation/coupled_model.hpp"
#include "simulation/spacing.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) { return Json{v.x(), v.y(), v.z()}; }

Json body_json(const CoupledModel& m, std::size_t b) {
  const Case& c = m.config();
  const Body& body = m.particles().bodies()[b];
  Json j;
  j["name"] = body.name;
  j["mass_kg"] = body.mass;
  if (!c.bodies[b].file.empty() || !c.bodies[b].files.empty()) {
    j["parts"] = body.shape.balls().size() + body.shape.polytopes().size();
    if (body.shape.balls().empty())
      j["volume_of_parts_over_solid"] = body.shape.parts_volume() / body.shape.mass_properties().volume;
  }
  const Presence presence = m.particles().presence(static_cast<int>(b));
  if (presence != Presence::here)
    j["presence"] = presence == Presence::gone ? "left the domain" : "never came in";
  j["final_position_m"] = vector_json(body.position);
  j["final_velocity_m_s"] = vector_json(body.velocity);
  j["final_spin_rad_s"] = vector_json(body.angular_velocity);
  j["final_spin_body_rad_s"] = vector_json(body.orientation.conjugate() * body.angular_velocity);
  const ContactPeaks& peaks = m.particles().peaks(static_cast<int>(b));
  j["max_overlap_m"] = peaks.overlap;
  j["max_contact_force_N"] = peaks.force;
  j["contact_time_s"] = peaks.time;
  j["peak_speed_m_s"] = m.peak_speed(b);
  const Vec3& impulse = m.impulse()[b];
  // What the air did: gravity and contacts are not part of it.
  j["velocity_change_z_m_s"] = impulse.z() / body.mass;
  j["impulse_x_N_s"] = impulse.x();
  j["impulse_y_N_s"] = impulse.y();
  j["impulse_z_N_s"] = impulse.z();
  j["mean_force_N"] = vector_json(m.mean_force(b));
  j["mean_friction_N"] = vector_json(m.mean_friction(b));
  j["mean_torque_N_m"] = vector_json(m.mean_torque(b));
  if (m.flow() && c.stream.enabled && c.stream.velocity.norm() > 0.0) {
    const Vec3 direction = c.stream.velocity.normalized();
    const double area = c.stream.reference_area > 0.0
                            ? c.stream.reference_area
                            : body.shape.projected_area(body.orientation.conjugate() * direction);
    const double q = 0.5 * m.flow()->density() * c.stream.velocity.squaredNorm() * area;
    // Of the stream: the weight of the displaced fluid, which bears the body in a fluid at rest too, is none.
    const double displaced = m.flow()->density() * body.shape.mass_properties().volume;
    const Vec3 force = m.mean_force(b) + displaced * c.environment.gravity;
    const double drag = force.dot(direction);
    j["drag_coefficient"] = drag / q;
    // Against a drag of nothing there is no ratio; the file then has no such number.
    if (drag != 0.0) {
      j["lift_over_drag"] = (force - drag * direction).norm() / std::abs(drag);
      j["torque_over_drag_length"] =
          m.mean_torque(b).norm() / (std::abs(drag) * 2.0 * body.shape.bounding_radius());
    }
  }
  if (m.splitter() && m.splitter()->judges(b)) {
    if (const auto& v = m.splitter()->verdict(b)) {
      j["outcome"] = v->ejected ? "ejected" : "not ejected";
      j["clearance_at_splitter_m"] = v->clearance;
      j["velocity_margin_z_m_s"] = v->velocity_margin;
      j["time_at_splitter_s"] = v->time;
      if (v->thrown_back) j["thrown_back_by_plate"] = true;
    } else {
      j["outcome"] = "undecided";
    }
    if (const auto clearance = m.splitter()->flight_clearance(b)) j["flight_clearance_m"] = *clearance;
    if (const auto wanted = c.bodies[b].wanted) {
      j["wanted"] = *wanted;
      const bool ejected = j["outcome"] == "ejected";
      j["judgement"] = j["outcome"] == "undecided" ? "undecided"
                       : ejected == *wanted        ? "right"
                       : ejected                   ? "by-catch"
                                                   : "missed";
    }
  }
  return j;
}

/// Volume-weighted L2 and largest errors against [exact].
void add_errors(const CoupledModel& m, double time, Json& result) {
  const ExactSpec& exact = m.config().exact;
  if (!exact.velocity && !exact.pressure && !exact.k) return;
  const Grid& g = m.grid();
  const auto norms = [&](const std::string& name, const auto& difference) {
    double sum = 0.0, volume = 0.0, largest = 0.0;
    for (int k = 0; k < g.nz(); ++k)
      for (int j = 0; j < g.ny(); ++j)
        for (int i = 0; i < g.nx(); ++i) {
          const double e = difference(i, j, k), v = g.volume(i, j, k);
          sum += v * e * e;
          volume += v;
          largest = std::max(largest, std::abs(e));
        }
    result["errors"][name + "_l2"] = std::sqrt(sum / volume);
    result["errors"][name + "_max"] = largest;
  };
  const auto u = m.flow()->seen().velocity;
  if (exact.velocity)
    for (int d = 0; d < 3; ++d) {
      if (!g.active(d)) continue;
      const Expression f((*exact.velocity)[static_cast<std::size_t>(d)]);
      norms(std::string("velocity_") + "xyz"[d], [&](int i, int j, int k) {
        const Vec3 x = g.centre(i, j, k);
        return double(u[static_cast<std::size_t>(d)](i, j, k)) - f(x.x(), x.y(), x.z(), time);
      });
    }
  for (const CellField& field : exact.k ? m.flow()->fields() : std::vector<CellField>{})
    if (field.name == "k") {
      const Expression f(*exact.k);
      norms("k", [&, k_field = field.component[0]](int i, int j, int k) {
        const Vec3 x = g.centre(i, j, k);
        return double(k_field(i, j, k)) - f(x.x(), x.y(), x.z(), time);
      });
    }
  if (!exact.pressure || m.config().flow.solver != FlowSolver::incompressible) return;
  // Pressure is known up to a constant: compare after removing both means.
  const Expression f(*exact.pressure);
  const auto fields = m.flow()->fields();
  const ConstFieldView p = field_named(fields, "pressure").component[0];
  const double rho = m.flow()->density();
  double mean = 0.0, volume = 0.0;
  const auto raw = [&](int i, int j, int k) {
    const Vec3 x = g.centre(i, j, k);
    return rho * double(p(i, j, k)) - f(x.x(), x.y(), x.z(), time);
  };
  for (int k = 0; k < g.nz(); ++k)
    for (int j = 0; j < g.ny(); ++j)
      for (int i = 0; i < g.nx(); ++i) mean += g.volume(i, j, k) * raw(i, j, k), volume += g.volume(i, j, k);
  mean /= volume;
  norms("pressure", [&](int i, int j, int k) { return raw(i, j, k) - mean; });
}

/// Decay and spreading of a jet along the axis of an axisymmetric incompressible flow.
void add_round_jet(const CoupledModel& m, double time, Json& result) {
  const Case& c = m.config();
  if (c.flow.solver != FlowSolver::incompressible || !m.inflow().at || !m.grid().axisymmetric()) return;
  const auto fields = m.flow()->fields();
  const auto field = [&](const char* name) {
    for (const CellField& f : fields)
      if (f.name == name) return f.component[0];
    return ConstFieldView{};
  };
  const double d = c.valve.orifice_diameter, z0 = c.jet.nozzle.z();
  if (const auto jet = analyse_round_jet(m.grid(), m.flow()->seen().velocity[2], field("pressure"),
                                         field("eddy_viscosity"), c.fluid.viscosity / c.fluid.density, d,
                                         m.inflow().fastest(time), z0 + 30.0 * d,
                                         z0 + 0.8 * (m.grid().axis(2).face.back() - z0)))
    result["round_jet"] = {{"decay", jet->far.decay},
                           {"spreading", jet->far.spreading},
                           {"decay_times_spreading", jet->far.decay * jet->far.spreading},
                           {"momentum_variation", jet->momentum_variation}};
}

/// Grains: how many, where, how fast; what they met; how well sums were kept.
void add_grain_figures(const CoupledModel& m, Json& result) {
  if (!m.any_grains()) return;
  const Case& c = m.config();
  Json& out = result["grains"];
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const GrainSums s = grain_sums(m.particles(), m.first_grain(), c.grains[n].name);
    Json group{{"name", c.grains[n].name},
               {"count", s.count},
               {"mass_kg", s.mass},
               {"mean_position_m", vector_json(s.centre)},
               {"mean_velocity_m_s", vector_json(s.velocity)},
               {"height_m", s.height},
               {"kinetic_energy_J", s.kinetic_energy}};
    if (m.splitter()) {
      const auto [above, below] = m.sorted_grains()[n];
      group["passed_above_plate"] = above;
      group["passed_below_plate"] = below;
      if (above + below > 0) group["part_above_plate"] = double(above) / (above + below);
    }
    out["groups"].push_back(group);
  }
  const GrainsInFlow* grains = m.grains();
  if (!grains) return;
  const PressureDrop drop = m.drop();
  out["pressure_drop_z_Pa"] = drop.pressure;
  out["mean_pressure_drop_z_Pa"] = m.mean_drop();
  if (const auto height = m.mean_bed_height()) out["mean_height_of_centre_m"] = *height;
  out["pressure_gradient_z_Pa_m"] = drop.distance > 0.0 ? drop.pressure / drop.distance : 0.0;
  out["largest_reynolds"] = grains->largest_reynolds();
  out["least_void_fraction"] = grains->least_fraction();
  Vec3 momentum(0, 0, 0), drag(0, 0, 0);
  double volume = 0.0;
  const auto bodies = m.particles().bodies();
  for (std::size_t g = m.first_grain(); g < bodies.size(); ++g) {
    if (m.particles().presence(static_cast<int>(g)) != Presence::here) continue;
    momentum += bodies[g].mass * bodies[g].velocity;
    volume += bodies[g].shape.mass_properties().volume;
    if (const auto& drags = grains->coupling().drag_forces(); g - m.first_grain() < drags.size())
      drag += drags[g - m.first_grain()];
  }
  out["momentum_N_s"] = vector_json(momentum);
  out["drag_N"] = vector_json(drag);
  out["volume_m3"] = volume;
  out["mapped_volume_m3"] = grains->coupling().mapped_volume(grains->fraction());
}

}  // namespace

Json CoupledModel::result(double time, std::int64_t steps, double wall_time,
                          std::span<const OperatorTime> operators) const {
  const CoupledModel& m = *this;
  const Case& c = m.config();
  Json r;
  r["title"] = c.run.title;
  Json bodies = Json::array();
  for (std::size_t b = 0; b < m.lumps().size(); ++b) bodies.push_back(body_json(m, b));
  if (m.splitter()) {
    for (const Json& body : bodies)
      if (body.contains("outcome") && !r.contains("outcome")) r["outcome"] = body["outcome"];
    const Vec3 edge = m.splitter()->edge() - c.jet.nozzle;
    r["plate"] = {{"edge_from_nozzle_m", {edge.x(), edge.z()}},
                  {"given_as", c.splitter.edge ? "fixed to the machine" : "above the undisturbed path"}};
    if (!c.splitter.edge) r["plate"]["height_above_path_m"] = c.splitter.height;
  }
  if (!bodies.empty()) r["bodies"] = bodies;
  if (const auto warnings = m.warnings(); !warnings.empty()) r["warnings"] = warnings;
  add_grain_figures(m, r);
  r["cells"] = m.flow() ? m.grid().cells() : 0;
  r["steps"] = steps;
  r["flow_steps"] = m.flow_steps();
  r["simulated_time_s"] = time;
  r["wall_time_s"] = wall_time;
  r["threads"] = thread_count();
  r["cell_steps_per_s"] =
      m.flow() && wall_time > 0.0 ? double(m.grid().cells()) * double(m.flow_steps()) / wall_time : 0.0;
  r["max_courant"] = m.max_courant();
  r["ledger"] = Json::object();
  if (m.flow()) {
    for (const Figure& f : m.flow()->report()) {
      Json& place = f.group.empty() ? r[f.name] : r[f.group][f.name];
      if (f.value.size() == 1) place = f.value[0];
      else place = f.value;
    }
    add_round_jet(m, time, r);
    r["air_momentum_N_s"] = vector_json(m.flow()->momentum());
    r["air_kinetic_energy_J"] = m.flow()->kinetic_energy();
  }
  if (!m.particles().bodies().empty()) {
    const DemEnergy e = m.particles().energy();
    const double scale = std::max({std::abs(e.kinetic), std::abs(e.work), std::abs(e.dissipated), 1e-30});
    r["ledger"]["bodies_energy_J"] = e.ledger();
    r["ledger"]["bodies_energy_scale_J"] = scale;
    r["ledger"]["dissipated_J"] = e.dissipated;
    if (e.dissipated > 0.0) r["ledger"]["kinetic_over_dissipated"] = e.kinetic / e.dissipated;
  }
  if (!m.any_grains()) add_spacing(m.particles(), r);
  add_errors(m, time, r);
  if (!operators.empty()) r["operators"] = operators_json(operators);
  for (const auto& i : inputs(c))
    r["inputs"].push_back({{"what", i.what}, {"value", i.value}, {"key", i.key}});
  for (const auto& a : assumptions(c))
    r["assumptions"].push_back({{"what", a.what}, {"value", a.value}, {"reason", a.reason}, {"key", a.key}});
  return r;
}

}  // namespace ejecta
