// Environments, by gRPC.
#include <gmock/gmock.h>

#include <limits>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::HasSubstr;

class EnvironmentTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    pixels_.assign(3 * 8 * 4, 0.5f);
  }

  std::string payload() const {
    return {reinterpret_cast<const char*>(pixels_.data()), pixels_.size() * sizeof(float)};
  }

  v1::EnvironmentHeader header() const {
    v1::EnvironmentHeader header;
    header.set_parent(scene_);
    header.mutable_environment()->set_width_px(8);
    header.mutable_environment()->set_height_px(4);
    header.set_total_bytes(payload().size());
    header.set_sha256(service::sha256(payload()));
    return header;
  }

  grpc::Status upload_environment(const v1::EnvironmentHeader& header, v1::EnvironmentResponse* response) {
    Context context;
    const auto stream = scenes_->UploadEnvironment(&context, response);
    v1::UploadEnvironmentRequest part;
    *part.mutable_header() = header;
    stream->Write(part);
    const std::string bytes = payload();
    for (size_t at = 0; at < bytes.size(); at += 100) {
      part.set_chunk(bytes.substr(at, 100));
      stream->Write(part);
    }
    stream->WritesDone();
    return stream->Finish();
  }

  void expect_refused(const v1::EnvironmentHeader& header, const std::string& field, const std::string& range,
                      grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT) {
    const uint64_t before = get_scene(scene_).revision();
    v1::EnvironmentResponse response;
    const grpc::Status status = upload_environment(header, &response);
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    google::rpc::ErrorInfo info = error_info(status);
    EXPECT_EQ((*info.mutable_metadata())["field"], field);
    EXPECT_THAT((*info.mutable_metadata())["range"], HasSubstr(range));
    EXPECT_EQ(get_scene(scene_).revision(), before);
    EXPECT_FALSE(get_scene(scene_).has_environment());
  }

  std::string scene_;
  std::vector<float> pixels_;
};

