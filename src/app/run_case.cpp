#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "app/air_forecast.hpp"
#include "app/case_changes.hpp"
#include "app/coupled_model.hpp"
#include "app/exit_code.hpp"
#include "app/run_outputs.hpp"
#include "app/run_result.hpp"
#include "app/signals.hpp"
#include "app/simulation.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/output_file.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/verdict.hpp"

namespace ejecta {
namespace {

/// Where a run goes.
std::filesystem::path directory_of(const Case& c, const RunOptions& options) {
  return options.out.empty() ? output::RunDirectory::default_path(c.path)
                             : std::filesystem::path(options.out);
}

void print_verdict(const nlohmann::ordered_json& result, const std::filesystem::path& run) {
  fmt::print("{}\n", output::verdict_sentence(result));
  fmt::print("results: {}\n", (run / "result.json").string());
  if (std::filesystem::exists(run / "report.html"))
    fmt::print("report:  {}\n", (run / "report.html").string());
}

/// The result of a run that came to the end of this very case before.
std::optional<nlohmann::ordered_json> finished_result(const std::filesystem::path& run,
                                                      const std::string& input) {
  std::error_code none;
  if (!std::filesystem::exists(run / "result.json", none) || output::read_file(run / "case.toml") != input)
    return std::nullopt;
  try {
    return nlohmann::ordered_json::parse(output::read_file(run / "result.json"));
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;  // cut: the run was ended as it wrote it
  }
}

/// How often a run looks for NaN, in steps.
constexpr int kCheckInterval = 20;

/// One run: the clock, the model, its observers.
class Run {
 public:
  Run(const Case& c, const RunOptions& options)
      : case_(c),
        options_(options),
        path_(path_of(c, options)),
        model_(c),
        directory_(options.resume ? output::RunDirectory::open(path_)
                                  : output::RunDirectory::create(path_, options.force)),
        store_(directory_.checkpoints()),
        progress_(std::cerr, progress_options()) {
    provenance_ = {.command = command_line_of("run", c, options),
                   .case_path = c.path,
                   .input = write_case(with_absolute_files(c)),
                   .threads = thread_count(),
                   .overrides = options.overrides};
    std::optional<double> resumed;
    if (options.resume) {
      refuse_another_case();
      resumed = find_checkpoint();
    }
    directory_.write_case(provenance_.input);
    if (!options.resume) directory_.write_manifest(output::make_manifest(provenance_));
    outputs_ =
        std::make_unique<RunOutputs>(c, model_, directory_, output::provenance_lines(provenance_), resumed);
    for (double t : model_.events()) clock_.add_event(t);
    clock_.add_event(c.run.end_time);
    outputs_->add_events(clock_, c.run.end_time);
    clock_.add_events_every(c.checkpoint.every_time, 0.0, c.run.end_time);
    // A verdict comes in free flight, which costs nothing: what is left to wait for is the air.
    busy_until_ = std::min(c.run.end_time, air_until(c, company_of(model_.scene())));
    if (resumed) {
      restore();
      directory_.remove_result();
    }
  }

  int advance_to_end() {
    SignalWatch signals;
    const double start = wall_seconds() - wall_before_;
    double last_checkpoint = wall_seconds();
    progress_.note(start_line());
    if (clock_.step() == 0) observe();
    while (!finished()) {
      const double dt = clock_.land_on_events(model_.stable_dt(clock_.time()));
      model_.advance(clock_.time(), dt);
      clock_.tick(dt);
      if (clock_.step() % kCheckInterval == 0) model_.require_finite(clock_.time());
      observe();
      progress_.update(progress_state(dt));
      wall_ = wall_seconds() - start;
      const bool stop = signals.stop_requested();
      if (stop || signals.take_checkpoint_request() || checkpoint_due(last_checkpoint)) {
        write_checkpoint();
        last_checkpoint = wall_seconds();
      }
      if (stop) {
        progress_.finish(progress_state(dt), "stopped");
        progress_.note(fmt::format("continue with\n  {} --resume", command()));
        return exit_stopped;
      }
    }
    model_.require_finite(clock_.time());
    outputs_->finish(clock_.time());
    progress_.finish(progress_state(0.0), "done");
    return conclude();
  }

  /// Leaves the reason in progress.json, if that can still be written.
  void give_up(const std::string& state) {
    try {
      progress_.finish(progress_state(0.0), state);
    } catch (const Error&) {
    }
  }

