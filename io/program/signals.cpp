#include "io/program/signals.h"

#include <csignal>

namespace molten {

namespace {
volatile std::sig_atomic_t requested = 0;

void on_signal(int number) {
  if (requested) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  requested = 1;
}
}  // namespace

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART | SA_NODEFER;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return requested != 0; }

}  // namespace molten
