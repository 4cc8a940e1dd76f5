#include "diaphane/private_server.h"

#include <stdlib.h>
#include <sys/un.h>
#include <unistd.h>

#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "child_process.h"
#include "fmt/format.h"

namespace diaphane {
namespace {

namespace fs = std::filesystem;
using internal::ChildProcess;

constexpr std::string_view kProgram = "diaphane-server";
constexpr std::string_view kListening = "listening on ";
constexpr std::string_view kSocketName = "/server";
constexpr size_t kMaxSocketPath = sizeof(sockaddr_un::sun_path) - 1;

// A fresh directory of mode 0700, removed with this object.
class TemporaryDirectory {
 public:
  static absl::StatusOr<TemporaryDirectory> make() {
    std::error_code code;
    fs::path parent = fs::temp_directory_path(code);
    std::string pattern = (parent / "diaphane-XXXXXX").string();
    // A socket's path is short; a long TMPDIR does not hold one.
    if (code || pattern.size() + kSocketName.size() > kMaxSocketPath) pattern = "/tmp/diaphane-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) {
      return absl::InternalError(fmt::format("{}: {}", pattern, std::generic_category().message(errno)));
    }
    return TemporaryDirectory(pattern);
  }

  TemporaryDirectory(TemporaryDirectory&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryDirectory& operator=(TemporaryDirectory&&) = delete;
  ~TemporaryDirectory() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  const std::string& path() const { return path_; }

 private:
  explicit TemporaryDirectory(std::string path) : path_(std::move(path)) {}

  std::string path_;
};

bool is_program(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path, code) && access(path.c_str(), X_OK) == 0;
}

absl::StatusOr<fs::path> find_program(const PrivateServerOptions& options) {
  if (!options.program.empty()) {
    if (is_program(options.program)) return options.program;
    return absl::NotFoundError(fmt::format("{}: no such program", options.program.string()));
  }
  std::error_code code;
  std::vector<fs::path> folders = {fs::read_symlink("/proc/self/exe", code).parent_path()};
  const char* path = getenv("PATH");
  std::istringstream rest(path == nullptr ? "" : path);
  for (std::string folder; std::getline(rest, folder, ':');) folders.emplace_back(folder);
  for (const fs::path& folder : folders) {
    // An empty folder would be the working directory: a program from there is nobody's wish.
    if (!folder.empty() && is_program(folder / kProgram)) return folder / kProgram;
  }
  return absl::NotFoundError(
      fmt::format("{}: no such program, neither in {} nor on PATH", kProgram, folders[0].string()));
}

// The address that the server says it listens on.
absl::StatusOr<std::string> wait_until_listening(ChildProcess& child, const PrivateServerOptions& options) {
  const absl::StatusOr<std::string> line = child.read_line(options.start_timeout, options.stop);
  if (line.ok()) {
    if (line->starts_with(kListening)) return line->substr(kListening.size());
    return absl::UnavailableError(fmt::format("{}: must say '{}ADDRESS', said '{}'", kProgram, kListening, *line));
  }
  switch (line.status().code()) {
    case absl::StatusCode::kCancelled:
      return line.status();
    case absl::StatusCode::kDeadlineExceeded:
      return absl::DeadlineExceededError(
          fmt::format("{}: did not listen within {} s", kProgram, options.start_timeout.count() / 1000.0));
    default:
      const std::string end = child.wait(std::chrono::seconds(1)).value_or("closed its standard output");
      const std::string words = child.last_words();
      return absl::UnavailableError(
          fmt::format("{}: {} before it listened{}{}", kProgram, end, words.empty() ? "" : ": ", words));
  }
}

}  // namespace

struct PrivateServer::Process {
  TemporaryDirectory directory;  // outlives the child
  ChildProcess child;
  std::string address;
  std::chrono::milliseconds stop_timeout;

  ~Process() { child.stop(stop_timeout); }
};

absl::StatusOr<PrivateServer> PrivateServer::start(const PrivateServerOptions& options) {
  const absl::StatusOr<fs::path> program = find_program(options);
  if (!program.ok()) return program.status();
  absl::StatusOr<TemporaryDirectory> directory = TemporaryDirectory::make();
  if (!directory.ok()) return directory.status();
  const std::string listen = fmt::format("unix:{}{}", directory->path(), kSocketName);
  absl::StatusOr<ChildProcess> child =
      ChildProcess::start(*program, {"--listen", listen, "--exit-with-stdin", "--warm", "none"}, options.verbose);
  if (!child.ok()) return child.status();
  absl::StatusOr<std::string> address = wait_until_listening(*child, options);
  if (!address.ok()) return address.status();
  return PrivateServer(std::unique_ptr<Process>(
      new Process{*std::move(directory), *std::move(child), *std::move(address), options.stop_timeout}));
}

PrivateServer::PrivateServer(std::unique_ptr<Process> process) : process_(std::move(process)) {}
PrivateServer::PrivateServer(PrivateServer&&) noexcept = default;
PrivateServer& PrivateServer::operator=(PrivateServer&&) noexcept = default;
PrivateServer::~PrivateServer() = default;

const std::string& PrivateServer::address() const { return process_->address; }

}  // namespace diaphane
