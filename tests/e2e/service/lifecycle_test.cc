// Starting, stopping and where to listen.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "app/listen_address.h"
#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class LifecycleTest : public ServiceTest {
 protected:
  absl::StatusOr<std::unique_ptr<app::Server>> start_at(const std::string& listen, bool allow_public = false) {
    return app::Server::start({.listen = listen, .allow_public_plaintext = allow_public},
                              fakes::fake_renderers(control_));
  }
};

TEST_F(LifecycleTest, PicksAPortAndTellsIt) {
  EXPECT_THAT(server_->address(), MatchesRegex("127\\.0\\.0\\.1:[1-9][0-9]*"));
}

TEST_F(LifecycleTest, LetsAFrameInFlightEnd) {
  const std::string scene = create_scene().name();
  create_mesh(scene);
  control_->hold();
  v1::RenderFrameResponse response;
  std::thread caller([&] { EXPECT_TRUE(render(frame_of(scene), &response).ok()); });
  control_->wait_for_started(1);
  std::thread stopper([&] { server_->stop(absl::Seconds(60)); });
  // Calls are refused once the server stops; the frame is still held then.
  grpc::Status refused;
  do {
    Context context;
    v1::ServerInfo info;
    refused = info_->GetServerInfo(&context, {}, &info);
  } while (refused.ok());
  control_->release();
  stopper.join();
  caller.join();
  EXPECT_FALSE(response.image().empty());
}

TEST_F(LifecycleTest, CancelsWhatOutlastsTheDrain) {
  const std::string scene = create_scene().name();
  create_mesh(scene);
  control_->hold();
  std::thread caller([&] {
    v1::RenderFrameResponse response;
    EXPECT_FALSE(render(frame_of(scene), &response).ok());
  });
  control_->wait_for_started(1);
  Context context;
  v1::MeshResponse response;
  const auto stalled = scenes_->UploadMesh(&context, &response);
  v1::UploadMeshRequest part;
  *part.mutable_header() = TestMesh().header(scene, create_material(scene));
  const uint64_t bytes = server_->scenes().mesh_bytes();
  ASSERT_TRUE(stalled->Write(part));
  while (server_->scenes().mesh_bytes() == bytes) std::this_thread::yield();
  server_->stop(absl::Milliseconds(10));
  caller.join();
  EXPECT_FALSE(stalled->Finish().ok());
}

TEST_F(LifecycleTest, StopsWithIdleClientsConnected) {
  create_scene();
  server_->stop(absl::Seconds(60));
  Context context;
  v1::ServerInfo info;
  EXPECT_EQ(info_->GetServerInfo(&context, {}, &info).error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(LifecycleTest, RefusesAPortThatAServerHas) {
  const auto second = start_at(server_->address());
  EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(second.status().message()), HasSubstr(server_->address()));
}

TEST_F(LifecycleTest, ServesItsOwnerOnAUnixSocket) {
  const std::filesystem::path folder = ::testing::TempDir();
  const std::string address = "unix:" + (folder / ("lifecycle-" + std::to_string(getpid()))).string();
  auto server = start_at(address);
  ASSERT_TRUE(server.ok()) << server.status();
  EXPECT_EQ((*server)->address(), address);
  struct stat file {};
  ASSERT_EQ(stat(address.c_str() + 5, &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0700u);
  const auto stub = v1::ServerService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  Context context;
  v1::ServerInfo info;
  EXPECT_TRUE(stub->GetServerInfo(&context, {}, &info).ok());
  EXPECT_EQ(start_at(address).status().code(), absl::StatusCode::kUnavailable);
  server->reset();
  EXPECT_FALSE(std::filesystem::exists(address.substr(5)));
}

TEST_F(LifecycleTest, TakesAUnixSocketThatADeadServerLeft) {
  const std::string path = ::testing::TempDir() + "stale-" + std::to_string(getpid());
  const int dead = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
  ASSERT_EQ(bind(dead, reinterpret_cast<sockaddr*>(&name), sizeof(name)), 0);
  close(dead);
  EXPECT_TRUE(start_at("unix:" + path).ok());
}

TEST_F(LifecycleTest, RefusesPublicAddressesUnlessToldTo) {
  const absl::Status refused = start_at("0.0.0.0:0").status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("--allow-public-plaintext"));
}

TEST_F(LifecycleTest, ReportsARendererThatCannotBeMade) {
  const auto failed = app::Server::start(
      {.listen = "127.0.0.1:0"},
      []() -> absl::StatusOr<std::unique_ptr<render::FrameRenderer>> { return absl::UnavailableError("no device"); });
  EXPECT_EQ(failed.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(failed.status().message()), HasSubstr("no device"));
}

TEST(ListenAddress, ReadsHostsPortsAndPaths) {
  EXPECT_EQ(app::parse_listen_address("127.0.0.1:80")->text(), "127.0.0.1:80");
  EXPECT_EQ(app::parse_listen_address("[::1]:0")->text(), "[::1]:0");
  EXPECT_EQ(app::parse_listen_address("unix:/tmp/s")->unix_path, "/tmp/s");
  for (const char* wrong :
       {"", "80", ":80", "host", "host:", "host:65536", "host:-1", "host:8x", "::1:80", "[h]:80", "unix:"}) {
    EXPECT_EQ(app::parse_listen_address(wrong).status().code(), absl::StatusCode::kInvalidArgument) << wrong;
  }
  EXPECT_FALSE(app::parse_listen_address("unix:" + std::string(108, 'x')).ok());
}

TEST(ListenAddress, TellsLocalFromPublic) {
  for (const char* local : {"127.0.0.1:1", "127.8.9.1:1", "[::1]:1", "localhost:1", "unix:x"}) {
    EXPECT_TRUE(app::parse_listen_address(local)->is_local()) << local;
  }
  for (const char* open : {"0.0.0.0:1", "[::]:1", "10.0.0.1:1", "example.org:1", "128.0.0.1:1", "127.0.0.1.org:1"}) {
    EXPECT_FALSE(app::parse_listen_address(open)->is_local()) << open;
  }
}

}  // namespace
}  // namespace diaphane::e2e
