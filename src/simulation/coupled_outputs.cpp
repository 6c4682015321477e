#include "simulation/coupled_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/state_reader.hpp"
#include "output/vtk_grains.hpp"
#include "simulation/replay_header.hpp"
#include "simulation/spacing.hpp"

namespace ejecta {
namespace {

using output::Column;

std::vector<Column> body_columns() {
  std::vector<Column> c;
  const auto add = [&](const char* name, const char* unit) {
    for (const char* axis : {"_x", "_y", "_z"}) c.push_back({std::string(name) + axis, unit});
  };
  for (const char* axis : {"x", "y", "z"}) c.push_back({axis, "m"});
  add("velocity", "m/s");
  add("spin", "rad/s");
  add("force", "N");
  add("friction", "N");  // its part in the force
  add("torque", "N m");
  add("contact_force", "N");
  return c;
}

std::vector<Vec3> points_of(const LineSpec& line) {
  std::vector<Vec3> points;
  for (int n = 0; n < line.points; ++n)
    points.push_back(line.from + double(n) / (line.points - 1) * (line.to - line.from));
  return points;
}

constexpr double kNever = -1.0;

double or_never(double interval) { return interval > 0.0 ? interval : kNever; }

double replay_interval(const Case& c) {
  if (!c.output.report) return kNever;
  constexpr double kFrames = 200.0;
  return c.output.slices_interval > 0.0 ? c.output.slices_interval : c.run.end_time / kFrames;
}

output::PvdSeries open_series(const OutputPlace& place, const std::string& name) {
  return place.resumed ? output::PvdSeries(place.directory->fields(), name, *place.resumed)
                       : output::PvdSeries(place.directory->fields(), name);
}

/// More bodies have no history each: a process may not hold so many files open.
constexpr std::size_t kHistories = 200;

}  // namespace

CoupledOutputs::CoupledOutputs(const Case& c, const CoupledModel& model, const OutputPlace& place,
                               bool keep_histories)
    : case_(c),
      model_(model),
      place_(place),
      keep_histories_(place.directory || keep_histories),
      histories_(place),
      histories_due_(c.output.history_interval),
      fields_(or_never(c.output.fields_interval)),
      slices_due_(or_never(c.output.slices_interval)),
      replay_due_(replay_interval(c)) {
  open_histories();
  if (!place.directory) return;
  header_ = replay_header(c, model);
  open_fields();
  if (c.output.report) open_replay();
}

void CoupledOutputs::open_histories() {
  const auto open = [&](const std::string& name, std::vector<Column> columns) {
    return keep_histories_ ? &histories_.open(name, std::move(columns)) : nullptr;
  };
  if (keep_histories_ && model_.lumps().size() <= kHistories)
    for (const Body& b : model_.lumps()) bodies_.push_back(open("body-" + b.name, body_columns()));
  if (keep_histories_ && model_.any_grains())
    grains_ = open("grains", grain_columns(model_.flow() != nullptr));
  if (!model_.flow()) {
    energy_ =
        open("ledger",
             {{"kinetic", "J"}, {"potential", "J"}, {"elastic", "J"}, {"dissipated", "J"}, {"work", "J"}});
    return;
  }
  const auto quantities = model_.flow()->quantities();
  for (const ProbeSpec& spec : case_.probes)
    probes_.emplace_back(spec, quantities, open("probe-" + spec.name, Probe::columns(quantities)));
  if (!keep_histories_ || case_.output.slices_interval <= 0.0) return;
  std::vector<Column> columns{{"position", "m"}};
  for (const auto& [name, unit] : quantities) columns.push_back({name, unit});
  for (const LineSpec& spec : case_.lines) {
    Line line{points_of(spec), {}, open("line-" + spec.name, columns)};
    for (const Vec3& x : line.points) line.position.push_back((x - spec.from).norm());
    lines_.push_back(std::move(line));
  }
}

void CoupledOutputs::open_fields() {
  if (case_.output.fields_interval > 0.0) {
    if (model_.flow()) {
      air_ = open_series(place_, "air");
      writer_.emplace(model_.grid());
    }
    if (model_.any_grains()) grains_series_ = open_series(place_, "grains");
    if (!model_.lumps().empty()) {
      bodies_series_ = open_series(place_, "bodies");
      bodies_writer_.emplace(header_.bodies);
    }
  }
  if (model_.flow() && case_.output.slices_interval > 0.0)
    for (const SliceSpec& s : case_.slices) {
      slices_.push_back(open_series(place_, "slice-" + s.name));
      if (!writer_) writer_.emplace(model_.grid());
    }
}

void CoupledOutputs::open_replay() {
  const auto path = place_.directory->replay();
  replay_ = place_.resumed && std::filesystem::exists(path)
                ? std::make_unique<output::ReplayFile>(path, *place_.resumed)
                : std::make_unique<output::ReplayFile>(path, header_);
  for (const auto& raster : header_.rasters) samplers_.emplace_back(model_.grid(), raster);
}

void CoupledOutputs::add_events(Clock& clock) const {
  clock.add_events_every(case_.output.fields_interval, 0.0, case_.run.end_time);
  clock.add_events_every(case_.output.slices_interval, 0.0, case_.run.end_time);
}

void CoupledOutputs::observe(double time, std::int64_t) {
  update_probes(time);
  if (histories_due_.due(time)) write_histories(time);
  if (fields_.due(time)) write_fields(time);
  if (model_.air() && slices_due_.due(time)) write_slices(time);
  if (replay_ && replay_due_.due(time)) write_replay(time);
}

void CoupledOutputs::update_probes(double time) {
  const double dt = time - last_probe_time_;
  last_probe_time_ = time;
  for (Probe& p : probes_) p.read(*model_.flow(), time, dt);
}

void CoupledOutputs::write_histories(double time) {
  histories_due_.done(time);
  const auto bodies = model_.lumps();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::array<double, 21> row;
    const Vec3 columns[] = {bodies[b].position,
                            bodies[b].velocity,
                            bodies[b].angular_velocity,
                            model_.loads()[b].force,
                            model_.friction(b),
                            model_.loads()[b].torque,
                            model_.particles().contact_force(int(b))};
    for (std::size_t n = 0; n < 21; ++n) row[n] = columns[n / 3][static_cast<int>(n % 3)];
    bodies_[b]->add(time, row);
  }
  for (Probe& p : probes_) p.write(time);
  if (grains_) write_grain_history(time);
  if (energy_) {
    const DemEnergy e = model_.particles().energy();
    energy_->add(time, std::array{e.kinetic, e.potential, e.elastic, e.dissipated, e.work});
  }
}

