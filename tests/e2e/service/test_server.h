// A server in this process, with a renderer that needs no GPU, and a client's stubs.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "app/server.h"
#include "diaphane/v1/render_service.grpc.pb.h"
#include "diaphane/v1/scene_service.grpc.pb.h"
#include "diaphane/v1/server_service.grpc.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "grpcpp/grpcpp.h"
#include "service/sha256.h"
#include "tests/fakes/fake_renderer.h"

namespace diaphane::e2e {

/// A client's context whose call ends some time even if the server does not answer.
struct Context : grpc::ClientContext {
  Context() { set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60)); }
};

/// What a refusal says of the field that it refuses.
inline google::rpc::ErrorInfo error_info(const grpc::Status& status) {
  google::rpc::Status details;
  details.ParseFromString(status.error_details());
  google::rpc::ErrorInfo info;
  for (const auto& detail : details.details()) {
    if (detail.UnpackTo(&info)) break;
  }
  return info;
}

/// A payload in pieces, and the header's facts about it.
struct TestMesh {
  std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<float> normals;
  std::vector<float> texture_coordinates;
  std::vector<float> colors;
  std::vector<uint32_t> triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::vector<std::vector<float>> morph_targets;

  std::string payload() const {
    std::string bytes;
    const auto add = [&](const auto& values) {
      bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
    add(positions);
    add(normals);
    add(texture_coordinates);
    add(colors);
    add(triangles);
    for (const std::vector<float>& target : morph_targets) add(target);
    return bytes;
  }

  v1::MeshHeader header(const std::string& scene, const std::string& material) const {
    v1::MeshHeader header;
    header.set_parent(scene);
    header.mutable_mesh()->set_material(material);
    header.set_vertex_count(static_cast<uint32_t>(positions.size() / 3));
    header.set_triangle_count(static_cast<uint32_t>(triangles.size() / 3));
    header.set_has_normals(!normals.empty());
    header.set_has_texture_coordinates(!texture_coordinates.empty());
    header.set_has_colors(!colors.empty());
    header.set_morph_target_count(static_cast<uint32_t>(morph_targets.size()));
    header.set_total_bytes(payload().size());
    header.set_sha256(service::sha256(payload()));
    return header;
  }
};

class ServiceTest : public ::testing::Test {
 protected:
  void SetUp() override { start({}); }
  void TearDown() override {
    control_->release();
    server_.reset();
  }

  /// Starts the server, in place of the one that runs.
  void start(const service::ServiceLimits& limits) {
    server_.reset();
    auto server = app::Server::start({.listen = "127.0.0.1:0", .limits = limits}, fakes::fake_renderers(control_));
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    const auto channel = grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
    scenes_ = v1::SceneService::NewStub(channel);
    frames_ = v1::RenderService::NewStub(channel);
    info_ = v1::ServerService::NewStub(channel);
  }

  v1::Scene create_scene() {
    Context context;
    v1::Scene scene;
    EXPECT_TRUE(scenes_->CreateScene(&context, {}, &scene).ok());
    return scene;
  }

  v1::Scene get_scene(const std::string& name) {
    Context context;
    v1::GetSceneRequest request;
    request.set_name(name);
    v1::Scene scene;
    EXPECT_TRUE(scenes_->GetScene(&context, request, &scene).ok());
    return scene;
  }

  std::string create_material(const std::string& scene, const std::string& preset = "marble") {
    Context context;
    v1::CreateMaterialRequest request;
    request.set_parent(scene);
    request.mutable_material()->set_preset(preset);
    v1::MaterialResponse response;
    const grpc::Status status = scenes_->CreateMaterial(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.material().name();
  }

  /// Sends `header`, then `payload` in chunks.
  grpc::Status upload(const v1::MeshHeader& header, const std::string& payload, v1::MeshResponse* response,
                      size_t chunk_bytes = 1 << 20) {
    Context context;
    const auto stream = scenes_->UploadMesh(&context, response);
    v1::UploadMeshRequest part;
    *part.mutable_header() = header;
    bool open = stream->Write(part);
    for (size_t at = 0; open && at < payload.size(); at += chunk_bytes) {
      part.set_chunk(payload.substr(at, chunk_bytes));
      open = stream->Write(part);
    }
    stream->WritesDone();
    return stream->Finish();
  }

  grpc::Status update_positions(const v1::PositionsHeader& header, const std::string& payload,
                                v1::MeshResponse* response) {
    Context context;
    const auto stream = scenes_->UpdatePositions(&context, response);
    v1::UpdatePositionsRequest part;
    *part.mutable_header() = header;
    stream->Write(part);
    part.set_chunk(payload);
    stream->Write(part);
    stream->WritesDone();
    return stream->Finish();
  }

  /// A scene with a marble tetrahedron in it.
  v1::Mesh create_mesh(const std::string& scene) {
    const TestMesh mesh;
    v1::MeshResponse response;
    const grpc::Status status = upload(mesh.header(scene, create_material(scene)), mesh.payload(), &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.mesh();
  }

  static v1::RenderFrameRequest frame_of(const std::string& scene) {
    v1::RenderFrameRequest request;
    request.set_scene(scene);
    request.mutable_camera()->mutable_eye()->set_z(5);
    request.mutable_camera()->mutable_target();
    request.mutable_camera()->mutable_up()->set_y(1);
    request.mutable_camera()->set_fov_y_deg(30);
    request.mutable_size()->set_width_px(8);
    request.mutable_size()->set_height_px(4);
    return request;
  }

  grpc::Status render(const v1::RenderFrameRequest& request, v1::RenderFrameResponse* response) {
    Context context;
    return frames_->RenderFrame(&context, request, response);
  }

  std::shared_ptr<fakes::RendererControl> control_ = std::make_shared<fakes::RendererControl>();
  std::unique_ptr<app::Server> server_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::RenderService::Stub> frames_;
  std::unique_ptr<v1::ServerService::Stub> info_;
};

}  // namespace diaphane::e2e
