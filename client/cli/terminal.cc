#include "terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "status.h"

namespace diaphane::cli {
namespace {

// Another screen, no cursor; and back.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l\x1b[2J", kLeave = "\x1b[0m\x1b[?25h\x1b[?1049l";

absl::Status gone() { return with_exit_code(absl::DataLossError("the terminal is gone"), kExitFile); }

TerminalExtent extent_of_stdout() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row, size.ws_xpixel, size.ws_ypixel};
}

}  // namespace

absl::StatusOr<TerminalExtent> find_terminal() {
  if (isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1) return extent_of_stdout();
  return usage_error("view", "stdin and stdout must be a terminal; diaphane stream -o keeps frames");
}

absl::StatusOr<std::unique_ptr<Terminal>> Terminal::open() {
  if (absl::Status found = find_terminal().status(); !found.ok()) return found;
  termios before{};
  if (tcgetattr(STDIN_FILENO, &before) != 0) return gone();
  std::unique_ptr<Terminal> terminal(new Terminal(before));
  termios keys = before;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 0;
  keys.c_cc[VTIME] = 0;
  if (tcsetattr(STDIN_FILENO, TCSANOW, &keys) != 0) return gone();
  if (absl::Status entered = terminal->write(kEnter); !entered.ok()) return entered;
  return terminal;
}

Terminal::~Terminal() {
  write(kLeave).IgnoreError();  // where it is gone, there is nothing to put back
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

TerminalExtent Terminal::extent() const { return extent_of_stdout(); }

absl::StatusOr<std::string> Terminal::keys(std::chrono::milliseconds wait) {
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  const int ready = poll(&waiting, 1, static_cast<int>(wait.count()));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return std::string();
  std::array<char, 64> typed{};
  const ssize_t count = read(STDIN_FILENO, typed.data(), typed.size());
  if (count <= 0) return gone();
  return std::string(typed.data(), static_cast<size_t>(count));
}

absl::Status Terminal::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return gone();
    text.remove_prefix(static_cast<size_t>(count));
  }
  return absl::OkStatus();
}

}  // namespace diaphane::cli
