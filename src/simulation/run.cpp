#include "simulation/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/thread_budget.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/checkpoint.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/verdict.hpp"
#include "simulation/air_forecast.hpp"
#include "simulation/case_changes.hpp"
#include "simulation/run_outputs.hpp"
#include "simulation/run_result.hpp"

namespace ejecta {
namespace {

/// How often a run looks for NaN, in steps.
constexpr int kCheckInterval = 20;

/// The case as a run keeps it: what it needs from elsewhere by absolute paths.
std::string input_of(const Case& c) { return write_case(with_absolute_files(c)); }

/// The files of a run: its directory, its outputs, its checkpoints.
class Archive {
 public:
  Archive(const Case& c, CoupledModel& model, const RunFiles& files, const Note& note)
      : files_(files),
        directory_(files.resume ? output::RunDirectory::open(files.directory)
                                : output::RunDirectory::create(files.directory, files.overwrite)),
        store_(directory_.checkpoints()) {
    const output::Provenance provenance{.command = files.command,
                                        .case_path = c.path,
                                        .input = input_of(c),
                                        .threads = thread_count(),
                                        .overrides = files.overrides,
                                        .files = files_of(c)};
    std::optional<double> resumed;
    if (files.resume) {
      refuse_another_case(provenance.input);
      refuse_changed_files(provenance.files);
      resumed = find_checkpoint(note);
      restore_model(model);  // before anything is cut off what the run has written
    }
    directory_.write_case(provenance.input);
    if (!files.resume) directory_.write_manifest(output::make_manifest(provenance));
    outputs_ =
        std::make_unique<RunOutputs>(c, model, directory_, output::provenance_lines(provenance), resumed);
  }

  /// Refuses at once a place where the run could not be kept: its model may take minutes to build.
  static void require_place(const RunFiles& files) {
    if (files.resume) output::RunDirectory::open(files.directory);
    else output::RunDirectory::require_creatable(files.directory, files.overwrite);
  }

  RunOutputs& outputs() { return *outputs_; }
  const output::RunDirectory& directory() const { return directory_; }

  void write_checkpoint(CoupledModel& model, const Clock& clock, double wall) const {
    output::CheckpointWriter w = store_.begin({clock.time(), clock.step()});
    const auto fields = model.state_fields();
    for (std::size_t f = 0; f < fields.size(); ++f)
      w.put(fmt::format("flow/field_{:02}", f), std::span<const Real>(fields[f]->data(), fields[f]->size()));
    const auto numbers = model.state_numbers();
    for (std::size_t n = 0; n < numbers.size(); ++n)
      w.put(fmt::format("model/numbers_{}", n), std::span<const double>(numbers[n]));
    w.put("outputs", std::span<const double>(outputs_->state()));
    w.put("wall_time", std::span<const double>(&wall, 1));
    store_.commit(w);
  }

  /// After the model: what the outputs and the clock knew.
  void restore(Clock& clock, double& wall) {
    outputs_->restore(reader_->numbers("outputs"));
    reader_->get("wall_time", std::span<double>(&wall, 1));
    clock.restore(reader_->at().time, reader_->at().step);
    reader_.reset();
    directory_.remove_result();
  }

 private:
  void refuse_another_case(const std::string& input) const {
    const std::string path = files_.directory.string();
    const std::vector<std::string> changed =
        changed_keys(output::read_file(files_.directory / "case.toml"), input);
    if (changed.empty()) return;
    throw InputError(fmt::format(
        "{} was started with another case: {} changed\n  go on as it was:  ejecta run {} --out {} --resume\n"
        "  start anew:       {} --force",
        path, joined(changed), (files_.directory / "case.toml").string(), path, files_.here));
  }

  /// Meshes and traces are not copied into the run: one that has changed since would go on as another.
  void refuse_changed_files(const std::vector<std::string>& files) const {
    const auto manifest =
        nlohmann::json::parse(output::read_file(files_.directory / "manifest.json"), nullptr, false);
    if (!manifest.is_object() || !manifest.contains("files")) return;
    const auto& before = manifest["files"];
    const auto now = output::digests_of(files);
    for (const auto& [file, digest] : now.items())
      if (before.contains(file) && before[file] != digest)
        throw InputError(fmt::format("{} has changed since {} was started\n  start anew:  {} --force", file,
                                     files_.directory.string(), files_.here));
  }

  std::optional<double> find_checkpoint(const Note& note) {
    auto newest = store_.newest();
    for (const std::string& damage : newest.damaged)
      if (note) note("warning: " + damage);
    if (!newest.reader)
      throw InputError(fmt::format("{} holds no checkpoint to resume from; start anew with --force",
                                   files_.directory.string()));
    reader_.emplace(std::move(*newest.reader));
    return reader_->at().time;
  }

  /// A sealed checkpoint that does not fit is one of another version of the program.
  void restore_model(CoupledModel& model) const {
    try {
      const auto fields = model.state_fields();
      for (std::size_t f = 0; f < fields.size(); ++f)
        reader_->get(fmt::format("flow/field_{:02}", f),
                     std::span<Real>(fields[f]->data(), fields[f]->size()));
      std::vector<std::vector<double>> numbers;
      for (int n = 0; reader_->has(fmt::format("model/numbers_{}", n)); ++n)
        numbers.push_back(reader_->numbers(fmt::format("model/numbers_{}", n)));
      model.restore_numbers(numbers, reader_->at().time);
    } catch (const Error& e) {
      throw InputError(fmt::format("{} cannot be resumed: {}\n  start anew:  {} --force",
                                   files_.directory.string(), e.what(), files_.here));
    }
  }