TEST_F(EnvironmentTest, ComesInChunksAndCanBeReadUpdatedAndDeleted) {
  v1::EnvironmentHeader with = header();
  with.mutable_environment()->set_rotation_deg(90);
  v1::EnvironmentResponse response;
  ASSERT_TRUE(upload_environment(with, &response).ok());
  const std::string name = scene_ + "/environment";
  EXPECT_EQ(response.environment().name(), name);
  EXPECT_EQ(response.environment().width_px(), 8u);
  EXPECT_EQ(response.environment().intensity(), 1);
  EXPECT_EQ(response.scene_revision(), get_scene(scene_).revision());
  EXPECT_TRUE(get_scene(scene_).has_environment());

  v1::UpdateEnvironmentRequest update;
  update.mutable_environment()->set_name(name);
  update.mutable_environment()->set_intensity(0.25f);
  update.mutable_update_mask()->add_paths("intensity");
  {
    Context context;
    ASSERT_TRUE(scenes_->UpdateEnvironment(&context, update, &response).ok());
  }
  v1::GetEnvironmentRequest get;
  get.set_name(name);
  v1::Environment environment;
  {
    Context context;
    ASSERT_TRUE(scenes_->GetEnvironment(&context, get, &environment).ok());
  }
  EXPECT_EQ(environment.rotation_deg(), 90);
  EXPECT_EQ(environment.intensity(), 0.25f);

  v1::DeleteEnvironmentRequest remove;
  remove.set_name(name);
  v1::DeleteResponse removed;
  {
    Context context;
    ASSERT_TRUE(scenes_->DeleteEnvironment(&context, remove, &removed).ok());
  }
  EXPECT_FALSE(get_scene(scene_).has_environment());
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  Context context;
  EXPECT_EQ(scenes_->GetEnvironment(&context, get, &environment).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(EnvironmentTest, IsHiddenByBodiesWhereItIsToldTo) {
  v1::EnvironmentHeader with = header();
  with.mutable_environment()->set_occlusion(true);
  v1::EnvironmentResponse response;
  ASSERT_TRUE(upload_environment(with, &response).ok());
  EXPECT_TRUE(response.environment().occlusion());
  v1::UpdateEnvironmentRequest update;
  update.mutable_environment()->set_name(scene_ + "/environment");
  update.mutable_update_mask()->add_paths("occlusion");
  Context context;
  ASSERT_TRUE(scenes_->UpdateEnvironment(&context, update, &response).ok());
  EXPECT_FALSE(response.environment().occlusion());
}

TEST_F(EnvironmentTest, TellsTheLampsThatItTookOut) {
  pixels_.assign(3 * 64 * 32, 0.1f);
  for (int c = 0; c < 3; ++c) pixels_[3 * (16 * 64 + 32) + c] = 500;
  v1::EnvironmentHeader with = header();
  with.mutable_environment()->set_width_px(64);
  with.mutable_environment()->set_height_px(32);
  with.mutable_environment()->set_intensity(2);
  v1::EnvironmentResponse response;
  ASSERT_TRUE(upload_environment(with, &response).ok());
  ASSERT_EQ(response.environment().lamps_size(), 1);
  const v1::EnvironmentLamp& lamp = response.environment().lamps(0);
  EXPECT_GT(lamp.direction().z(), 0.98f);  // from the middle column, −z
  EXPECT_NEAR(lamp.irradiance().x(), 2 * 500 * 0.0963f * 0.0982f, 2);
}

TEST_F(EnvironmentTest, TakesThePlaceOfTheOneBefore) {
  v1::EnvironmentResponse response;
  ASSERT_TRUE(upload_environment(header(), &response).ok());
  const uint64_t bytes = server_->scenes().mesh_bytes();
  ASSERT_TRUE(upload_environment(header(), &response).ok());
  EXPECT_EQ(server_->scenes().mesh_bytes(), bytes);
}

TEST_F(EnvironmentTest, IsRefusedByFieldValueAndRange) {
  v1::EnvironmentHeader wrong = header();
  wrong.mutable_environment()->set_width_px(9000);
  expect_refused(wrong, "environment.width_px", "2..8192");
  wrong = header();
  wrong.mutable_environment()->set_height_px(0);
  expect_refused(wrong, "environment.height_px", "1..4096");
  wrong = header();
  wrong.set_total_bytes(12);
  expect_refused(wrong, "total_bytes", "384, as the size says");
  wrong = header();
  wrong.set_sha256("short");
  expect_refused(wrong, "sha256", "32 bytes");
  wrong = header();
  wrong.set_sha256(std::string(32, 'x'));
  expect_refused(wrong, "sha256", "the payload's");
  wrong = header();
  wrong.mutable_environment()->set_intensity(-1);
  expect_refused(wrong, "environment.intensity", "0..1000000");
  wrong = header();
  wrong.mutable_environment()->set_rotation_deg(std::numeric_limits<float>::quiet_NaN());
  expect_refused(wrong, "environment.rotation_deg", "1000000");
  wrong = header();
  wrong.set_parent("scenes/0");
  expect_refused(wrong, "parent", "an existing scene", grpc::StatusCode::NOT_FOUND);
}

TEST_F(EnvironmentTest, IsRefusedByThePixelThatIsNoLight) {
  for (const float wrong : {-0.1f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    pixels_[3 * (2 * 8 + 5) + 1] = wrong;
    expect_refused(header(), "pixels[2][5].g", "0..1e9");
  }
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
}

TEST_F(EnvironmentTest, CountsTowardsTheMemoryOfAllScenes) {
  service::ServiceLimits limits;
  limits.scene.max_mesh_bytes = 1000;
  start(limits);
  scene_ = create_scene().name();
  expect_refused(header(), "mesh_bytes", "1000", grpc::StatusCode::RESOURCE_EXHAUSTED);
}

}  // namespace
}  // namespace diaphane::e2e
