#include "output/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>
#include <utility>

#include "output/output_file.hpp"

namespace ejecta::output {
namespace {

constexpr double kBarInterval = 0.1, kFileInterval = 1.0, kSampleInterval = 1.0;  // s of wall time
constexpr double kNewestShare = 0.3;  // of the newest sample in the mean of late
constexpr std::string_view kClearLine = "\r\x1b[K";

double fraction(const ProgressState& s) {
  return s.end_time > 0.0 ? std::clamp(s.time / s.end_time, 0.0, 1.0) : 0.0;
}

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ProgressOptions progress_options_of_terminal(Verbosity verbosity) {
  ProgressOptions o;
  o.verbosity = verbosity;
  const char* term = std::getenv("TERM");
  o.terminal = ::isatty(STDERR_FILENO) == 1 && term && std::string_view(term) != "dumb";
  const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org: any non-empty value
  o.colour = o.terminal && !(no_color && *no_color);
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) o.width = size.ws_col;
  return o;
}

Progress::Progress(std::ostream& out, ProgressOptions options) : out_(out), options_(std::move(options)) {
  start_ = now();
}

double Progress::now() const { return options_.wall_clock ? options_.wall_clock() : steady_seconds(); }

void Progress::measure(const ProgressState& s, double wall) {
  const double span = wall - sample_.wall;
  if (span < kSampleInterval) return;
  const double share = steps_per_wall_ > 0.0 ? kNewestShare : 1.0;
  time_per_wall_ += share * ((s.time - sample_.time) / span - time_per_wall_);
  steps_per_wall_ += share * (static_cast<double>(s.step - sample_.step) / span - steps_per_wall_);
  sample_ = {wall, s.time, s.step};
}

double Progress::eta(const ProgressState& s) const {
  return time_per_wall_ > 0.0 ? std::max(0.0, s.end_time - s.time) / time_per_wall_ : INFINITY;
}

std::string Progress::status(const ProgressState& s) const {
  const double left = eta(s);
  return fmt::format("{:3.0f} %  t {:.3f}/{:.3f} ms  step {}  Co {:.2f}  {:.1f} Mcell/s  {}",
                     100.0 * fraction(s), 1e3 * s.time, 1e3 * s.end_time, s.step, s.courant,
                     1e-6 * steps_per_wall_ * static_cast<double>(s.cells),
                     std::isfinite(left) && left > 0.0 ? duration_text(left) + " left" : "");
}

void Progress::draw_bar(const ProgressState& s) {
  const std::string text = status(s);
  const int room = std::min(options_.width - static_cast<int>(text.size()) - 4, 40);
  std::string bar;
  if (room >= 8) {
    const int filled = static_cast<int>(fraction(s) * room);
    for (int n = 0; n < room; ++n) bar += n < filled ? "\u2588" : "\u2591";
    if (options_.colour) bar = "\x1b[36m" + bar + "\x1b[0m";
    bar += ' ';
  }
  out_ << kClearLine << bar << text.substr(0, static_cast<std::size_t>(std::max(options_.width - 1, 10)))
       << std::flush;
  bar_shown_ = true;
}

void Progress::update(const ProgressState& s) {
  const double t = now();
  if (!started_) {
    sample_ = {t, s.time, s.step};
    if (!options_.terminal) last_shown_ = t;  // a line of the first step says nothing yet
    started_ = true;
  }
  measure(s, t);
  if (!options_.file.empty() && t - last_written_ >= kFileInterval) {
    write_file(s, "running");
    last_written_ = t;
  }
  if (options_.verbosity == Verbosity::quiet) return;
  const bool every_step = options_.verbosity == Verbosity::verbose;
  const double interval = every_step ? 0.0 : options_.terminal ? kBarInterval : options_.line_interval;
  if (t - last_shown_ < interval) return;
  last_shown_ = t;
  if (options_.terminal && !every_step) draw_bar(s);
  else out_ << status(s) << std::endl;
}

void Progress::finish(const ProgressState& last, const std::string& state) {
  if (!options_.file.empty()) write_file(last, state);
  if (options_.verbosity == Verbosity::quiet) return;
  if (bar_shown_) out_ << kClearLine;
  bar_shown_ = false;
  out_ << fmt::format("{} at t = {:.3f} ms after {} steps, {}\n", state, 1e3 * last.time, last.step,
                      duration_text(now() - start_))
       << std::flush;
}

void Progress::note(const std::string& line) {
  if (options_.verbosity == Verbosity::quiet) return;
  if (bar_shown_) out_ << kClearLine;
  bar_shown_ = false;
  out_ << line << std::endl;
}

void Progress::write_file(const ProgressState& s, const std::string& state) const {
  nlohmann::ordered_json json{{"state", state},
                              {"time_s", s.time},
                              {"end_time_s", s.end_time},
                              {"fraction", fraction(s)},
                              {"step", s.step},
                              {"time_step_s", s.dt},
                              {"courant", s.courant},
                              {"cells", s.cells},
                              {"cell_steps_per_s", steps_per_wall_ * static_cast<double>(s.cells)},
                              {"wall_time_s", now() - start_},
                              {"process", options_.alone ? ::getpid() : 0}};
  const double left = eta(s);
  json["eta_s"] = std::isfinite(left) ? nlohmann::ordered_json(left) : nlohmann::ordered_json(nullptr);
  output::write_file(options_.file, json.dump(2) + '\n');
}

std::string operator_table(std::span<const OperatorTime> operators, double wall_time) {
  std::size_t width = 8;
  double accounted = 0.0;
  for (const OperatorTime& o : operators) {
    width = std::max(width, o.name.size());
    accounted += o.seconds;
  }
  const auto row = [&](const std::string& name, double seconds, const std::string& calls) {
    return fmt::format("{:<{}} {:>10.3f} {:>7.1f} {:>9}\n", name, width, seconds,
                       wall_time > 0.0 ? 100.0 * seconds / wall_time : 0.0, calls);
  };
  std::string table = fmt::format("{:<{}} {:>10} {:>7} {:>9}\n", "operator", width, "seconds", "%", "calls");
  for (const OperatorTime& o : operators) table += row(o.name, o.seconds, std::to_string(o.calls));
  table += row("the rest", std::max(0.0, wall_time - accounted), "");
  return table + row("all", wall_time, "");
}

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::lround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace ejecta::output
