// Textures, by gRPC.
#include <gmock/gmock.h>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class TextureTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
  }

  static std::string pixels() { return std::string(4 * 4 * 2, '\x7f'); }

  v1::TextureHeader header(bool srgb = false) const {
    v1::TextureHeader header;
    header.set_parent(scene_);
    header.mutable_texture()->set_width_px(4);
    header.mutable_texture()->set_height_px(2);
    header.mutable_texture()->set_srgb(srgb);
    header.mutable_texture()->set_clamp_v(true);
    header.set_total_bytes(pixels().size());
    header.set_sha256(service::sha256(pixels()));
    return header;
  }

  grpc::Status upload_texture(const v1::TextureHeader& header, v1::TextureResponse* response) {
    Context context;
    const auto stream = scenes_->UploadTexture(&context, response);
    v1::UploadTextureRequest part;
    *part.mutable_header() = header;
    stream->Write(part);
    part.set_chunk(pixels());
    stream->Write(part);
    stream->WritesDone();
    return stream->Finish();
  }

  std::string make_texture(bool srgb = false) {
    v1::TextureResponse response;
    const grpc::Status status = upload_texture(header(srgb), &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.texture().name();
  }

  grpc::Status delete_texture(const std::string& name) {
    Context context;
    v1::DeleteTextureRequest request;
    request.set_name(name);
    v1::DeleteResponse response;
    return scenes_->DeleteTexture(&context, request, &response);
  }

  grpc::Status create_textured_material(const v1::SurfaceTextures& textures, v1::MaterialResponse* response) {
    Context context;
    v1::CreateMaterialRequest request;
    request.set_parent(scene_);
    request.mutable_material()->set_preset("marble");
    *request.mutable_material()->mutable_textures() = textures;
    return scenes_->CreateMaterial(&context, request, response);
  }

  void expect_refused(const grpc::Status& status, grpc::StatusCode code, const std::string& field) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field);
  }

  std::string scene_;
};

