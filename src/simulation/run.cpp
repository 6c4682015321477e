#include "simulation/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "base/thread_budget.hpp"
#include "case/extent.hpp"
#include "jet/computed.hpp"
#include "jet/store.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/verdict.hpp"
#include "simulation/archive.hpp"
#include "simulation/coupled_model.hpp"
#include "simulation/coupled_outputs.hpp"
#include "simulation/jet_outputs.hpp"
#include "simulation/recorded_jet.hpp"
#include "simulation/result_fields.hpp"

namespace ejecta {
namespace {

/// How often a run looks for NaN, in steps.
constexpr int kCheckInterval = 20;

/// One run: the clock, the model, its observers.
class Run {
 public:
  Run(const Case& c, const Context& context, std::unique_ptr<Model> model, const OutputsMaker& make_outputs)
      : case_(c), context_(context), model_(std::move(model)), checkpoints_(c.checkpoint.every_time) {
    // After the model: a case that cannot start must not have cleared a finished run.
    if (context.files)
      archive_ = std::make_unique<Archive>(c, *model_, *context.files, make_outputs, context.note);
    else loose_outputs_ = make_outputs({});
    for (double t : model_->events()) clock_.add_event(t);
    clock_.add_event(c.run.end_time);
    outputs().add_events(clock_);
    clock_.add_events_every(c.checkpoint.every_time, 0.0, c.run.end_time);
    if (archive_ && context.files->resume) archive_->restore(clock_, wall_before_);
    checkpoints_.done(clock_.time());
  }

  Result to_end() {
    try {
      return advance_to_end();
    } catch (const DivergedError&) {
      const auto earlier = archive_ ? archive_->directory().earlier() : std::nullopt;
      if (earlier && context_.note)
        context_.note(fmt::format("the run that stood there before is kept in {}", earlier->string()));
      throw;
    }
  }

 private:
  Result advance_to_end() {
    start_ = wall_seconds() - wall_before_;
    last_checkpoint_ = wall_seconds();
    if (clock_.steps() == 0) write_outputs();
    observe(0.0);
    while (!finished()) {
      const Step step = clock_.next(model_->stable_dt(clock_.time()));
      model_->advance(step);
      clock_.tick(step);
      if (clock_.steps() % kCheckInterval == 0) model_->require_finite(clock_.time());
      write_outputs();
      observe(step.dt);
      const bool stop = stopped();
      if (stop || (context_.keep && context_.keep()) || checkpoint_due()) write_checkpoint();
      if (stop) return result(RunEnd::stopped);
    }
    model_->require_finite(clock_.time());
    return conclude();
  }

  bool finished() const { return clock_.time() >= case_.run.end_time * (1.0 - 1e-12) || model_->finished(); }
  bool stopped() const { return context_.stop && context_.stop(); }

  void observe(double dt) const {
    if (context_.observe)
      context_.observe(
          {*model_, clock_.time(), clock_.steps(), dt, std::max(model_->busy_until(), clock_.time())});
  }

  Outputs& outputs() { return archive_ ? archive_->outputs() : *loose_outputs_; }

  void write_outputs() {
    const ScopedTimer timer(outputs_time_.seconds);
    outputs().observe(clock_.time(), clock_.steps());
    ++outputs_time_.calls;
  }

  bool checkpoint_due() const {
    const CheckpointSpec& spec = case_.checkpoint;
    if (spec.every_steps > 0 && clock_.steps() % spec.every_steps == 0) return true;
    if (spec.every_wall_time > 0.0 && wall_seconds() - last_checkpoint_ >= spec.every_wall_time) return true;
    return spec.every_time > 0.0 && checkpoints_.due(clock_.time());
  }

  void write_checkpoint() {
    last_checkpoint_ = wall_seconds();
    checkpoints_.done(clock_.time());
    if (!archive_) return;
    const ScopedTimer timer(checkpoints_time_.seconds);
    ++checkpoints_time_.calls;
    model_->require_finite(clock_.time());
    archive_->write_checkpoint(*model_, clock_, wall_time());
  }

  double wall_time() const { return wall_seconds() - start_; }

  std::vector<OperatorTime> operators() const {
    std::vector<OperatorTime> all = model_->operator_times();
    all.push_back(outputs_time_);
    if (checkpoints_time_.calls > 0) all.push_back(checkpoints_time_);
    return all;
  }