 private:
  /// Refuses at once a place where the run could not be kept: its model may take minutes to build.
  static std::filesystem::path path_of(const Case& c, const RunOptions& options) {
    const auto path = directory_of(c, options);
    if (options.resume) output::RunDirectory::open(path);
    else output::RunDirectory::require_creatable(path, options.force);
    return path;
  }
  output::ProgressOptions progress_options() const {
    auto p = output::progress_options_of_terminal(options_.quiet     ? output::Verbosity::quiet
                                                  : options_.verbose ? output::Verbosity::verbose
                                                                     : output::Verbosity::normal);
    p.file = directory_.progress();
    return p;
  }
  output::ProgressState progress_state(double dt) const {
    return {clock_.time(),    std::max(busy_until_, clock_.time()),    clock_.step(), dt,
            model_.courant(), model_.air() ? model_.grid().cells() : 0};
  }
  bool finished() const { return clock_.time() >= case_.run.end_time * (1.0 - 1e-12) || model_.finished(); }

  std::string start_line() const {
    const auto bodies = model_.particles().bodies().size();
    return fmt::format("{}: {} cells, {} bod{}, {} thread{} -> {}{}", case_.path,
                       model_.flow() ? model_.grid().cells() : 0, bodies, bodies == 1 ? "y" : "ies",
                       thread_count(), thread_count() == 1 ? "" : "s", path_.string(),
                       clock_.step() > 0 ? fmt::format(", from t = {:.3f} ms", 1e3 * clock_.time()) : "");
  }

  void observe() {
    const ScopedTimer timer(outputs_time_.seconds);
    outputs_->observe(clock_.time(), clock_.step());
    ++outputs_time_.calls;
  }

  std::vector<output::OperatorTime> operator_times() const {
    std::vector<output::OperatorTime> all = model_.operator_times();
    all.push_back(outputs_time_);
    if (checkpoints_time_.calls > 0) all.push_back(checkpoints_time_);
    return all;
  }

  bool checkpoint_due(double last) const {
    const CheckpointSpec& spec = case_.checkpoint;
    if (spec.every_steps > 0 && clock_.step() % spec.every_steps == 0) return true;
    if (spec.every_wall_time > 0.0 && wall_seconds() - last >= spec.every_wall_time) return true;
    const double n = spec.every_time > 0.0 ? clock_.time() / spec.every_time : 0.5;
    return std::abs(n - std::round(n)) < 1e-9 && n > 0.5;
  }

  void write_checkpoint() {
    const ScopedTimer timer(checkpoints_time_.seconds);
    ++checkpoints_time_.calls;
    model_.require_finite(clock_.time());
    output::CheckpointWriter w = store_.begin({clock_.time(), clock_.step()});
    const auto fields = model_.state_fields();
    for (std::size_t f = 0; f < fields.size(); ++f)
      w.put(fmt::format("flow/field_{:02}", f), std::span<const Real>(fields[f]->data(), fields[f]->size()));
    const auto numbers = model_.state_numbers();
    for (std::size_t n = 0; n < numbers.size(); ++n)
      w.put(fmt::format("model/numbers_{}", n), std::span<const double>(numbers[n]));
    w.put("outputs", std::span<const double>(outputs_->state()));
    w.put("wall_time", std::span<const double>(&wall_, 1));
    store_.commit(w);
  }

  void refuse_another_case() const {
    const std::vector<std::string> changed =
        changed_keys(output::read_file(path_ / "case.toml"), provenance_.input);
    if (changed.empty()) return;
    throw InputError(fmt::format(
        "{} was started with another case: {} changed\n  go on as it was:  ejecta run {} --out {} --resume\n"
        "  start anew:       {} --force",
        path_.string(), joined(changed), (path_ / "case.toml").string(), path_.string(), command()));
  }

  std::optional<double> find_checkpoint() {
    auto newest = store_.newest();
    for (const std::string& damage : newest.damaged) fmt::print(stderr, "warning: {}\n", damage);
    if (!newest.reader)
      throw InputError(
          fmt::format("{} holds no checkpoint to resume from; start anew with --force", path_.string()));
    reader_.emplace(std::move(*newest.reader));
    return reader_->at().time;
  }

  /// A sealed checkpoint that does not fit is one of another version of the program.
  void restore() {
    try {
      read_checkpoint();
    } catch (const Error& e) {
      throw InputError(fmt::format("{} cannot be resumed: {}\n  start anew:  {} --force", path_.string(),
                                   e.what(), command()));
    }
    reader_.reset();
  }

