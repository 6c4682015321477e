#include "simulation/coupled_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/state_reader.hpp"
#include "base/stopwatch.hpp"
#include "case/copies.hpp"
#include "jet/inlet.hpp"
#include "simulation/air_forecast.hpp"
#include "simulation/air_limits.hpp"
#include "simulation/body_checks.hpp"

namespace ejecta {
namespace {

constexpr double kRestSpeed = 1e-4;  // m/s, of any point of a body at rest
constexpr double kUnborne = 0.5;     // of the weight of one at rest, that nothing bears

/// A case without a fluid has no grid; one cell stands for it.
Grid grid_or_cell(const Case& c) {
  if (c.flow.solver != FlowSolver::none) return make_grid(c);
  const Axis one = make_axis({0.0, 1.0}, {1}, {});
  return Grid(one, one, one);
}

/// Longest step without air, s: positions in histories and reports stay smooth.
constexpr double kFlightStep = 1e-4;

}  // namespace

namespace {

const Case& one_run(const Case& c) {
  if (c.campaign.enabled)
    throw InputError(
        fmt::format("{} is a campaign of {} cases\n  expected: one case\n  example:  ejecta campaign {}",
                    c.path, c.campaign.parts.size(), c.path));
  return c;
}

}  // namespace

CoupledModel::CoupledModel(const Case& c, const Note& note)
    : CoupledModel(c, one_run(c).flow.solver == FlowSolver::none ? Inflow{} : inflow_of(c, note)) {}

CoupledModel::CoupledModel(const Case& c, Inflow inflow)
    : case_(with_copies(one_run(c))),
      grid_(grid_or_cell(c)),
      inflow_(std::move(inflow)),
      flow_(make_flow_model(case_, grid_, inflow_)),
      scene_(make_scene(case_, flow_ ? &grid_ : nullptr)),
      particles_(scene_.particles),
      splitter_(scene_.splitter) {
  air_ = flow_ != nullptr;
  draw_undisturbed(scene_.starts);
  const std::size_t n = scene_.bodies;
  loads_.resize(particles_.bodies().size());
  impulse_.assign(n, Vec3::Zero());
  force_sum_.assign(n, Vec3::Zero());
  friction_sum_.assign(n, Vec3::Zero());
  torque_sum_.assign(n, Vec3::Zero());
  before_.resize(n);
  for (const Body& b : lumps()) peak_speed_.push_back(b.velocity.norm());
  if (flow_ && n > 0) coupling_.emplace(grid_, coupling_setup());
  if (flow_ && any_grains()) grains_.emplace(case_, grid_, flow_->density(), n);
  sorted_grains_.resize(case_.grains.size());
  for (const Body& b : lumps())
    paces_.push_back(b.course ? b.course->pace(case_.run.end_time) : Course::Pace{});
  check_bodies();
  build_step();
  // A verdict comes in free flight, which costs nothing: what is left to wait for is the air.
  busy_until_ = std::min(case_.run.end_time, air_until(case_, company_of(scene_)));
}

CouplingSetup CoupledModel::coupling_setup() const {
  CouplingSetup s;
  s.fluid_density = flow_->density();
  s.gravity = case_.environment.gravity;
  s.body_force = case_.flow.body_force;
  if (case_.flow.solver == FlowSolver::incompressible && case_.flow.turbulence == TurbulenceModel::laminar)
    s.viscosity = case_.fluid.viscosity;
  for (std::size_t d = 0; d < 3; ++d)
    s.periodic[d] = grid_.active(int(d)) && case_.boundary[2 * d].type == BoundaryType::periodic;
  for (const Body& b : lumps()) s.roughness.push_back(particles_.materials().spec(b.material).roughness);
  return s;
}

/// Where bodies would be that no air touches: as far as the end of the plate.
void CoupledModel::draw_undisturbed(const std::vector<FlightState>& starts) {
  for (std::size_t b = 0; b < starts.size(); ++b) {
    const Body& body = particles_.bodies()[b];
    start_velocity_.push_back(body.velocity);
    std::vector<Vec3> path;
    const double reach = splitter_ ? splitter_->edge().x() + case_.splitter.length : body.position.x();
    const double flight =
        body.velocity.x() > 0.0 && !body.course ? (reach - body.position.x()) / body.velocity.x() : 0.0;
    for (int p = 0; flight > 0.0 && p <= 60; ++p)
      path.push_back(free_flight(starts[b], case_.environment.gravity, flight * p / 60.0));
    undisturbed_.push_back(path);
  }
}

void CoupledModel::check_bodies() const {
  if (!flow_) return;
  std::vector<Problem> problems = ejecta::check_bodies(case_, grid_, lumps());
  std::erase_if(problems, [](const Problem& p) { return p.severity != Severity::error; });
  if (!problems.empty()) throw CaseError(problems);
}

void CoupledModel::build_step() {
  if (coupling_)
    step_.push_back(
        {"map.bodies", "what bodies leave of cells and faces, and their walls", [this](double, double) {
           if (air_) coupling_->map(lumps(), cut_);
         }});
  if (grains_)
    step_.push_back({"map.grains", "1 - e = sum of K V_p / V, drag = sum of K beta (u - v) / V",
                     [this](double, double dt) {
                       if (air_) grains_->map(particles_, *flow_, cut_, dt);
                     }});
  if (flow_)
    step_.push_back({"flow.advance", "one step of the fluid around the bodies (see flow.* below)",
                     [this](double time, double dt) {
                       if (!air_) return;
                       if (grains_) flow_->advance_with_grains(time, dt, cut_, grains_->fraction());
                       else flow_->advance(time, dt, cut_);
                       ++flow_steps_;
                     }});
  if (coupling_)
    step_.push_back({"loads.collect",
                     "F = sum of pressure and friction on its walls - rho V g, T = sum r x F",
                     [this](double time, double dt) {
                       if (!air_) {
                         std::fill(loads_.begin(), loads_.end(), Load{});
                         return;
                       }
                       coupling_->collect(lumps(), cut_, dt, std::span(loads_).first(scene_.bodies));
                       for (std::size_t b = 0; b < impulse_.size(); ++b) impulse_[b] += dt * loads_[b].force;
                       if (time < case_.stream.average_from) return;
                       averaged_ += dt;
                       for (std::size_t b = 0; b < impulse_.size(); ++b) {
                         force_sum_[b] += dt * loads_[b].force;
                         friction_sum_[b] += dt * friction(b);
                         torque_sum_[b] += dt * loads_[b].torque;
                       }
                     }});
  if (grains_)
    step_.push_back({"grains.collect", "f = K beta (u - v) + V_p (-grad p + div tau) - rho V_p g",
                     [this](double time, double dt) {
                       if (air_) note_bed(time, dt);
                       if (air_) grains_->collect(particles_, loads_);
                       else
                         std::fill(loads_.begin() + static_cast<std::ptrdiff_t>(scene_.bodies), loads_.end(),
                                   Load{});
                     }});
  if (!particles_.bodies().empty())
    step_.push_back({"bodies.advance", "m dV/dt = F_contact + m g + F_fluid, I dw/dt + w x I w = T",
                     [this](double, double dt) {
                       for (std::size_t b = 0; b < before_.size(); ++b)
                         before_[b] = particles_.bodies()[b].position;
                       if (splitter_ && any_grains()) {
                         const auto grains = particles_.bodies().subspan(scene_.bodies);
                         grain_x_.resize(grains.size());
                         for (std::size_t g = 0; g < grains.size(); ++g) grain_x_[g] = grains[g].position.x();
                       }
                       particles_.advance(dt, loads_);
                       for (std::size_t b = 0; b < peak_speed_.size(); ++b)
                         peak_speed_[b] = std::max(peak_speed_[b], particles_.bodies()[b].velocity.norm());
                     }});
  if (splitter_)
    step_.push_back(
        {"splitter.watch", "ejected when the centre passes above the edge", [this](double time, double dt) {
           splitter_->watch(lumps(), before_, time + dt, dt);
           sort_grains();
         }});
}

double CoupledModel::stable_dt(double time) {
  double dt = case_.run.time_step_max;
  if (case_.run.time_step) dt = *case_.run.time_step;
  if (flow_ && air_) {
    if (!case_.run.time_step) dt = std::min(dt, flow_->stable_dt(time));
    if (coupling_ && !case_.run.time_step) dt = std::min(dt, step_of_bodies(time, dt));
    if (grains_ && !case_.run.time_step) dt = std::min(dt, step_of_grains());
  } else if (!case_.run.time_step) {
    dt = std::min(dt, kFlightStep);
  }
  if (flow_ && air_ && !case_.run.time_step) dt = std::min(dt, step_of_courses());
  return dt;
}

/// A body must not cross half a cell in one step of at most dt, with the velocity it has, will have been
/// given by then, or gains from gravity and the fluid.
double CoupledModel::step_of_bodies(double time, double dt) const {
  const double way = 0.5 * case_.run.courant;  // in cells
  double rate = 0.0;                           // 1/s: rate dt + growth dt^2 = way
  for (std::size_t n = 0; n < scene_.bodies; ++n) {
    const Body& b = particles_.bodies()[n];
    const bool waits = time < std::max(b.release_at, b.enters_at.value_or(0.0));
    const bool starts = waits && time + dt > std::max(b.release_at, b.enters_at.value_or(0.0));
    const Vec3 velocity = starts ? case_.bodies[n].velocity : b.velocity;
    const double spin = (starts ? case_.bodies[n].spin : b.angular_velocity).norm();
    const bool falls = b.motion == Motion::free && (starts || !waits);
    const Vec3 gain = falls ? Vec3(case_.environment.gravity + loads_[n].force / b.mass) : Vec3(0, 0, 0);
    for (int d = 0; d < 3; ++d) {
      if (!grid_.active(d)) continue;
      const double h = grid_.axis(d).smallest();
      const double r = (std::abs(velocity[d]) + spin * b.shape.bounding_radius()) / h;
      rate = std::max(rate, 0.5 * (r + std::sqrt(r * r + 4.0 * way * std::abs(gain[d]) / h)));
    }
  }
  return rate > 0.0 ? way / rate : dt;
}

/// Grains must not cross half a cell in a step: they are mapped once in it. Where the drag of a gas jumps
/// from cell to cell the velocity beside it would be off by some part of what drag takes in a step.
double CoupledModel::step_of_grains() const {
  constexpr double kDragInAStep = 0.5;
  constexpr int kPieces = 64;
  const auto grains = particles_.bodies().subspan(scene_.bodies);
  std::array<Vec3, kPieces> of_piece;
  for_each_index(kPieces, [&](int piece) {
    Vec3 fastest(0, 0, 0);
    for (std::size_t n = grains.size() * std::size_t(piece) / kPieces;
         n < grains.size() * std::size_t(piece + 1) / kPieces; ++n)
      fastest = fastest.cwiseMax(grains[n].velocity.cwiseAbs());
    of_piece[static_cast<std::size_t>(piece)] = fastest;
  });
  Vec3 fastest(0, 0, 0);
  for (const Vec3& piece : of_piece) fastest = fastest.cwiseMax(piece);
  double rate = 0.0;
  for (int d = 0; d < 3; ++d)
    if (grid_.active(d))
      rate = std::max(rate, fastest[d] / (0.5 * case_.run.courant * grid_.axis(d).smallest()));
  if (case_.flow.solver == FlowSolver::compressible_piso && case_.coupling.exchange == GrainExchange::two_way)
    rate = std::max(rate, grains_->fastest_drag() / kDragInAStep);
  return rate > 0.0 ? 1.0 / rate : 1e300;
}

/// Counts grains that came past the edge of the plate in this step, by the height of their centre there.
void CoupledModel::sort_grains() {
  const Vec3& edge = splitter_->edge();
  const auto grains = particles_.bodies().subspan(scene_.bodies);
  std::size_t group = 0;
  for (std::size_t g = 0; g < grain_x_.size(); ++g) {
    const Body& b = grains[g];
    while (case_.grains[group].name != b.name) group = (group + 1) % case_.grains.size();
    if (grain_x_[g] < edge.x() && b.position.x() >= edge.x())
      ++sorted_grains_[group][b.position.z() > edge.z() ? 0 : 1];
  }
}

void CoupledModel::note_bed(double time, double dt) {
  if (time < 0.5 * case_.run.end_time) return;
  bed_time_ += dt;
  drop_sum_ += dt * drop().pressure;
  height_sum_ += dt * grain_sums(particles_, scene_.bodies).centre.z();
}

PressureDrop CoupledModel::drop() const {
  const std::vector<CellField> fields = flow_->fields();
  const CellField& p = field_named(fields, "pressure");
  return pressure_drop(grid_, p.component[0], p.scale);
}

std::vector<CellField> CoupledModel::air_fields() const {
  std::vector<CellField> all = flow_->fields();
  if (grains_)
    for (CellField& f : grains_->fields()) all.push_back(std::move(f));
  return all;
}

std::vector<std::string> CoupledModel::warnings() const {
  std::vector<std::string> all = particles_.warnings();
  if (grains_)
    for (std::string& w : grains_->warnings()) all.push_back(std::move(w));
  return all;
}

void CoupledModel::advance(const Step& s) {
  const double time = s.from, dt = s.dt;
  if (flow_ && air_) {
    courant_ = flow_->courant(dt);
    if (!std::isfinite(courant_)) require_finite(time);
    max_courant_ = std::max(max_courant_, courant_);
  }
  for (Operator& op : step_) {
    ScopedTimer timer(op.seconds);
    op.run(time, dt);
    ++op.calls;
  }
  watch_air(time + dt);
}

void CoupledModel::watch_air(double time) {
  if (!air_ || case_.run.until != RunUntil::verdict || !coupling_) return;
  if (flow_steps_ % 50 == 0) {
    const double energy = flow_->kinetic_energy();
    peak_energy_ = std::max(peak_energy_, energy);
    if (time > inflow_.shut_from && energy < kDeadAir * peak_energy_) air_ = false;
  }
  if (time > inflow_.shut_from && !coupling_->any_inside(lumps()) && grains_have_left()) air_ = false;
}

/// But for one in twenty: some whirl on for long where nothing else happens.
bool CoupledModel::grains_have_left() const {
  const auto grains = particles_.bodies().subspan(scene_.bodies);
  const Vec3 low = grid_.lower(), high = grid_.upper();
  std::size_t inside = 0;
  for (std::size_t n = 0; n < grains.size(); ++n)
    inside += particles_.presence(static_cast<int>(scene_.bodies + n)) != Presence::gone &&
              (grains[n].position.array() >= low.array()).all() &&
              (grains[n].position.array() <= high.array()).all();
  return 20 * inside <= grains.size();
}

/// What is prescribed may be at rest now and fast within the step: its highest speed in the whole run must
/// not take it over half a cell, and of a swing there are at least 40 steps.
double CoupledModel::step_of_courses() const {
  constexpr double change_in_step = 0.1;  // of the highest velocity
  double rate = 0.0;
  for (std::size_t n = 0; n < paces_.size(); ++n) {
    const double around = paces_[n].spin * particles_.bodies()[n].shape.bounding_radius();
    for (int d = 0; d < 3; ++d)
      if (grid_.active(d))
        rate = std::max(rate,
                        (paces_[n].speed[d] + around) / grid_.axis(d).smallest() / (0.5 * case_.run.courant));
    rate = std::max(rate, paces_[n].change / change_in_step);
  }
  return rate > 0.0 ? 1.0 / rate : 1e300;
}

bool CoupledModel::finished() const {
  if (case_.run.until == RunUntil::verdict) return splitter_ && splitter_->all_passed();
  if (case_.run.until != RunUntil::rest) return false;
  const auto bodies = particles_.bodies();
  for (std::size_t n = 0; n < bodies.size(); ++n)
    if (particles_.presence(static_cast<int>(n)) == Presence::waiting) return false;
  const double g = case_.environment.gravity.norm();
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const Body& b = bodies[n];
    const int index = static_cast<int>(n);
    if (particles_.presence(index) == Presence::gone || b.motion == Motion::fixed) continue;
    if (b.release_at > particles_.time()) return false;
    if (b.velocity.norm() + b.angular_velocity.norm() * b.shape.bounding_radius() > kRestSpeed) return false;
    // Nothing is at rest where it hangs in the air for a moment: something must bear its weight.
    const Vec3 borne = (particles_.contact_force(index) + loads_[n].force) / b.mass;
    if (b.motion == Motion::free && (case_.environment.gravity + borne).norm() > kUnborne * g) return false;
  }
  return true;
}

