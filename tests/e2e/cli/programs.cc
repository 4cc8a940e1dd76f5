#include "programs.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;

std::string in_bin(const std::string& name) { return std::string(DIAPHANE_BIN_DIR) + "/" + name; }

void redirect(const fs::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(file, descriptor);
}

/// In the child; does not come back.
[[noreturn]] void become(const std::string& program, const fs::path& folder,
                         const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  if (chdir(folder.c_str()) != 0) _exit(126);
  execv(program.c_str(), argv.data());
  _exit(127);
}

// Starts it with its stdout in .stdout, and stderr where `redirect_stderr` says.
template <typename Redirect>
pid_t start(const std::string& program, const fs::path& folder, const std::vector<std::string>& arguments,
            const Redirect& redirect_stderr) {
  const pid_t child = fork();
  if (child != 0) return child;
  redirect(folder / ".stdout", STDOUT_FILENO);
  redirect_stderr();
  become(program, folder, arguments);
}

/// Waits for its end; the rest of what there is to say is the caller's.
Finished finish(pid_t child) {
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  Finished finished;
  finished.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  finished.peak_memory_kib = used.ru_maxrss;
  return finished;
}

}  // namespace

Finished run_command(const std::string& path, const fs::path& folder, const std::vector<std::string>& arguments) {
  const fs::path err = folder / ".stderr";
  Finished finished = finish(start(path, folder, arguments, [&] { redirect(err, STDERR_FILENO); }));
  finished.out = read_file(folder / ".stdout");
  finished.err = read_file(err);
  return finished;
}

Finished run_program(const std::string& name, const fs::path& folder, const std::vector<std::string>& arguments) {
  return run_command(in_bin(name), folder, arguments);
}

Finished run_diaphane(const fs::path& folder, const std::vector<std::string>& arguments) {
  return run_program("diaphane", folder, arguments);
}

Finished run_diaphane_on_terminal(const fs::path& folder, const std::vector<std::string>& arguments) {
  int terminal = -1;
  int program_side = -1;
  if (openpty(&terminal, &program_side, nullptr, nullptr, nullptr) != 0) return {};
  const pid_t child = start(in_bin("diaphane"), folder, arguments, [&] { dup2(program_side, STDERR_FILENO); });
  close(program_side);
  // Reading fails once the program, which holds the other side, has ended.
  std::string err;
  char bytes[4096];
  for (ssize_t count; (count = read(terminal, bytes, sizeof bytes)) > 0;) err.append(bytes, static_cast<size_t>(count));
  close(terminal);
  Finished finished = finish(child);
  finished.out = read_file(folder / ".stdout");
  finished.err = err;
  return finished;
}

Finished run_diaphane_in_terminal(const fs::path& folder, const std::vector<std::string>& arguments,
                                  const std::vector<Typed>& typed) {
  const std::string program = in_bin("diaphane");
  winsize size{.ws_row = 12, .ws_col = 40, .ws_xpixel = 0, .ws_ypixel = 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) become(program, folder, arguments);
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  std::string out;
  size_t next = 0, searched = 0;
  while (true) {
    pollfd waiting{terminal, POLLIN, 0};
    if (std::chrono::steady_clock::now() > end) kill(child, SIGKILL);
    if (poll(&waiting, 1, 100) <= 0) continue;
    char bytes[4096];
    const ssize_t count = read(terminal, bytes, sizeof bytes);
    if (count <= 0) break;
    out.append(bytes, static_cast<size_t>(count));
    if (next == typed.size()) continue;
    const size_t found = out.find(typed[next].after, searched);
    if (found == std::string::npos) continue;
    searched = found + typed[next].after.size();
    const std::string& keys = typed[next++].keys;
    if (write(terminal, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size())) break;
  }
  close(terminal);
  Finished finished = finish(child);
  finished.out = out;
  return finished;
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string cube_obj() {
  return "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

}  // namespace diaphane::testing_support