std::vector<CellField> CoupledOutputs::written_fields() const {
  std::vector<CellField> fields = model_.air_fields();
  const std::vector<std::string>& chosen = case_.output.fields;
  if (!chosen.empty())
    std::erase_if(fields, [&](const CellField& f) {
      return std::find(chosen.begin(), chosen.end(), f.name) == chosen.end();
    });
  return fields;
}

void CoupledOutputs::write_fields(double time) {
  fields_.done(time);
  if (air_ && model_.air()) {
    const auto path = air_->next(".vtr");
    writer_->write(path, time, written_fields());
    air_->add(time, path);
  }
  if (grains_series_) write_grains(time);
  if (bodies_series_) {
    std::vector<output::BodyPose> poses;
    output::BodyArray speed{"speed", 1, {}}, velocity{"velocity", 3, {}}, force{"force", 3, {}},
        contact{"contact_force", 3, {}};
    const auto bodies = model_.lumps();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      poses.push_back(
          {bodies[b].position, bodies[b].orientation, model_.particles().presence(int(b)) == Presence::here});
      speed.values.push_back(bodies[b].velocity.norm());
      for (int d = 0; d < 3; ++d) {
        velocity.values.push_back(bodies[b].velocity[d]);
        force.values.push_back(model_.loads()[b].force[d]);
        contact.values.push_back(model_.particles().contact_force(int(b))[d]);
      }
    }
    const auto path = bodies_series_->next(".vtp");
    bodies_writer_->write(path, time, poses, std::array{speed, velocity, force, contact});
    bodies_series_->add(time, path);
  }
}

void CoupledOutputs::write_grain_history(double time) {
  const GrainSums s = grain_sums(model_.particles(), model_.first_grain());
  std::vector<double> row{double(s.count), s.mass,         s.centre.x(),   s.centre.y(), s.centre.z(),
                          s.velocity.x(),  s.velocity.y(), s.velocity.z(), s.height,     s.kinetic_energy};
  if (model_.flow()) row.push_back(model_.drop().pressure);
  grains_->add(time, row);
}