Vec3 CoupledModel::mean_force(std::size_t b) const {
  return averaged_ > 0.0 ? Vec3(force_sum_[b] / averaged_) : loads_[b].force;
}

Vec3 CoupledModel::friction(std::size_t b) const {
  return air_ && coupling_ && b < coupling_->parts().size() ? coupling_->parts()[b].friction
                                                            : Vec3(Vec3::Zero());
}

Vec3 CoupledModel::mean_friction(std::size_t b) const {
  return averaged_ > 0.0 ? Vec3(friction_sum_[b] / averaged_) : friction(b);
}

Vec3 CoupledModel::mean_torque(std::size_t b) const {
  return averaged_ > 0.0 ? Vec3(torque_sum_[b] / averaged_) : loads_[b].torque;
}

void CoupledModel::require_finite(double time) const {
  Vec3 where{0, 0, 0};
  if (!flow_ || !air_ || flow_->finite(&where)) return;
  throw DivergedError(
      fmt::format("the flow diverged at t = {:.6g} s near x, y, z = {:.4g}, {:.4g}, {:.4g} mm (Courant "
                  "number {:.2f}); try a smaller "
                  "run.courant, a smoother grid there, or a longer valve.rise_time",
                  time, where.x() * 1e3, where.y() * 1e3, where.z() * 1e3, courant_));
}

