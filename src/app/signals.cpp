#include "app/signals.hpp"

#include <csignal>
#include <memory>

namespace ejecta {
namespace {

volatile std::sig_atomic_t stop = 0, checkpoint = 0;

void on_stop(int) { stop = 1; }
void on_checkpoint(int) { checkpoint = 1; }

}  // namespace

SignalWatch::SignalWatch() {
  stop = checkpoint = 0;
  std::signal(SIGTERM, on_stop);
  std::signal(SIGINT, on_stop);
  std::signal(SIGUSR1, on_checkpoint);
}

SignalWatch::~SignalWatch() {
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGUSR1, SIG_DFL);
}

bool SignalWatch::stop_requested() const { return stop != 0; }

std::function<bool()> stop_on_signal() {
  return [watch = std::shared_ptr<SignalWatch>()]() mutable {
    if (!watch) watch = std::make_shared<SignalWatch>();
    return watch->stop_requested();
  };
}

bool SignalWatch::take_checkpoint_request() {
  const bool wanted = checkpoint != 0;
  checkpoint = 0;
  return wanted;
}

}  // namespace ejecta
