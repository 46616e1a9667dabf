#include "io/program/signals.h"

#include <csignal>

namespace molten {

namespace {
volatile std::sig_atomic_t requested = 0;

void on_limit(int) { requested = 1; }

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
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup wants it to go on
  action.sa_handler = on_limit;
  sigaction(SIGXCPU, &action, nullptr);
}

void let_writes_fail() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool stop_requested() { return requested != 0; }

}  // namespace molten