TEST_F(TextureTest, ComesInChunksAndCanBeReadListedAndDeleted) {
  v1::TextureResponse response;
  ASSERT_TRUE(upload_texture(header(true), &response).ok());
  const std::string name = response.texture().name();
  EXPECT_THAT(name, ::testing::StartsWith(scene_ + "/textures/"));
  EXPECT_EQ(response.scene_revision(), get_scene(scene_).revision());
  EXPECT_EQ(get_scene(scene_).texture_count(), 1u);
  {
    Context context;
    v1::GetTextureRequest request;
    request.set_name(name);
    v1::Texture texture;
    ASSERT_TRUE(scenes_->GetTexture(&context, request, &texture).ok());
    EXPECT_EQ(texture.width_px(), 4u);
    EXPECT_EQ(texture.height_px(), 2u);
    EXPECT_TRUE(texture.srgb());
    EXPECT_FALSE(texture.clamp_u());
    EXPECT_TRUE(texture.clamp_v());
  }
  {
    Context context;
    v1::ListTexturesRequest request;
    request.set_parent(scene_);
    v1::ListTexturesResponse list;
    ASSERT_TRUE(scenes_->ListTextures(&context, request, &list).ok());
    ASSERT_EQ(list.textures_size(), 1);
    EXPECT_EQ(list.textures(0).name(), name);
  }
  EXPECT_GT(server_->scenes().mesh_bytes(), 0u);
  EXPECT_TRUE(delete_texture(name).ok());
  EXPECT_EQ(get_scene(scene_).texture_count(), 0u);
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  EXPECT_EQ(delete_texture(name).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(TextureTest, RefusesSizesOutOfRangeAndPayloadsOfAnotherSize) {
  v1::TextureResponse response;
  v1::TextureHeader wrong = header();
  wrong.mutable_texture()->set_width_px(8193);
  expect_refused(upload_texture(wrong, &response), grpc::StatusCode::INVALID_ARGUMENT, "texture.width_px");
  wrong = header();
  wrong.mutable_texture()->set_height_px(0);
  expect_refused(upload_texture(wrong, &response), grpc::StatusCode::INVALID_ARGUMENT, "texture.height_px");
  wrong = header();
  wrong.set_total_bytes(31);
  expect_refused(upload_texture(wrong, &response), grpc::StatusCode::INVALID_ARGUMENT, "total_bytes");
  wrong = header();
  wrong.set_sha256(service::sha256("another"));
  expect_refused(upload_texture(wrong, &response), grpc::StatusCode::INVALID_ARGUMENT, "sha256");
  EXPECT_EQ(get_scene(scene_).texture_count(), 0u);
}

TEST_F(TextureTest, StopsAtTheLimitsOfTheServer) {
  service::ServiceLimits limits;
  limits.scene.max_textures_per_scene = 1;
  start(limits);
  scene_ = create_scene().name();
  make_texture();
  v1::TextureResponse response;
  expect_refused(upload_texture(header(), &response), grpc::StatusCode::RESOURCE_EXHAUSTED, "textures");
  limits.scene.max_mesh_bytes = 100;
  start(limits);
  scene_ = create_scene().name();
  expect_refused(upload_texture(header(), &response), grpc::StatusCode::RESOURCE_EXHAUSTED, "mesh_bytes");
}

TEST_F(TextureTest, StaysWhileAMaterialUsesIt) {
  const std::string texture = make_texture(true);
  v1::SurfaceTextures textures;
  textures.set_albedo(texture);
  v1::MaterialResponse response;
  ASSERT_TRUE(create_textured_material(textures, &response).ok());
  EXPECT_EQ(response.material().textures().albedo(), texture);
  EXPECT_EQ(response.material().textures().normal_scale(), 1);
  EXPECT_EQ(delete_texture(texture).error_code(), grpc::StatusCode::FAILED_PRECONDITION);

  Context context;
  v1::UpdateMaterialRequest update;
  update.mutable_material()->set_name(response.material().name());
  update.mutable_update_mask()->add_paths("textures");
  ASSERT_TRUE(scenes_->UpdateMaterial(&context, update, &response).ok());
  EXPECT_FALSE(response.material().has_textures());
  EXPECT_TRUE(delete_texture(texture).ok());
}

TEST_F(TextureTest, OfMaterialsMustBeOfTheSceneAndLinearWhereItIsNoColour) {
  const std::string linear = make_texture(), srgb = make_texture(true);
  const std::string first_scene = std::exchange(scene_, create_scene().name());
  const std::string elsewhere = make_texture();
  scene_ = first_scene;
  const auto refused = [&](auto set, grpc::StatusCode code, const std::string& field) {
    v1::SurfaceTextures textures;
    set(textures);
    v1::MaterialResponse response;
    expect_refused(create_textured_material(textures, &response), code, field);
  };
  using Textures = v1::SurfaceTextures;
  refused([&](Textures& t) { t.set_normal(srgb); }, grpc::StatusCode::INVALID_ARGUMENT, "material.textures.normal");
  refused([&](Textures& t) { t.set_roughness(srgb); }, grpc::StatusCode::INVALID_ARGUMENT,
          "material.textures.roughness");
  refused([&](Textures& t) { t.set_albedo(elsewhere); }, grpc::StatusCode::INVALID_ARGUMENT,
          "material.textures.albedo");
  refused([&](Textures& t) { t.set_albedo(linear + "0"); }, grpc::StatusCode::NOT_FOUND, "material.textures.albedo");
  refused([&](Textures& t) { t.set_albedo("red"); }, grpc::StatusCode::INVALID_ARGUMENT, "material.textures.albedo");
  refused([&](Textures& t) { t.set_normal_scale(5); }, grpc::StatusCode::INVALID_ARGUMENT,
          "material.textures.normal_scale");
  EXPECT_EQ(get_scene(scene_).material_count(), 0u);
}

}  // namespace
}  // namespace diaphane::e2e