std::vector<OperatorTime> CoupledModel::operator_times() const {
  std::vector<OperatorTime> all;
  for (const Operator& op : step_) {
    if (op.name != "flow.advance") {
      all.push_back({op.name, op.equation, op.seconds, op.calls});
      continue;
    }
    for (OperatorTime part : flow_->operators()) {
      part.calls = flow_steps_;
      all.push_back(part);
    }
  }
  return all;
}

/// When the last undecided body that flies on should have come to the plate, with half as much again, s.
std::optional<double> CoupledModel::later_end(double time) const {
  double latest = 0.0;
  const auto bodies = lumps();
  for (std::size_t b = 0; splitter_ && b < bodies.size(); ++b) {
    if (!splitter_->judges(b) || splitter_->verdict(b)) continue;
    const double way = splitter_->edge().x() - bodies[b].position.x();
    if (bodies[b].velocity.x() > 0.0) latest = std::max(latest, way / bodies[b].velocity.x());
  }
  if (!(latest > 0.0) || latest > 100.0) return std::nullopt;
  return std::ceil(1e3 * (time + 1.5 * latest)) * 1e-3;
}

FieldsOnGrid CoupledModel::fields() {
  if (!flow_) return {};
  return {&grid_, air_fields()};
}

std::vector<NamedField> CoupledModel::state_fields() {
  std::vector<NamedField> all = flow_ ? flow_->state_fields() : std::vector<NamedField>{};
  if (grains_)
    for (const NamedField& f : grains_->state_fields()) all.push_back(f);
  return all;
}