void CoupledOutputs::write_grains(double time) {
  const auto grains = model_.particles().bodies().subspan(model_.first_grain());
  const auto loads = std::span(model_.loads()).subspan(model_.first_grain());
  std::vector<output::GrainPoint> points;
  for (std::size_t n = 0; n < grains.size(); ++n)
    if (model_.particles().presence(static_cast<int>(model_.first_grain() + n)) == Presence::here)
      points.push_back({grains[n].position, 2 * grains[n].shape.bounding_radius(), grains[n].velocity,
                        loads[n].force, static_cast<std::int64_t>(n)});
  const auto path = grains_series_->next(".vtp");
  output::write_grains(path, time, points);
  grains_series_->add(time, path);
}

void CoupledOutputs::write_replay(double time) {
  replay_due_.done(time);
  output::ReplayFrame frame;
  frame.time = time;
  for (const Body& b : model_.lumps())
    frame.bodies.push_back(
        {b.position, b.orientation, model_.particles().presence(int(frame.bodies.size())) == Presence::here});
  if (model_.air())
    for (std::size_t r = 0; r < samplers_.size(); ++r) {
      output::SliceFrame slice;
      slice.raster = static_cast<int>(r);
      const auto u = model_.flow()->seen().velocity;
      samplers_[r].sample(u[0], u[1], u[2], slice);
      frame.slices.push_back(std::move(slice));
    }
  const std::size_t grains = model_.particles().bodies().size() - model_.first_grain(),
                    shown = std::min(grains, kGrainsShown);
  for (std::size_t n = 0; n < shown; ++n) {
    const std::size_t g = model_.first_grain() + n * grains / shown;
    const bool here = model_.particles().presence(static_cast<int>(g)) == Presence::here;
    frame.grains.push_back(here ? model_.particles().bodies()[g].position
                                : Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  replay_->add(frame);
}

void CoupledOutputs::write_slices(double time) {
  slices_due_.done(time);
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    const SliceSpec& spec = case_.slices[s];
    const auto path = slices_[s].next(".vtr");
    writer_->write(path, time, written_fields(),
                   output::slice_range(model_.grid(), spec.axis, spec.position));
    slices_[s].add(time, path);
  }
  write_lines(time);
}

void CoupledOutputs::write_lines(double time) {
  for (Line& line : lines_) {
    std::vector<double> row(line.history->columns().size());
    for (std::size_t n = 0; n < line.points.size(); ++n) {
      row[0] = line.position[n];
      model_.flow()->sample(line.points[n], std::span(row).subspan(1));
      line.history->add(time, row);
    }
  }
}

void CoupledOutputs::finish(double time) {
  if (time > histories_due_.last()) write_histories(time);
  const Particles& particles = model_.particles();
  if (!keep_histories_ || !belt_runs(particles) || model_.any_grains()) return;
  output::History& history = histories_.open_anew("spacing", {{"body", "1"},
                                                              {"neighbour", "1"},
                                                              {"x", "m"},
                                                              {"y", "m"},
                                                              {"z", "m"},
                                                              {"gap", "m"},
                                                              {"centre_distance", "m"}});
  for (const Spacing& s : spacings(particles)) {
    const Vec3& x = particles.bodies()[static_cast<std::size_t>(s.body)].position;
    history.add(time, std::array{double(s.body), double(s.neighbour), x.x(), x.y(), x.z(), s.gap, s.centre});
  }
}

void CoupledOutputs::report(nlohmann::ordered_json& result) {
  if (!model_.flow()) return;
  const auto quantities = model_.flow()->quantities();
  for (const Probe& p : probes_) p.report(result, quantities);
  std::vector<double> values(quantities.size());
  for (const LineSpec& line : case_.lines) {
    auto& out = result["lines"][line.name];
    for (const Vec3& x : points_of(line)) {
      model_.flow()->sample(x, values);
      out["position_m"].push_back((x - line.from).norm());
      for (std::size_t q = 0; q < values.size(); ++q) out[quantities[q].first].push_back(values[q]);
    }
  }
}

std::vector<double> CoupledOutputs::state() const {
  std::vector<double> s{histories_due_.last(), fields_.last(), slices_due_.last(), replay_due_.last(),
                        last_probe_time_};
  for (const Probe& p : probes_) p.save(s);
  return s;
}

void CoupledOutputs::restore(const std::vector<double>& s) {
  StateReader in(s, "outputs");
  for (Schedule* schedule : {&histories_due_, &fields_, &slices_due_, &replay_due_})
    schedule->done(in.number());
  last_probe_time_ = in.number();
  for (Probe& p : probes_) p.load(in);
  in.end();
}

}  // namespace ejecta
