#include "signals.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <thread>

namespace diaphane::cli {
namespace {

// A signal is the process's, not an object's.
std::atomic<int> caught_signal = 0;

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

}  // namespace

std::stop_token stop_on_signals() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::stop_source source;
  const std::stop_token token = source.get_token();
  std::thread([source = std::move(source), signals]() mutable {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
    caught_signal = signal;
    source.request_stop();
    if (sigwait(&signals, &signal) == 0) _exit(128 + signal);
  }).detach();
  return token;
}

void end_by_caught_signal() {
  const int number = caught_signal;
  if (number == 0) return;
  signal(number, SIG_DFL);
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  raise(number);
}

}  // namespace diaphane::cli
