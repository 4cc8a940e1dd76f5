#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "fmt/format.h"

namespace diaphane::internal {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPollInterval{20};  // how soon a stop request, or an end, is noticed
constexpr size_t kMaxLineBytes = size_t{64} << 10;

absl::Status system_error(std::string_view what, int code) {
  return absl::InternalError(fmt::format("{}: {}", what, std::strerror(code)));
}

absl::StatusOr<std::pair<FileDescriptor, FileDescriptor>> make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return system_error("pipe", errno);
  return std::pair(FileDescriptor(ends[0]), FileDescriptor(ends[1]));
}

// The three descriptors are the child's standard ones. A descriptor below 0 is inherited.
int spawn(const std::filesystem::path& program, const std::vector<std::string>& arguments, int in, int out, int err,
          pid_t* pid) {
  std::string name = program.string();
  std::vector<char*> argv{name.data()};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  if (err >= 0) posix_spawn_file_actions_adddup2(&files, err, STDERR_FILENO);

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t all;
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

  const int code = posix_spawn(pid, name.c_str(), &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return code;
}

}  // namespace

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

void FileDescriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

absl::StatusOr<ChildProcess> ChildProcess::start(const std::filesystem::path& program,
                                                 const std::vector<std::string>& arguments, bool inherit_stderr) {
  auto in = make_pipe();
  if (!in.ok()) return in.status();
  auto out = make_pipe();
  if (!out.ok()) return out.status();
  ChildProcess child;
  if (!inherit_stderr) {
    child.stderr_ = FileDescriptor(memfd_create("stderr", MFD_CLOEXEC));
    if (child.stderr_.number() < 0) return system_error("memfd_create", errno);
    // Appending, so that reading from here does not move where the child writes.
    fcntl(child.stderr_.number(), F_SETFL, O_APPEND);
  }
  const int code =
      spawn(program, arguments, in->first.number(), out->second.number(), child.stderr_.number(), &child.pid_);
  if (code != 0) return system_error(program.string(), code);
  child.stdin_ = std::move(in->second);
  child.stdout_ = std::move(out->first);
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)),
      stdin_(std::move(other.stdin_)),
      stdout_(std::move(other.stdout_)),
      stderr_(std::move(other.stderr_)),
      unread_(std::move(other.unread_)) {}

ChildProcess::~ChildProcess() {
  if (pid_ != 0) stop(milliseconds(0));
}

absl::StatusOr<std::string> ChildProcess::read_line(milliseconds timeout, const std::stop_token& stop) {
  const auto deadline = Clock::now() + timeout;
  while (true) {
    if (const size_t end = unread_.find('\n'); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    if (unread_.size() > kMaxLineBytes) return absl::UnavailableError("no line end in 64 KiB");
    if (stop.stop_requested()) return absl::CancelledError("stopped");
    if (Clock::now() >= deadline) return absl::DeadlineExceededError(fmt::format("{} ms", timeout.count()));
    pollfd readable{.fd = stdout_.number(), .events = POLLIN};
    if (poll(&readable, 1, static_cast<int>(kPollInterval.count())) <= 0) continue;
    char buffer[4096];
    const ssize_t count = read(stdout_.number(), buffer, sizeof buffer);
    if (count == 0) return absl::UnavailableError("standard output closed");
    if (count > 0) unread_.append(buffer, static_cast<size_t>(count));
  }
}

std::string ChildProcess::last_words() const {
  if (stderr_.number() < 0) return {};
  const off_t size = std::max<off_t>(lseek(stderr_.number(), 0, SEEK_END), 0);
  std::string tail(static_cast<size_t>(std::min<off_t>(size, 4096)), '\0');
  const ssize_t count = pread(stderr_.number(), tail.data(), tail.size(), size - static_cast<off_t>(tail.size()));
  tail.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
  while (!tail.empty() && tail.back() == '\n') tail.pop_back();
  return tail.substr(tail.rfind('\n') + 1);
}

void ChildProcess::stop(milliseconds timeout) {
  stdin_.close();
  if (pid_ == 0) return;
  kill(pid_, SIGTERM);
  if (wait(timeout)) return;
  kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = 0;
}

std::optional<std::string> ChildProcess::wait(milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (pid_ != 0) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = 0;
      if (WIFSIGNALED(status)) return fmt::format("ended by signal {}", WTERMSIG(status));
      return fmt::format("ended with status {}", WEXITSTATUS(status));
    }
    if (Clock::now() >= deadline) return std::nullopt;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return "ended";
}

}  // namespace diaphane::internal
