// Many clients at once.
#include <gmock/gmock.h>

#include <thread>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class ConcurrencyTest : public ServiceTest {
 protected:
  // A client's life: a scene, a mesh, frames while its positions change, calls that it gives up, and the end of the
  // scene.
  void live(int client) {
    const std::string scene = create_scene().name();
    const v1::Mesh mesh = create_mesh(scene);
    TestMesh moved;
    moved.triangles.clear();
    for (int i = 0; i < 20; ++i) {
      moved.positions[0] = static_cast<float>(client + i);
      const std::string payload = moved.payload();
      v1::PositionsHeader header;
      header.set_name(mesh.name());
      header.set_vertex_count(4);
      header.set_total_bytes(payload.size());
      header.set_sha256(service::sha256(payload));
      v1::MeshResponse response;
      ASSERT_TRUE(update_positions(header, payload, &response).ok());
      Context given_up;
      std::thread quitter([&] { given_up.TryCancel(); });
      v1::RenderFrameResponse frame;
      frames_->RenderFrame(&given_up, frame_of(scene), &frame);
      quitter.join();
      const grpc::Status status = render(frame_of(scene), &frame);
      ASSERT_TRUE(status.ok()) << status.error_message();
      // Nobody else changes this scene: a frame shows what was acknowledged.
      EXPECT_EQ(frame.scene_revision(), response.scene_revision());
    }
    v1::DeleteSceneRequest request;
    request.set_name(scene);
    Context context;
    google::protobuf::Empty empty;
    EXPECT_TRUE(scenes_->DeleteScene(&context, request, &empty).ok());
  }
};

TEST_F(ConcurrencyTest, ClientsDoNotDisturbEachOther) {
  std::vector<std::thread> clients;
  for (int client = 0; client < 6; ++client) clients.emplace_back([this, client] { live(client); });
  for (std::thread& client : clients) client.join();
  server_->stop(absl::Seconds(60));
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  EXPECT_EQ(server_->scenes().scenes(10, {"page_token", ""})->scenes.size(), 0u);
}

TEST_F(ConcurrencyTest, StopsUnderLoad) {
  std::vector<std::thread> clients;
  std::atomic<int> frames{0};
  const std::string scene = create_scene().name();
  create_mesh(scene);
  for (int client = 0; client < 6; ++client) {
    clients.emplace_back([&] {
      v1::RenderFrameResponse frame;
      while (render(frame_of(scene), &frame).ok()) ++frames;
    });
  }
  while (frames < 50) std::this_thread::yield();
  server_->stop(absl::Milliseconds(1));
  for (std::thread& client : clients) client.join();
  EXPECT_GE(frames, 50);
}

}  // namespace
}  // namespace diaphane::e2e
