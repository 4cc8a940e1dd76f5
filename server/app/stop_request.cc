#include "app/stop_request.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>

namespace diaphane::app {
namespace {

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

// What comes on standard input is dropped; its end is what counts.
bool stdin_ended() {
  std::array<char, 4096> dropped;
  const ssize_t bytes = read(STDIN_FILENO, dropped.data(), dropped.size());
  return bytes == 0 || (bytes < 0 && errno != EINTR && errno != EAGAIN);
}

}  // namespace

void block_stop_signals() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

std::string wait_for_stop(bool watch_stdin) {
  const sigset_t signals = stop_signals();
  const int signal_fd = signalfd(-1, &signals, SFD_CLOEXEC);
  if (signal_fd < 0) std::abort();
  // poll() passes over negative descriptors.
  std::array<pollfd, 2> events = {pollfd{signal_fd, POLLIN, 0}, pollfd{watch_stdin ? STDIN_FILENO : -1, POLLIN, 0}};
  std::string reason;
  while (reason.empty()) {
    if (poll(events.data(), events.size(), -1) < 0) continue;
    if (events[0].revents != 0) {
      signalfd_siginfo info{};
      if (read(signal_fd, &info, sizeof(info)) == sizeof(info))
        reason = info.ssi_signo == SIGINT ? "SIGINT" : "SIGTERM";
    } else if (events[1].revents != 0 && stdin_ended()) {
      reason = "end of standard input";
    }
  }
  close(signal_fd);
  sigset_t impatient;
  sigemptyset(&impatient);
  sigaddset(&impatient, SIGINT);
  pthread_sigmask(SIG_UNBLOCK, &impatient, nullptr);
  return reason;
}

}  // namespace diaphane::app
