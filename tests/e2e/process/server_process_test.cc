// diaphane-server as a process: what it prints, and how it ends.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "diaphane/v1/scene_service.grpc.pb.h"
#include "grpcpp/grpcpp.h"

extern char** environ;

namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A running diaphane-server with pipes to its three streams.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), DIAPHANE_BIN_DIR "/diaphane-server");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::array<int, 2> in, out, err;
    for (auto* ends : {&in, &out, &err}) {
      if (pipe2(ends->data(), O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    EXPECT_EQ(posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    for (int end : {in[0], out[1], err[1]}) close(end);
    stdin_ = in[1];
    stdout_ = out[0];
    stderr_ = err[0];
  }

  ~Process() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close_stdin();
    close(stdout_);
    close(stderr_);
  }

  void close_stdin() {
    if (stdin_ >= 0) close(stdin_);
    stdin_ = -1;
  }

  void send(int signal) { kill(pid_, signal); }

  /// One line of standard output, without its end; what there is at its end.
  std::string read_line() {
    std::string line;
    for (char c; read(stdout_, &c, 1) == 1 && c != '\n';) line += c;
    return line;
  }

  /// Waits for the end. The rest of standard output and error are in `out` and `err`; 128 + the signal if one killed
  /// it.
  int wait(std::string* out = nullptr, std::string* err = nullptr) {
    drain(stdout_, out);
    drain(stderr_, err);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  static void drain(int from, std::string* to) {
    std::array<char, 4096> bytes;
    for (ssize_t n; (n = read(from, bytes.data(), bytes.size())) > 0;) {
      if (to != nullptr) to->append(bytes.data(), static_cast<size_t>(n));
    }
  }

  pid_t pid_ = -1;
  int stdin_ = -1;
  int stdout_ = -1;
  int stderr_ = -1;
};

constexpr char kReady[] = "listening on 127\\.0\\.0\\.1:[1-9][0-9]*";

TEST(ServerProcess, PrintsOneLineAndEndsWithZeroOnSigterm) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none"});
  EXPECT_THAT(server.read_line(), MatchesRegex(kReady));
  server.send(SIGTERM);
  std::string rest;
  EXPECT_EQ(server.wait(&rest), 0);
  EXPECT_EQ(rest, "");
}

TEST(ServerProcess, EndsWithZeroOnSigint) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none"});
  EXPECT_THAT(server.read_line(), MatchesRegex(kReady));
  server.send(SIGINT);
  EXPECT_EQ(server.wait(), 0);
}

TEST(ServerProcess, EndsWithItsStandardInputWhenAskedTo) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none", "--exit-with-stdin"});
  EXPECT_THAT(server.read_line(), MatchesRegex(kReady));
  server.close_stdin();
  EXPECT_EQ(server.wait(), 0);
}

TEST(ServerProcess, OutlivesItsStandardInputOtherwise) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none"});
  server.close_stdin();
  EXPECT_THAT(server.read_line(), MatchesRegex(kReady));
  server.send(SIGTERM);
  EXPECT_EQ(server.wait(), 0);
}

TEST(ServerProcess, EndsWithZeroWithCallsInFlight) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none", "--drain-seconds", "0.1"});
  const std::string line = server.read_line();
  ASSERT_THAT(line, MatchesRegex(kReady));
  const auto channel = grpc::CreateChannel(line.substr(line.rfind(' ') + 1), grpc::InsecureChannelCredentials());
  const auto stub = diaphane::v1::SceneService::NewStub(channel);
  diaphane::v1::Scene scene;
  {
    grpc::ClientContext context;
    ASSERT_TRUE(stub->CreateScene(&context, {}, &scene).ok());
  }
  // Uploads that never end.
  std::array<grpc::ClientContext, 3> contexts;
  std::array<diaphane::v1::MeshResponse, 3> responses;
  std::vector<std::unique_ptr<grpc::ClientWriter<diaphane::v1::UploadMeshRequest>>> uploads;
  for (size_t i = 0; i < contexts.size(); ++i) {
    uploads.push_back(stub->UploadMesh(&contexts[i], &responses[i]));
  }
  server.send(SIGTERM);
  EXPECT_EQ(server.wait(), 0);
  for (const auto& upload : uploads) EXPECT_FALSE(upload->Finish().ok());
}

TEST(ServerProcess, LogsNothingWhenAllIsWellAtTheErrorLevel) {
  Process server({"--listen", "127.0.0.1:0", "--warm", "none", "--log-level", "error"});
  EXPECT_THAT(server.read_line(), MatchesRegex(kReady));
  server.send(SIGTERM);
  std::string err;
  EXPECT_EQ(server.wait(nullptr, &err), 0);
  EXPECT_EQ(err, "");
}

TEST(ServerProcess, RefusesWrongUseWithTwo) {
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"--nonsense"}, {"--listen", "nowhere"}, {"--listen", "0.0.0.0:0"}, {"--max-pixels", "0"}}) {
    Process server(wrong);
    std::string out, err;
    EXPECT_EQ(server.wait(&out, &err), 2) << wrong[0];
    EXPECT_EQ(out, "");
    EXPECT_NE(err, "");
  }
}

TEST(ServerProcess, RefusesAPublicAddressInOneLine) {
  Process server({"--listen", "0.0.0.0:0"});
  std::string err;
  EXPECT_EQ(server.wait(nullptr, &err), 2);
  EXPECT_THAT(err, MatchesRegex("diaphane-server: 0\\.0\\.0\\.0:0 [^\n]*--allow-public-plaintext\n"));
}

TEST(ServerProcess, ListensOnAPublicAddressWhenToldToAndWarns) {
  Process server({"--listen", "0.0.0.0:0", "--allow-public-plaintext", "--warm", "none", "--log-level", "warning"});
  EXPECT_THAT(server.read_line(), MatchesRegex("listening on 0\\.0\\.0\\.0:[1-9][0-9]*"));
  server.send(SIGTERM);
  std::string err;
  EXPECT_EQ(server.wait(nullptr, &err), 0);
  EXPECT_THAT(err, HasSubstr("warning plain text on a public address address=0.0.0.0:0"));
}

TEST(ServerProcess, TellsItsVersion) {
  Process server({"--version"});
  EXPECT_THAT(server.read_line(), MatchesRegex("diaphane-server [0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(server.wait(), 0);
}

}  // namespace
