#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace ejecta {

inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// By the clock that files and other machines go by, s.
inline double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Adds the time of its scope to `total`, s.
class ScopedTimer {
 public:
  explicit ScopedTimer(double& total) : total_(total), start_(wall_seconds()) {}
  ~ScopedTimer() { total_ += wall_seconds() - start_; }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& total_;
  double start_;
};

/// One row of the closing table: result.json key "operators".
struct OperatorTime {
  std::string name;
  std::string equation;
  double seconds = 0.0;
  std::int64_t calls = 0;
};

}  // namespace ejecta
