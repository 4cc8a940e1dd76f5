#include "diaphane/client.h"

#include <gmock/gmock.h>

#include <cstring>
#include <thread>

#include "fake_server.h"

namespace diaphane {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Le;
using testing::SizeIs;
using testing_support::FakeServer;

class ClientTest : public testing::Test {
 protected:
  Client connect(const ClientOptions& options = {}) { return Client::connect(server_.address(), options).value(); }

  FakeServer server_;
};

MeshData triangle() { return {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {0, 1, 2}}; }

TEST_F(ClientTest, UploadsWhatTheHeaderSays) {
  MeshData mesh = triangle();
  mesh.normals.assign(3, {0, 0, 1});
  mesh.scene_from_mesh[12] = 5;
  const Scene scene = connect().create_scene().value();
  const auto handle = scene.add_mesh(mesh, {.material = {"scenes/s/materials/a"}});
  ASSERT_TRUE(handle.ok()) << handle.status();
  EXPECT_EQ(handle->name, "scenes/s/meshes/m");
  ASSERT_EQ(server_.scenes.mesh_headers.size(), 1);
  const v1::MeshHeader& header = server_.scenes.mesh_headers[0];
  EXPECT_EQ(header.parent(), "scenes/s");
  EXPECT_EQ(header.mesh().material(), "scenes/s/materials/a");
  EXPECT_EQ(header.mesh().scene_from_mesh(12), 5);
  EXPECT_EQ(header.vertex_count(), 3);
  EXPECT_EQ(header.triangle_count(), 1);
  EXPECT_TRUE(header.has_normals());
  EXPECT_EQ(header.total_bytes(), 3 * 12 + 3 * 12 + 12);
  EXPECT_EQ(header.sha256().size(), 32);
  EXPECT_EQ(server_.scenes.payload.size(), header.total_bytes());
  EXPECT_EQ(std::memcmp(server_.scenes.payload.data() + 72, mesh.triangles.data(), 12), 0);
}

TEST_F(ClientTest, UploadsLargeMeshesInChunks) {
  MeshData mesh = triangle();
  mesh.positions.resize(1'000'000);
  const Scene scene = connect().create_scene().value();
  ASSERT_TRUE(scene.add_mesh(mesh, {}).ok());
  EXPECT_THAT(server_.scenes.chunk_sizes, SizeIs(12));
  EXPECT_THAT(server_.scenes.chunk_sizes, Each(Le(size_t{1} << 20)));
  EXPECT_EQ(server_.scenes.payload.size(), 12'000'012);
}

TEST_F(ClientTest, RepeatsAnUploadThatFoundNoServerUnderTheSameRequestId) {
  server_.scenes.answers = {grpc::Status::OK, {grpc::UNAVAILABLE, "starting"}, {grpc::UNAVAILABLE, "starting"}};
  const Scene scene = connect().create_scene().value();
  const auto handle = scene.add_mesh(triangle(), {});
  ASSERT_TRUE(handle.ok()) << handle.status();
  const auto& headers = server_.scenes.mesh_headers;
  ASSERT_EQ(headers.size(), 3);
  EXPECT_THAT(headers[0].request_id(), SizeIs(32));
  EXPECT_EQ(headers[1].request_id(), headers[0].request_id());
  EXPECT_EQ(headers[2].request_id(), headers[0].request_id());
  EXPECT_EQ(server_.scenes.payload.size(), 48);
}

TEST_F(ClientTest, WaitsWhileTheServerIsAtAnEarlierAttempt) {
  server_.scenes.answers = {{grpc::ABORTED, "request_id: under way"}};
  EXPECT_TRUE(connect().create_scene().ok());
  EXPECT_EQ(server_.scenes.created.size(), 2);
}

TEST_F(ClientTest, GivesEachCallItsOwnRequestId) {
  const Client client = connect();
  ASSERT_TRUE(client.create_scene().ok());
  ASSERT_TRUE(client.create_scene().ok());
  ASSERT_EQ(server_.scenes.created.size(), 2);
  EXPECT_NE(server_.scenes.created[0].request_id(), server_.scenes.created[1].request_id());
}

TEST_F(ClientTest, DoesNotRepeatWhatWasRefused) {
  server_.scenes.answers = {{grpc::INVALID_ARGUMENT, "scene.display_name: must be at most 256 bytes"}};
  const absl::Status status = connect().create_scene().status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "scene.display_name: must be at most 256 bytes");
  EXPECT_EQ(server_.scenes.created.size(), 1);
}

