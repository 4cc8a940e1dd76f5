// What lies under a pixel, by gRPC.
#include <gmock/gmock.h>

#include <limits>

#include "diaphane/client.h"
#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class PickTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    mesh_ = create_mesh(scene_).name();
  }

  /// In a frame of 8 by 4, of an eye at (0, 0, 5) that looks at the origin.
  v1::PickRequest at(float x_px, float y_px) const {
    const v1::RenderFrameRequest frame = frame_of(scene_);
    v1::PickRequest request;
    request.set_scene(scene_);
    *request.mutable_camera() = frame.camera();
    *request.mutable_size() = frame.size();
    request.set_x_px(x_px);
    request.set_y_px(y_px);
    return request;
  }

  grpc::Status pick(const v1::PickRequest& request, v1::PickResponse* response) {
    Context context;
    return frames_->Pick(&context, request, response);
  }

  void expect_refused(const v1::PickRequest& request, grpc::StatusCode code, const std::string& field) {
    v1::PickResponse response;
    const grpc::Status status = pick(request, &response);
    EXPECT_EQ(status.error_code(), code) << field << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field);
  }

  std::string scene_, mesh_;
};

TEST_F(PickTest, NamesTheMeshAndThePoint) {
  v1::PickResponse response;
  ASSERT_TRUE(pick(at(4.2f, 1.8f), &response).ok());
  ASSERT_TRUE(response.has_point());
  EXPECT_EQ(response.point().mesh(), mesh_);
  EXPECT_EQ(response.scene_revision(), get_scene(scene_).revision());
  // The slanted face: x + y + z = 1.
  EXPECT_EQ(response.point().triangle(), 3u);
  const v1::Vec3& p = response.point().position();
  EXPECT_NEAR(p.x() + p.y() + p.z(), 1, 1e-5);
  EXPECT_GT(p.x(), 0);
  EXPECT_GT(p.y(), 0);
  EXPECT_GT(response.point().facet_normal().z(), 0.5);
  ASSERT_TRUE(pick(at(0.5f, 0.5f), &response).ok());
  EXPECT_FALSE(response.has_point());
}

TEST_F(PickTest, RefusesWhatItCannotAnswerAndNamesIt) {
  expect_refused(at(8.5f, 1), grpc::StatusCode::INVALID_ARGUMENT, "x_px");
  expect_refused(at(1, -0.5f), grpc::StatusCode::INVALID_ARGUMENT, "y_px");
  expect_refused(at(std::numeric_limits<float>::quiet_NaN(), 1), grpc::StatusCode::INVALID_ARGUMENT, "x_px");
  v1::PickRequest request = at(1, 1);
  request.mutable_size()->set_width_px(0);
  expect_refused(request, grpc::StatusCode::INVALID_ARGUMENT, "size.width_px");
  request = at(1, 1);
  request.mutable_camera()->set_fov_y_deg(0);
  expect_refused(request, grpc::StatusCode::INVALID_ARGUMENT, "camera.fov_y_deg");
  request = at(1, 1);
  request.set_min_revision(99);
  expect_refused(request, grpc::StatusCode::FAILED_PRECONDITION, "min_revision");
  request = at(1, 1);
  request.set_scene("scenes/0");
  expect_refused(request, grpc::StatusCode::NOT_FOUND, "scene");
}

TEST_F(PickTest, IsAskedByTheClientLibrary) {
  const auto client = Client::connect(server_->address());
  ASSERT_TRUE(client.ok());
  const auto scene = client->create_scene({});
  const auto material = scene->add_material({"marble"});
  MeshData data;
  data.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  data.triangles = {0, 1, 2};
  const auto mesh = scene->add_mesh(data, {.material = *material});
  Camera camera;
  camera.eye = {0, 0, 4};
  camera.target = {0, 0, 0};
  const auto point = scene->pick(camera, {100, 100}, 50, 50);
  ASSERT_TRUE(point.ok()) << point.status();
  ASSERT_TRUE(point->has_value());
  EXPECT_EQ((*point)->mesh.name, mesh->name);
  EXPECT_NEAR((*point)->distance, 4, 1e-6);
  EXPECT_NEAR((*point)->barycentric.z, 0.5, 1e-6);
  EXPECT_FALSE(scene->pick(camera, {100, 100}, 1, 1)->has_value());
  EXPECT_TRUE(absl::IsInvalidArgument(scene->pick(camera, {100, 100}, 101, 1).status()));
}

}  // namespace
}  // namespace diaphane::e2e
