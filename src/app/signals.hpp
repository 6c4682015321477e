#pragma once

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

}  // namespace ejecta
