#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>

#include "base/stopwatch.hpp"

namespace ejecta::output {

enum class Verbosity { quiet, normal, verbose };

struct ProgressOptions {
  Verbosity verbosity = Verbosity::normal;
  bool terminal = false;  ///< a bar that redraws itself; otherwise lines
  bool colour = false;
  int width = 100;             ///< columns of the terminal
  double line_interval = 5.0;  ///< s of wall time between lines where there is no terminal
  std::filesystem::path file;  ///< progress.json; empty: none
  bool alone = true;  ///< in its process, which may be asked to end; else progress.json does not name it
  std::function<double()> wall_clock = {};  ///< s; empty: the steady clock
};

/// Fills terminal, colour (NO_COLOR, TERM=dumb) and width from the environment of standard error.
ProgressOptions progress_options_of_terminal(Verbosity verbosity);

struct ProgressState {
  double time = 0.0;      ///< s, simulated
  double end_time = 0.0;  ///< s
  std::int64_t step = 0;
  double dt = 0.0;  ///< s
  double courant = 0.0;
  std::int64_t cells = 0;
};

/// Tells how far a run is: a bar on a terminal (ten times a second), else a line every few seconds, when
/// verbose a line every step; and progress.json every second, {"state", "time_s", "end_time_s", "step",
/// "courant", "cell_steps_per_s", "wall_time_s", "eta_s"}. Cheap to call every step.
class Progress {
 public:
  Progress(std::ostream& out, ProgressOptions options);
  void update(const ProgressState& state);
  /// Ends the bar; `state` is "done", "stopped", "diverged" or "failed" and goes to progress.json.
  void finish(const ProgressState& last, const std::string& state);
  /// A line of its own that does not disturb the bar; not when quiet.
  void note(const std::string& line);

 private:
  double now() const;
  std::string status(const ProgressState& s) const;
  void draw_bar(const ProgressState& s);
  void write_file(const ProgressState& s, const std::string& state) const;
  void measure(const ProgressState& s, double wall);
  double eta(const ProgressState& s) const;

  std::ostream& out_;
  ProgressOptions options_;
  double start_ = 0.0, last_shown_ = -1e30, last_written_ = -1e30;
  bool started_ = false, bar_shown_ = false;
  // Of late: the first steps of a run and a flight without air are no measure of each other.
  struct Sample {
    double wall = 0.0, time = 0.0;
    std::int64_t step = 0;
  } sample_;
  double time_per_wall_ = 0.0, steps_per_wall_ = 0.0;
};

/// The table that ends a run: operator, seconds, share of `wall_time` (s), calls; the rest is one more row.
std::string operator_table(std::span<const OperatorTime> operators, double wall_time);

/// "3.2 s", "4 min 10 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace ejecta::output
