// Meshes and positions that come in chunks.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class UploadTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    material_ = create_material(scene_);
  }

  v1::PositionsHeader positions_header(const v1::Mesh& mesh, const std::string& payload) {
    v1::PositionsHeader header;
    header.set_name(mesh.name());
    header.set_vertex_count(mesh.vertex_count());
    header.set_total_bytes(payload.size());
    header.set_sha256(service::sha256(payload));
    return header;
  }

  // Waits until all that uploads reserved is given back.
  void expect_nothing_reserved() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (server_->scenes().mesh_bytes() != 0 && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  }

  // A grid of `side`² quads.
  static TestMesh grid(uint32_t side) {
    TestMesh mesh;
    mesh.positions.clear();
    mesh.triangles.clear();
    for (uint32_t y = 0; y <= side; ++y) {
      for (uint32_t x = 0; x <= side; ++x) mesh.positions.insert(mesh.positions.end(), {float(x), float(y), 0.5f});
    }
    for (uint32_t y = 0; y < side; ++y) {
      for (uint32_t x = 0; x < side; ++x) {
        const uint32_t a = y * (side + 1) + x, b = a + side + 1;
        mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, b, b, a + 1, b + 1});
      }
    }
    return mesh;
  }

  std::string scene_;
  std::string material_;
};

