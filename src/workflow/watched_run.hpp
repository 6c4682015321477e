#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

#include "output/progress.hpp"
#include "simulation/run.hpp"

namespace ejecta {

/// Computes a case: `run`, or `run_jet` of its jet.
using RunOfCase = std::function<Result(const Case&, const Context&)>;

/// A run with its progress on a stream and in progress.json of its directory.
class WatchedRun {
 public:
  WatchedRun(const Case& c, std::ostream& out, const output::ProgressOptions& options);
  /// Computes it; what `context` observes is observed too. On an error progress.json says so, which is thrown
  /// on.
  Result compute(const RunOfCase& run, Context context);
  /// A line that does not disturb the progress.
  void note(const std::string& line);

 private:
  void observe(const Moment& m, const std::filesystem::path& directory);
  void finish(const std::string& state);
  void give_up(const std::string& state);

  const Case& case_;
  std::ostream& out_;
  output::ProgressOptions options_;
  std::optional<output::Progress> progress_;
  output::ProgressState last_;
};

}  // namespace ejecta
