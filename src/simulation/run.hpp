#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/real.hpp"
#include "base/text.hpp"
#include "case/case.hpp"
#include "output/history.hpp"
#include "simulation/model.hpp"

/// One run of a case: plain data in, plain data out. No terminal, no signals, nothing global: a program may
/// run as many as it likes side by side, each with the bits that it has alone.
namespace ejecta {

/// A run between two steps.
struct Moment {
  const Model& model;
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  double dt = 0.0;          ///< s, of the step that was taken; 0 before the first
  double busy_until = 0.0;  ///< s: what comes later is free flight, which costs nothing
};

/// Where the files of a run go (docs/files.md).
struct RunFiles {
  std::filesystem::path directory;
  bool overwrite = false;                ///< a run that is there
  bool resume = false;                   ///< go on from its last good checkpoint
  std::string command;                   ///< what the user typed, for the manifest
  std::string here;                      ///< the same with this directory named, for advice
  std::vector<std::string> overrides{};  ///< what it changes in the case, "section.key=value"
};

/// What a run may use and whom it tells. None of it changes a bit of the result.
struct Context {
  std::optional<RunFiles> files{};               ///< none: nothing is written
  int threads = 0;                               ///< 0: as many as the calling thread has
  std::function<void(const Moment&)> observe{};  ///< before the first step and after each
  std::function<bool()> stop{};                  ///< true ends the run, with a checkpoint
  std::function<bool()> keep{};                  ///< true: write a checkpoint now
  Note note{};                                   ///< is told what takes long or was passed over
  bool keep_histories = true;                    ///< in the Result, where there are no files
  bool keep_fields = false;                      ///< in the Result: those of the last moment
};

enum class RunEnd {
  decided,    ///< at its end; every body that was to be judged has its verdict
  undecided,  ///< at its end, before that
  stopped     ///< before its end; Context::files: can be resumed
};

/// A field at the centres of the cells; its components lie together, then x runs fastest, then y, then z.
struct ResultField {
  std::string name, unit;
  int components = 1;
  std::vector<Real> values;
};
/// The air at one moment.
struct ResultFields {
  std::array<std::vector<double>, 3> faces{};  ///< m, of the cells along each axis
  std::vector<ResultField> fields{};
};

struct Result {
  RunEnd end = RunEnd::decided;
  double time = 0.0;  ///< s, simulated
  std::int64_t steps = 0;
  double wall_time = 0.0;                 ///< s, of all its parts
  nlohmann::ordered_json quantities{};    ///< result.json (docs/files.md); none where it was stopped
  std::vector<OperatorTime> operators{};  ///< of the step, and what else took time
  std::optional<double> later_end{};      ///< s: run.end_time with which an undecided one should be decided
  output::NamedHistories histories{};     ///< of a run without files; one with files has them there
  std::optional<ResultFields> fields{};   ///< where Context::keep_fields, of a case with a flow
};

/// Runs the case to its end or until it is stopped. Throws InputError where the case or the directory does
/// not allow it (an earlier run there is then as it was), DivergedError with the place and time.
Result run(const Case& c, const Context& context = {});

/// A case whose orifice drives a compressible flow is one of run_jet().
bool is_jet_case(const Case& c);
/// The jet that a case stands for: of a box that is fed with a computed one, the case that computes it.
struct JetOrder {
  Case jet;
  double kept_at = 0.0;  ///< m above the orifice
};
JetOrder jet_of(const Case& c);
/// Computes the jet of a case from its nozzle, with everything that is recorded of it, and stores it as it
/// crosses the plane `kept_at`, m above the orifice. Throws as run().
Result run_jet(const Case& c, double kept_at, const Context& context = {});

/// Of a run of this very case that came to its end in that directory; nothing where there is none.
std::optional<Result> finished_run(const Case& c, const std::filesystem::path& directory);

}  // namespace ejecta
