#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "case/case.hpp"
#include "coupling/resolved/resolved.hpp"
#include "flow/model/flow_model.hpp"
#include "simulation/grains_in_flow.hpp"
#include "simulation/model.hpp"
#include "simulation/scene.hpp"

namespace ejecta {

/// One entry of a step: what it does, its equation, what it cost.
struct Operator {
  std::string name, equation;
  std::function<void(double time, double dt)> run;
  double seconds = 0.0;
  std::int64_t calls = 0;
};

/// A whole case: fluid, bodies, their coupling, the splitter. `step` is the time step; ejecta plan prints it.
class CoupledModel : public Model {
 public:
  /// `note` is told when a jet has to be computed first.
  explicit CoupledModel(const Case& c, const Note& note = {});
  CoupledModel(const Case& c, Inflow inflow);
  CoupledModel(const CoupledModel&) = delete;  // its operators hold it

  double stable_dt(double time) override;
  void advance(const Step& step) override;
  void advance(double time, double dt) { advance({time, dt, time + dt}); }
  /// Times at which what enters the box has kinks, s.
  std::vector<double> events() const override { return inflow_.events; }
  /// The case's own end ("verdict", "rest") has come.
  bool finished() const override;
  bool conclude(const std::function<bool()>&, const Note&) override { return true; }
  void require_finite(double time) const override;
  std::int64_t cells() const override { return air_ ? grid_.cells() : 0; }
  std::size_t bodies() const override { return scene_.bodies; }
  double courant() const override { return courant_; }
  double busy_until() const override { return busy_until_; }
  std::vector<OperatorTime> operator_times() const override;
  FieldsOnGrid fields() override;
  std::vector<NamedField> state_fields() override;
  StateNumbers state_numbers() const override;
  void restore_numbers(const StateNumbers& numbers, double time) override;
  nlohmann::ordered_json result(double time, std::int64_t steps, double wall_time,
                                std::span<const OperatorTime> operators) const override;
  std::optional<double> later_end(double time) const override;
  std::vector<std::string> warnings() const override;

  std::vector<Operator>& step() { return step_; }

  const Case& config() const { return case_; }
  const Grid& grid() const { return grid_; }
  const Scene& scene() const { return scene_; }
  const Inflow& inflow() const { return inflow_; }
  FlowModel* flow() const { return flow_.get(); }
  const Particles& particles() const { return particles_; }
  /// The bodies that the grid resolves; grains come after them.
  std::span<const Body> lumps() const { return particles_.bodies().first(scene_.bodies); }
  std::size_t first_grain() const { return scene_.bodies; }
  bool any_grains() const { return particles_.bodies().size() > scene_.bodies; }
  /// Null without grains or without a flow.
  const GrainsInFlow* grains() const { return grains_ ? &*grains_ : nullptr; }
  /// Grains that passed above and below the edge of the dividing plate, of each name in the order of the
  /// case.
  const std::vector<std::array<int, 2>>& sorted_grains() const { return sorted_grains_; }
  /// Along z through the box.
  PressureDrop drop() const;
  /// The same with the height of the grains' centre of mass, m, mean over the second half of the run.
  double mean_drop() const { return bed_time_ > 0.0 ? drop_sum_ / bed_time_ : drop().pressure; }
  std::optional<double> mean_bed_height() const {
    return bed_time_ > 0.0 ? std::optional(height_sum_ / bed_time_) : std::nullopt;
  }
  /// Fields of the flow and of the grains in it.
  std::vector<CellField> air_fields() const;
  const std::vector<Load>& loads() const { return loads_; }
  const std::optional<Splitter>& splitter() const { return splitter_; }
  const std::vector<Vec3>& impulse() const { return impulse_; }  ///< N s of the fluid on each body
  const std::vector<Vec3>& start_velocity() const { return start_velocity_; }
  const std::vector<std::vector<Vec3>>& undisturbed() const { return undisturbed_; }
  /// Mean force over the time since stream.average_from, N.
  Vec3 mean_force(std::size_t body) const;
  Vec3 mean_torque(std::size_t body) const;
  /// What friction has in the force of the air: now, and in the mean force, N.
  Vec3 friction(std::size_t body) const;
  Vec3 mean_friction(std::size_t body) const;
  double peak_speed(std::size_t body) const { return peak_speed_[body]; }  ///< m/s
  std::int64_t flow_steps() const { return flow_steps_; }
  double max_courant() const { return max_courant_; }
  /// The air is still being computed.
  bool air() const { return air_; }

 private:
  CouplingSetup coupling_setup() const;
  void draw_undisturbed(const std::vector<FlightState>& starts);
  void check_bodies() const;
  void build_step();
  void watch_air(double time);
  double step_of_courses() const;
  double step_of_grains() const;
  void sort_grains();
  bool grains_have_left() const;
  void note_bed(double time, double dt);
  double step_of_bodies(double time, double dt) const;
  std::vector<double> own_state() const;
  void restore_own(const std::vector<double>& numbers);

  const Case case_;  // copies of bodies written out
  Grid grid_;
  const Inflow inflow_;
  std::unique_ptr<FlowModel> flow_;
  Scene scene_;
  Particles& particles_;
  std::optional<ResolvedCoupling> coupling_;
  std::optional<GrainsInFlow> grains_;
  double bed_time_ = 0.0, drop_sum_ = 0.0, height_sum_ = 0.0;
  std::vector<double> grain_x_;  // m, before the step, where they are sorted
  std::vector<std::array<int, 2>> sorted_grains_;
  CutCells cut_;
  std::optional<Splitter>& splitter_;
  std::vector<Operator> step_;
  std::vector<Load> loads_;
  std::vector<Vec3> impulse_, start_velocity_, before_, force_sum_, friction_sum_, torque_sum_;
  std::vector<std::vector<Vec3>> undisturbed_;
  std::vector<Course::Pace> paces_;  // of prescribed bodies, over the whole run
  std::vector<double> peak_speed_;
  double averaged_ = 0.0, max_courant_ = 0.0, courant_ = 0.0, peak_energy_ = 0.0, busy_until_ = 0.0;
  std::int64_t flow_steps_ = 0;
  bool air_ = true, resting_ = false;
};

}  // namespace ejecta