  Result result(RunEnd end) {
    Result r{.end = end,
             .time = clock_.time(),
             .steps = clock_.steps(),
             .wall_time = wall_time(),
             .operators = operators(),
             .histories = outputs().histories()};
    if (context_.keep_fields) r.fields = copied_fields(*model_);
    return r;
  }

  Result conclude() {
    if (!model_->conclude(context_.stop, context_.note)) {
      write_checkpoint();
      return result(RunEnd::stopped);
    }
    outputs().finish(clock_.time());
    Result r = result(RunEnd::decided);
    r.quantities = model_->result(r.time, r.steps, r.wall_time, r.operators);
    const std::vector<std::string> warnings = model_->warnings();
    if (!warnings.empty()) r.quantities["warnings"] = warnings;
    if (!output::undecided_bodies(r.quantities).empty()) {
      r.end = RunEnd::undecided;
      r.later_end = model_->later_end(r.time);
    }
    outputs().report(r.quantities);
    if (archive_) {
      if (r.end == RunEnd::undecided) write_checkpoint();  // from which a later end goes on
      archive_->directory().write_result(r.quantities);
      archive_->directory().forget_earlier();
      if (case_.output.report) output::write_report(archive_->directory().path());
    }
    if (context_.note)
      for (const std::string& warning : warnings) context_.note("warning: " + warning);
    return r;
  }

  const Case& case_;
  const Context& context_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Archive> archive_;
  std::unique_ptr<Outputs> loose_outputs_;  // of a run without files
  Clock clock_;
  Schedule checkpoints_;
  double start_ = 0.0, wall_before_ = 0.0, last_checkpoint_ = 0.0;
  OperatorTime outputs_time_{"outputs", "histories, fields, slices, replay", 0.0, 0},
      checkpoints_time_{"checkpoints", "the state to resume from", 0.0, 0};
};

}  // namespace

Result run(const Case& c, const Context& context) {
  if (c.sorter.enabled)
    throw InputError(fmt::format("{} is a whole sorter", c.path.empty() ? "the case" : c.path),
                     {.expected = "ejecta sort, or a case without [sorter]",
                      .example = fmt::format("ejecta sort {}", c.path)});
  const ThreadBudget budget(context.threads);
  if (context.files) Archive::require_place(*context.files);
  auto model = std::make_unique<CoupledModel>(c, context.note);
  const auto outputs = [&, &m = *model](const OutputPlace& place) {
    return std::make_unique<CoupledOutputs>(c, m, place, context.keep_histories);
  };
  return Run(c, context, std::move(model), outputs).to_end();
}

bool is_jet_case(const Case& c) {
  const auto& patches = c.boundary[4].patches;
  return c.flow.solver == FlowSolver::compressible &&
         std::any_of(patches.begin(), patches.end(),
                     [](const PatchSpec& p) { return p.type == BoundaryType::jet; });
}

JetOrder jet_of(const Case& c) {
  if (c.flow.solver == FlowSolver::compressible || c.jet.source_case.empty()) return {c, kBoxHeight};
  return {computed_jet_case(c), jet_height(c)};
}

Result run_jet(const Case& c, double kept_at, const Context& context) {
  const ThreadBudget budget(context.threads);
  if (context.files) Archive::require_place(*context.files);
  auto model = std::make_unique<RecordedJet>(c, kept_at);
  const auto outputs = [&m = *model](const OutputPlace& place) {
    return std::make_unique<JetOutputs>(m, place);
  };
  return Run(c, context, std::move(model), outputs).to_end();
}

std::optional<Result> finished_run(const Case& c, const std::filesystem::path& directory) {
  std::error_code none;
  if (!std::filesystem::exists(directory / "result.json", none) ||
      !std::filesystem::exists(directory / "case.toml", none) ||
      output::read_file(directory / "case.toml") != input_of(c))
    return std::nullopt;
  Result r;
  try {
    r.quantities = nlohmann::ordered_json::parse(output::read_file(directory / "result.json"));
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;  // cut: the run was ended as it wrote it
  }
  if (!output::undecided_bodies(r.quantities).empty()) r.end = RunEnd::undecided;
  return r;
}

}  // namespace ejecta
