#pragma once
#include <functional>

namespace ejecta {

/// SIGTERM and SIGINT ask the run to write a checkpoint and stop, SIGUSR1 to write one and go on.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;
  bool stop_requested() const;
  /// True once for every SIGUSR1.
  bool take_checkpoint_request();
};

/// Whether a signal has asked to stop. Until it is first called a signal ends the program at once.
std::function<bool()> stop_on_signal();

}  // namespace ejecta