StateNumbers CoupledModel::state_numbers() const {
  StateNumbers all{{"sums", own_state()}, {"bodies", particles_.state()}};
  if (flow_) all["air"] = flow_->state_numbers();
  if (coupling_) all["forces"] = coupling_->state();
  if (splitter_) all["verdicts"] = splitter_->state();
  if (grains_) all["grains"] = grains_->state();
  return all;
}

std::vector<double> CoupledModel::own_state() const {
  std::vector<double> own{averaged_, max_courant_, peak_energy_, double(flow_steps_), double(air_)};
  for (const auto* list : {&impulse_, &start_velocity_, &force_sum_, &friction_sum_, &torque_sum_})
    for (const Vec3& v : *list) own.insert(own.end(), {v.x(), v.y(), v.z()});
  own.insert(own.end(), peak_speed_.begin(), peak_speed_.end());
  if (any_grains()) own.insert(own.end(), {bed_time_, drop_sum_, height_sum_});
  for (const auto& [above, below] : sorted_grains_) own.insert(own.end(), {double(above), double(below)});
  for (const Load& l : std::span(loads_).first(scene_.bodies))
    own.insert(own.end(), {l.force.x(), l.force.y(), l.force.z(), l.torque.x(), l.torque.y(), l.torque.z()});
  return own;
}