  RunFiles files_;
  output::RunDirectory directory_;
  output::CheckpointStore store_;
  std::unique_ptr<RunOutputs> outputs_;
  std::optional<output::CheckpointReader> reader_;
};

/// One run: the clock, the model, its observers.
class Run {
 public:
  Run(const Case& c, const Context& context) : case_(c), context_(context) {
    if (context.files) Archive::require_place(*context.files);
    // Before the directory: a case that cannot start must not have cleared a finished run.
    model_ = std::make_unique<CoupledModel>(c, context.note);
    if (context.files) archive_ = std::make_unique<Archive>(c, *model_, *context.files, context.note);
    for (double t : model_->events()) clock_.add_event(t);
    clock_.add_event(c.run.end_time);
    if (archive_) archive_->outputs().add_events(clock_, c.run.end_time);
    clock_.add_events_every(c.checkpoint.every_time, 0.0, c.run.end_time);
    // A verdict comes in free flight, which costs nothing: what is left to wait for is the air.
    busy_until_ = std::min(c.run.end_time, air_until(c, company_of(model_->scene())));
    if (archive_ && context.files->resume) archive_->restore(clock_, wall_before_);
  }

  Result advance_to_end() {
    const double start = wall_seconds() - wall_before_;
    double last_checkpoint = wall_seconds();
    if (clock_.step() == 0) write_outputs();
    observe(0.0);
    while (!finished()) {
      const double dt = clock_.land_on_events(model_->stable_dt(clock_.time()));
      model_->advance(clock_.time(), dt);
      clock_.tick(dt);
      if (clock_.step() % kCheckInterval == 0) model_->require_finite(clock_.time());
      write_outputs();
      observe(dt);
      wall_ = wall_seconds() - start;
      const bool stop = context_.stop && context_.stop();
      if (stop || (context_.keep && context_.keep()) || checkpoint_due(last_checkpoint)) {
        write_checkpoint();
        last_checkpoint = wall_seconds();
      }
      if (stop) return result(RunEnd::stopped);
    }
    model_->require_finite(clock_.time());
    if (archive_) archive_->outputs().finish(clock_.time());
    return conclude();
  }

 private:
  bool finished() const { return clock_.time() >= case_.run.end_time * (1.0 - 1e-12) || model_->finished(); }

  void observe(double dt) const {
    if (context_.observe)
      context_.observe({*model_, clock_.time(), clock_.step(), dt, std::max(busy_until_, clock_.time())});
  }

  void write_outputs() {
    if (!archive_) return;
    const ScopedTimer timer(outputs_time_.seconds);
    archive_->outputs().observe(clock_.time(), clock_.step());
    ++outputs_time_.calls;
  }

  bool checkpoint_due(double last) const {
    const CheckpointSpec& spec = case_.checkpoint;
    if (spec.every_steps > 0 && clock_.step() % spec.every_steps == 0) return true;
    if (spec.every_wall_time > 0.0 && wall_seconds() - last >= spec.every_wall_time) return true;
    const double n = spec.every_time > 0.0 ? clock_.time() / spec.every_time : 0.5;
    return std::abs(n - std::round(n)) < 1e-9 && n > 0.5;
  }

  void write_checkpoint() {
    if (!archive_) return;
    const ScopedTimer timer(checkpoints_time_.seconds);
    ++checkpoints_time_.calls;
    model_->require_finite(clock_.time());
    archive_->write_checkpoint(*model_, clock_, wall_);
  }

  std::vector<OperatorTime> operators() const {
    std::vector<OperatorTime> all = model_->operator_times();
    all.push_back(outputs_time_);
    if (checkpoints_time_.calls > 0) all.push_back(checkpoints_time_);
    return all;
  }

  Result result(RunEnd end) const {
    return {.end = end,
            .time = clock_.time(),
            .steps = clock_.step(),
            .wall_time = wall_,
            .operators = operators()};
  }

  Result conclude() {
    Result r = result(RunEnd::decided);
    r.quantities = make_result(*model_, clock_.time(), clock_.step(), wall_, r.operators);
    if (!output::undecided_bodies(r.quantities).empty()) {
      r.end = RunEnd::undecided;
      r.later_end = later_end();
    }
    if (archive_) {
      archive_->outputs().report(r.quantities);
      if (r.end == RunEnd::undecided) write_checkpoint();  // from which a later end goes on
      archive_->directory().write_result(r.quantities);
      if (case_.output.report) output::write_report(archive_->directory().path());
    }
    if (context_.note)
      for (const std::string& dent : model_->particles().deep_dents()) context_.note("warning: " + dent);
    return r;
  }

  /// When the last undecided body that flies on should have come to the plate, with half as much again, s.
  std::optional<double> later_end() const {
    double latest = 0.0;
    const auto bodies = model_->particles().bodies();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!model_->splitter()->judges(b) || model_->splitter()->verdict(b)) continue;
      const double way = model_->splitter()->edge().x() - bodies[b].position.x();
      if (bodies[b].velocity.x() > 0.0) latest = std::max(latest, way / bodies[b].velocity.x());
    }
    if (!(latest > 0.0) || latest > 100.0) return std::nullopt;
    return std::ceil(1e3 * (clock_.time() + 1.5 * latest)) * 1e-3;
  }

  const Case& case_;
  const Context& context_;
  std::unique_ptr<CoupledModel> model_;
  std::unique_ptr<Archive> archive_;
  Clock clock_;
  double wall_ = 0.0, wall_before_ = 0.0, busy_until_ = 0.0;
  OperatorTime outputs_time_{"outputs", "histories, fields, slices, replay", 0.0, 0},
      checkpoints_time_{"checkpoints", "the state to resume from", 0.0, 0};
};

}  // namespace

Result run(const Case& c, const Context& context) {
  const ThreadBudget budget(context.threads);
  return Run(c, context).advance_to_end();
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