  void read_checkpoint() {
    const auto fields = model_.state_fields();
    for (std::size_t f = 0; f < fields.size(); ++f)
      reader_->get(fmt::format("flow/field_{:02}", f), std::span<Real>(fields[f]->data(), fields[f]->size()));
    std::vector<std::vector<double>> numbers;
    for (int n = 0; reader_->has(fmt::format("model/numbers_{}", n)); ++n)
      numbers.push_back(reader_->numbers(fmt::format("model/numbers_{}", n)));
    model_.restore_numbers(numbers, reader_->at().time);
    outputs_->restore(reader_->numbers("outputs"));
    reader_->get("wall_time", std::span<double>(&wall_before_, 1));
    clock_.restore(reader_->at().time, reader_->at().step);
  }

  /// Writes and prints the result. Returns an ExitCode: done only if every body has its verdict.
  int conclude() {
    nlohmann::ordered_json result =
        make_result(model_, clock_.time(), clock_.step(), wall_, operator_times());
    outputs_->report(result);
    const bool decided = output::undecided_bodies(result).empty();
    if (!decided) write_checkpoint();  // from which a later end goes on
    directory_.write_result(result);
    for (const std::string& dent : model_.particles().deep_dents()) fmt::print(stderr, "warning: {}\n", dent);
    if (case_.output.report) output::write_report(path_);
    if (!options_.quiet) {
      if (options_.verbose || model_.flow())
        fmt::print("{}\n", output::operator_table(operator_times(), wall_));
      print_verdict(result, path_);
    }
    if (decided) return exit_done;
    if (const auto later = later_end()) {
      RunOptions o = options_;
      o.overrides.push_back(fmt::format("run.end_time={:.0f} ms", 1e3 * *later));
      progress_.note(fmt::format("go on with\n  {} --resume", command(o)));
    }
    return exit_undecided;
  }

  /// When the last undecided body that flies on should have come to the plate, with half as much again, s.
  std::optional<double> later_end() const {
    double latest = 0.0;
    const auto bodies = model_.particles().bodies();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!model_.splitter()->judges(b) || model_.splitter()->verdict(b)) continue;
      const double way = model_.splitter()->edge().x() - bodies[b].position.x();
      if (bodies[b].velocity.x() > 0.0) latest = std::max(latest, way / bodies[b].velocity.x());
    }
    if (!(latest > 0.0) || latest > 100.0) return std::nullopt;
    return std::ceil(1e3 * (clock_.time() + 1.5 * latest)) * 1e-3;
  }

  /// What the user typed, with the place of the run: the same with --resume goes on.
  std::string command() const { return command(options_); }
  std::string command(RunOptions o) const {
    o.out = path_.string();
    return command_line_of("run", case_, o);
  }

  const Case& case_;
  RunOptions options_;
  std::filesystem::path path_;
  CoupledModel model_;  // before the directory: a case that cannot start must not have cleared a finished run
  output::RunDirectory directory_;
  output::CheckpointStore store_;
  output::Progress progress_;
  output::Provenance provenance_;
  std::unique_ptr<RunOutputs> outputs_;
  std::optional<output::CheckpointReader> reader_;
  Clock clock_;
  double wall_ = 0.0, wall_before_ = 0.0, busy_until_ = 0.0;
  output::OperatorTime outputs_time_{"outputs", "histories, fields, slices, replay", 0.0, 0},
      checkpoints_time_{"checkpoints", "the state to resume from", 0.0, 0};
};

void print_step(CoupledModel& model) {
  fmt::print("One step of {}:\n", model.config().path);
  int n = 0;
  for (const auto& op : model.operator_times()) fmt::print("  {:2}. {:<26} {}\n", ++n, op.name, op.equation);
}

}  // namespace

int run_case(const Case& c, const RunOptions& options) {
  if (options.threads > 0) set_thread_count(options.threads);
  if (options.dry_run) {
    CoupledModel model(c);
    if (!options.quiet) print_step(model);
    return exit_done;
  }
  if (options.resume)
    if (const auto path = directory_of(c, options); std::filesystem::exists(path / "case.toml"))
      if (const auto result = finished_result(path, write_case(with_absolute_files(c)))) {
        if (!options.quiet) {
          fmt::print("{} is finished: nothing to compute\n", path.string());
          print_verdict(*result, path);
        }
        return output::undecided_bodies(*result).empty() ? exit_done : exit_undecided;
      }
  Run run(c, options);
  try {
    return run.advance_to_end();
  } catch (const DivergedError&) {
    run.give_up("diverged");
    throw;
  } catch (...) {
    run.give_up("failed");
    throw;
  }
}

int plan_case(const Case& c) {
  CoupledModel model(c);
  print_step(model);
  return exit_done;
}

}  // namespace ejecta
