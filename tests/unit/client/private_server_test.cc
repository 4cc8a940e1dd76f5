#include "diaphane/private_server.h"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

namespace diaphane {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

// Stands a shell script in the server's place.
class PrivateServerTest : public testing::Test {
 protected:
  PrivateServerTest() {
    std::string pattern = (fs::temp_directory_path() / "private_server_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~PrivateServerTest() override { fs::remove_all(folder_); }

  PrivateServerOptions script(const std::string& body) const {
    const fs::path program = folder_ / "server";
    std::ofstream(program) << "#!/bin/sh\nfolder=" << folder_.string() << "\n" << body << "\n";
    fs::permissions(program, fs::perms::owner_all);
    return {.program = program, .stop_timeout = milliseconds(5'000)};
  }

  std::string text_of(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
};

constexpr char kListen[] = "echo \"$@\" > $folder/arguments; echo \"listening on $2\"; ";

TEST_F(PrivateServerTest, GivesTheAddressThatTheServerSays) {
  auto server = PrivateServer::start(script(std::string(kListen) + "cat"));
  ASSERT_TRUE(server.ok()) << server.status();
  EXPECT_THAT(server->address(), HasSubstr("unix:/"));
  EXPECT_EQ(text_of("arguments"), "--listen " + server->address() + " --exit-with-stdin --warm none\n");
}

TEST_F(PrivateServerTest, KeepsItsSocketInADirectoryOfItsOwnAndRemovesIt) {
  fs::path directory;
  {
    auto server = PrivateServer::start(script(std::string(kListen) + "cat"));
    ASSERT_TRUE(server.ok()) << server.status();
    directory = fs::path(server->address().substr(5)).parent_path();
    struct stat info {};
    ASSERT_EQ(stat(directory.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0700);
  }
  EXPECT_FALSE(fs::exists(directory));
}

TEST_F(PrivateServerTest, EndsWhenItsInputCloses) {
  {
    auto server =
        PrivateServer::start(script("trap '' TERM; " + std::string(kListen) + "cat; echo yes > $folder/ended"));
    ASSERT_TRUE(server.ok()) << server.status();
  }
  EXPECT_EQ(text_of("ended"), "yes\n");
}

TEST_F(PrivateServerTest, IsKilledWhenItWillNotEnd) {
  PrivateServerOptions options = script("trap '' TERM; " + std::string(kListen) + "while true; do sleep 0.01; done");
  options.stop_timeout = milliseconds(100);
  {
    auto server = PrivateServer::start(options);
    ASSERT_TRUE(server.ok()) << server.status();
  }
  // No child is left, neither running nor as a zombie.
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(PrivateServerTest, ReportsTheLastWordsOfAServerThatEnded) {
  const absl::Status status = PrivateServer::start(script("echo first >&2; echo 'no EGL device' >&2; exit 3")).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("status 3"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("no EGL device"));
}

TEST_F(PrivateServerTest, ReportsAServerThatNeverListens) {
  PrivateServerOptions options = script("cat");
  options.start_timeout = milliseconds(100);
  EXPECT_EQ(PrivateServer::start(options).status().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST_F(PrivateServerTest, StopEndsTheWait) {
  PrivateServerOptions options = script("cat");
  std::stop_source stop;
  options.stop = stop.get_token();
  stop.request_stop();
  EXPECT_EQ(PrivateServer::start(options).status().code(), absl::StatusCode::kCancelled);
}

TEST_F(PrivateServerTest, TakesTheProgramOnPathWhereNoneIsBesideTheExecutable) {
  fs::rename(script(std::string(kListen) + "cat").program, folder_ / "diaphane-server");
  const std::string path = getenv("PATH");
  setenv("PATH", (":" + folder_.string() + ":" + path).c_str(), 1);
  const auto server = PrivateServer::start();
  setenv("PATH", path.c_str(), 1);
  ASSERT_TRUE(server.ok()) << server.status();
  EXPECT_EQ(text_of("arguments"), "--listen " + server->address() + " --exit-with-stdin --warm none\n");
}

TEST_F(PrivateServerTest, NamesAProgramThatIsNotThere) {
  const absl::Status status = PrivateServer::start({.program = folder_ / "none"}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), HasSubstr("none"));
}

}  // namespace
}  // namespace diaphane