TEST_F(ClientTest, SendsPositionsWithAndWithoutNormals) {
  const Scene scene = connect().create_scene().value();
  const std::vector<Vec3> three(3);
  EXPECT_EQ(scene.update_positions({"scenes/s/meshes/m"}, three).value(), 7);
  EXPECT_EQ(server_.scenes.payload.size(), 36);
  EXPECT_EQ(scene.update_positions({"scenes/s/meshes/m"}, three, three).value(), 7);
  EXPECT_EQ(server_.scenes.payload.size(), 72);
  EXPECT_FALSE(server_.scenes.positions_headers[0].has_normals());
  EXPECT_TRUE(server_.scenes.positions_headers[1].has_normals());
}

TEST_F(ClientTest, RefusesNormalsOfAnotherCountBeforeSending) {
  const Scene scene = connect().create_scene().value();
  MeshData mesh = triangle();
  mesh.normals.resize(2);
  const absl::Status status = scene.add_mesh(mesh, {}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("normals"));
  EXPECT_EQ(server_.scenes.mesh_headers.size(), 0);
}

TEST_F(ClientTest, ListsEveryPageOfScenes) {
  for (int i = 0; i < 5; ++i) server_.scenes.scenes.emplace_back().set_name("scenes/" + std::to_string(i));
  const auto scenes = connect().scenes();
  ASSERT_TRUE(scenes.ok()) << scenes.status();
  ASSERT_THAT(*scenes, SizeIs(5));
  EXPECT_EQ(scenes->back().name, "scenes/4");
}

TEST_F(ClientTest, ReceivesFramesPastFourMegabytes) {
  server_.renders.image.assign(9'000'000, 'x');
  const Scene scene = connect().create_scene().value();
  const auto frame = scene.render();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->image, server_.renders.image);
}

TEST_F(ClientTest, TellsTheProgressOfAFrame) {
  server_.renders.image = "bytes";
  server_.renders.shares = {0.25f, 0.5f, 1};
  const Scene scene = connect().create_scene().value();
  std::vector<double> shares;
  const RenderOptions options{.format = ImageFormat::kExr, .channels = {Channel::kDepth, Channel::kIrradiance}};
  const auto frame = scene.render(options, [&](double share) { shares.push_back(share); });
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->image, "bytes");
  EXPECT_THAT(shares, testing::ElementsAre(0.25, 0.5, 1));
  const auto& channels = server_.renders.last_request.encoding().channels();
  EXPECT_THAT(channels, testing::ElementsAre(v1::CHANNEL_DEPTH, v1::CHANNEL_IRRADIANCE));
}

TEST_F(ClientTest, DoesNotTakeAStreamWithoutAFrameForOne) {
  server_.renders.shares = {1};
  server_.renders.forget_the_frame = true;
  const Scene scene = connect().create_scene().value();
  EXPECT_EQ(scene.render({}, [](double) {}).status().code(), absl::StatusCode::kInternal);
}

TEST_F(ClientTest, StopCancelsAFrameThatTellsItsProgress) {
  server_.renders.shares = {0.25f};
  server_.renders.wait_for_cancellation = true;
  std::stop_source stop;
  const Scene scene = connect({.stop = stop.get_token()}).create_scene().value();
  const auto frame = scene.render({}, [&](double) { stop.request_stop(); });
  EXPECT_EQ(frame.status().code(), absl::StatusCode::kCancelled);
}

TEST_F(ClientTest, StopCancelsTheCallInFlight) {
  server_.renders.wait_for_cancellation = true;
  std::stop_source stop;
  const Scene scene = connect({.stop = stop.get_token()}).create_scene().value();
  std::jthread stopper([&] { stop.request_stop(); });
  EXPECT_EQ(scene.render().status().code(), absl::StatusCode::kCancelled);
}

TEST_F(ClientTest, DeadlineEndsACall) {
  server_.renders.wait_for_cancellation = true;
  const Scene scene = connect({.call_timeout = std::chrono::milliseconds(300)}).create_scene().value();
  EXPECT_EQ(scene.render().status().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST(Connecting, RefusesWhatIsNoAddress) {
  for (const char* address : {"", "host", "host:", ":80", "host:0", "host:99999", "host:http", "unix:"}) {
    EXPECT_EQ(Client::connect(address).status().code(), absl::StatusCode::kInvalidArgument) << address;
  }
}

TEST(Connecting, SaysThatNobodyAnswers) {
  const absl::Status status =
      Client::connect("unix:/nonexistent/socket", {.connect_timeout = std::chrono::milliseconds(200)}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("unix:/nonexistent/socket"));
}

}  // namespace
}  // namespace diaphane