TEST_F(UploadTest, KeepsTextureCoordinatesAndColours) {
  TestMesh mesh;
  mesh.texture_coordinates = {0, 0, 1, 0, -2.5f, 1, 1e6f, 0};
  mesh.colors = {0, 0, 0, 1, 1, 1, 0.5f, 0.25f, 1, 0, 1, 0};
  v1::MeshResponse response;
  const grpc::Status status = upload(mesh.header(scene_, material_), mesh.payload(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_TRUE(response.mesh().has_texture_coordinates());
  EXPECT_TRUE(response.mesh().has_colors());
  EXPECT_FALSE(response.mesh().has_normals());
}

TEST_F(UploadTest, RefusesAttributesOutOfRange) {
  struct Case {
    std::vector<float> texture_coordinates, colors;
    std::string field;
  };
  for (const Case& c : {Case{{0, 0, 0, NAN, 0, 0, 0, 0}, {}, "texture_coordinates[1][1]"},
                        Case{{0, 0, 0, 0, 0, 0, -2e6f, 0}, {}, "texture_coordinates[3][0]"},
                        Case{{}, {0, 0, 0, 0, 0, 1.5f, 0, 0, 0, 0, 0, 0}, "colors[1][2]"},
                        Case{{}, {0, 0, 0, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0}, "colors[2][1]"}}) {
    TestMesh mesh;
    mesh.texture_coordinates = c.texture_coordinates;
    mesh.colors = c.colors;
    v1::MeshResponse response;
    const grpc::Status status = upload(mesh.header(scene_, material_), mesh.payload(), &response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(error_info(status).metadata().at("field"), c.field);
  }
  EXPECT_EQ(get_scene(scene_).mesh_count(), 0u);
  expect_nothing_reserved();
}

TEST_F(UploadTest, MakesAMeshOfAWholePayload) {
  const TestMesh mesh;
  v1::MeshHeader header = mesh.header(scene_, material_);
  for (int i = 0; i < 16; ++i) header.mutable_mesh()->add_scene_from_mesh(i % 5 == 0 ? (i == 15 ? 1 : 2) : 0);
  v1::MeshResponse response;
  const grpc::Status status = upload(header, mesh.payload(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.mesh().vertex_count(), 4u);
  EXPECT_EQ(response.mesh().triangle_count(), 4u);
  EXPECT_FALSE(response.mesh().has_normals());
  EXPECT_EQ(response.mesh().material(), material_);
  EXPECT_EQ(response.mesh().scene_from_mesh(5), 2);
  EXPECT_EQ(response.scene_revision(), 3u);
  EXPECT_EQ(response.mesh().positions_revision(), 3u);
}

TEST_F(UploadTest, TakesChunksThatCutAnywhere) {
  TestMesh mesh;
  mesh.normals.assign(12, 0.5f);
  v1::MeshResponse response;
  for (const size_t chunk_bytes : {1, 7, 96}) {
    ASSERT_TRUE(upload(mesh.header(scene_, material_), mesh.payload(), &response, chunk_bytes).ok());
    EXPECT_TRUE(response.mesh().has_normals());
    const auto stored = *server_->scenes().mesh({"name", response.mesh().name()});
    EXPECT_EQ(stored.shape->positions[3], glm::vec3(0, 0, 1));
    EXPECT_EQ(stored.shape->normals[3], glm::vec3(0.5f));
    EXPECT_EQ(stored.topology->triangles[1], glm::uvec3(0, 1, 3));
  }
}

TEST_F(UploadTest, TakesAMeshOfManyMegabytes) {
  const TestMesh mesh = grid(600);
  v1::MeshResponse response;
  const grpc::Status status = upload(mesh.header(scene_, material_), mesh.payload(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_GT(mesh.payload().size(), 12u << 20);
  EXPECT_EQ(response.mesh().triangle_count(), 720'000u);
}

TEST_F(UploadTest, LeavesNothingWhenTheHashIsWrong) {
  const TestMesh mesh;
  v1::MeshHeader header = mesh.header(scene_, material_);
  header.set_sha256(std::string(32, 'x'));
  v1::MeshResponse response;
  EXPECT_EQ(upload(header, mesh.payload(), &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  EXPECT_EQ(get_scene(scene_).mesh_count(), 0u);
  EXPECT_EQ(get_scene(scene_).revision(), 2u);
}

TEST_F(UploadTest, GivesTheReservationBackWhenTheClientGoes) {
  const TestMesh mesh = grid(100);
  Context context;
  v1::MeshResponse response;
  const auto stream = scenes_->UploadMesh(&context, &response);
  v1::UploadMeshRequest part;
  *part.mutable_header() = mesh.header(scene_, material_);
  ASSERT_TRUE(stream->Write(part));
  part.set_chunk(mesh.payload().substr(0, 1000));
  ASSERT_TRUE(stream->Write(part));
  while (server_->scenes().mesh_bytes() == 0) std::this_thread::yield();
  context.TryCancel();
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
  expect_nothing_reserved();
  EXPECT_EQ(get_scene(scene_).revision(), 2u);
}

TEST_F(UploadTest, EndsAnUploadThatFallsSilent) {
  service::ServiceLimits limits;
  limits.max_upload_silence = absl::Milliseconds(50);
  start(limits);
  const std::string scene = create_scene().name();
  const TestMesh mesh;
  Context context;
  v1::MeshResponse response;
  v1::UploadMeshRequest part;
  *part.mutable_header() = mesh.header(scene, create_material(scene));
  const auto stream = scenes_->UploadMesh(&context, &response);
  stream->Write(part);
  // No WritesDone, no more chunks: Finish returns because the server ends the call.
  const grpc::Status status = stream->Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_THAT(status.error_message(), ::testing::HasSubstr("no chunk for 0.05 s"));
  expect_nothing_reserved();
}

TEST_F(UploadTest, RefusesUploadsWhileAnotherHoldsTheMemory) {
  const TestMesh mesh = grid(100);
  service::ServiceLimits limits;
  limits.scene.max_mesh_bytes = 2 << 20;
  start(limits);
  const std::string scene = create_scene().name();
  const std::string material = create_material(scene);
  v1::MeshResponse first_response, second_response;
  Context context;
  const auto first = scenes_->UploadMesh(&context, &first_response);
  v1::UploadMeshRequest part;
  *part.mutable_header() = mesh.header(scene, material);
  ASSERT_TRUE(first->Write(part));
  while (server_->scenes().mesh_bytes() == 0) std::this_thread::yield();
  EXPECT_EQ(upload(mesh.header(scene, material), mesh.payload(), &second_response).error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  part.set_chunk(mesh.payload());
  ASSERT_TRUE(first->Write(part));
  first->WritesDone();
  EXPECT_TRUE(first->Finish().ok());
}

TEST_F(UploadTest, AnswersARepeatedUploadWithoutItsPayload) {
  const TestMesh mesh;
  v1::MeshHeader header = mesh.header(scene_, material_);
  header.set_request_id("upload");
  v1::MeshResponse first, second;
  ASSERT_TRUE(upload(header, mesh.payload(), &first).ok());
  ASSERT_TRUE(upload(header, "", &second).ok());
  EXPECT_EQ(second.mesh().name(), first.mesh().name());
  EXPECT_EQ(get_scene(scene_).mesh_count(), 1u);
}

TEST_F(UploadTest, RefusesARepeatWhileTheFirstIsUnderWay) {
  const TestMesh mesh;
  v1::UploadMeshRequest part;
  *part.mutable_header() = mesh.header(scene_, material_);
  part.mutable_header()->set_request_id("upload");
  Context context;
  v1::MeshResponse response, repeated;
  const auto first = scenes_->UploadMesh(&context, &response);
  ASSERT_TRUE(first->Write(part));
  while (server_->scenes().mesh_bytes() == 0) std::this_thread::yield();
  EXPECT_EQ(upload(part.header(), mesh.payload(), &repeated).error_code(), grpc::StatusCode::ABORTED);
  part.set_chunk(mesh.payload());
  first->Write(part);
  first->WritesDone();
  EXPECT_TRUE(first->Finish().ok());
}

TEST_F(UploadTest, ReplacesPositionsAndKeepsTheTopology) {
  const v1::Mesh mesh = create_mesh(scene_);
  const auto before = *server_->scenes().mesh({"name", mesh.name()});
  TestMesh moved;
  for (float& p : moved.positions) p *= 3;
  moved.triangles.clear();
  v1::MeshResponse response;
  const grpc::Status status = update_positions(positions_header(mesh, moved.payload()), moved.payload(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.mesh().positions_revision(), response.scene_revision());
  EXPECT_GT(response.scene_revision(), mesh.positions_revision());
  const auto after = *server_->scenes().mesh({"name", mesh.name()});
  EXPECT_EQ(after.topology, before.topology);
  EXPECT_EQ(after.shape->positions[3], glm::vec3(0, 0, 3));
}

TEST_F(UploadTest, GoesOverToComputedNormalsWithPositionsAlone) {
  TestMesh mesh;
  mesh.normals.assign(12, 1);
  v1::MeshResponse response;
  ASSERT_TRUE(upload(mesh.header(scene_, material_), mesh.payload(), &response).ok());
  ASSERT_TRUE(response.mesh().has_normals());
  TestMesh moved;
  moved.triangles.clear();
  ASSERT_TRUE(update_positions(positions_header(response.mesh(), moved.payload()), moved.payload(), &response).ok());
  EXPECT_FALSE(response.mesh().has_normals());
}

TEST_F(UploadTest, KeepsOldPositionsWhenTheHashIsWrong) {
  const v1::Mesh mesh = create_mesh(scene_);
  const auto before = *server_->scenes().mesh({"name", mesh.name()});
  const std::string payload(48, '\0');
  v1::PositionsHeader header = positions_header(mesh, payload);
  header.set_sha256(std::string(32, '\0'));
  v1::MeshResponse response;
  EXPECT_EQ(update_positions(header, payload, &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(server_->scenes().mesh({"name", mesh.name()})->shape, before.shape);
}

}  // namespace
}  // namespace diaphane::e2e