void CoupledModel::restore_numbers(const StateNumbers& numbers, double time) {
  restore_own(numbers_of(numbers, "sums"));
  particles_.restore(numbers_of(numbers, "bodies"));
  if (flow_) flow_->restore_numbers(numbers_of(numbers, "air"), time);
  if (coupling_) coupling_->restore(numbers_of(numbers, "forces"));
  if (splitter_) splitter_->restore(numbers_of(numbers, "verdicts"));
  if (grains_) grains_->restore(numbers_of(numbers, "grains"), particles_.bodies().size() - scene_.bodies);
}

void CoupledModel::restore_own(const std::vector<double>& numbers) {
  StateReader own(numbers, "model");
  for (double* v : {&averaged_, &max_courant_, &peak_energy_}) *v = own.number();
  flow_steps_ = static_cast<std::int64_t>(own.number());
  air_ = own.whole(0, 1) == 1;
  for (auto* list : {&impulse_, &start_velocity_, &force_sum_, &friction_sum_, &torque_sum_})
    for (Vec3& v : *list) v = own.vec3();
  for (double& v : peak_speed_) v = own.number();
  if (any_grains())
    for (double* v : {&bed_time_, &drop_sum_, &height_sum_}) *v = own.number();
  for (auto& sides : sorted_grains_)
    for (int& count : sides) count = own.whole(0, std::numeric_limits<int>::max());
  for (Load& l : std::span(loads_).first(scene_.bodies)) l.force = own.vec3(), l.torque = own.vec3();
  own.end();
}

}  // namespace ejecta
