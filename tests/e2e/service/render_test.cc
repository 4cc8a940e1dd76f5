// Frames, by gRPC.
#include <gmock/gmock.h>

#include <thread>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class RenderTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    create_mesh(scene_);
  }

  std::string scene_;
};

TEST_F(RenderTest, AnswersWithAPngOfTheNewestRevision) {
  v1::RenderFrameResponse response;
  const grpc::Status status = render(frame_of(scene_), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(response.image(), StartsWith("\x89PNG"));
  EXPECT_EQ(response.content_type(), "image/png");
  EXPECT_EQ(response.scene_revision(), 3u);
  EXPECT_EQ(response.size().width_px(), 8u);
  EXPECT_EQ(response.size().height_px(), 4u);
  EXPECT_EQ(response.path(), "fake");
  EXPECT_EQ(response.stages(0).stage(), "queue");
  EXPECT_EQ(response.stages(response.stages_size() - 1).stage(), "encode");
  create_material(scene_);
  ASSERT_TRUE(render(frame_of(scene_), &response).ok());
  EXPECT_EQ(response.scene_revision(), 4u);
}

TEST_F(RenderTest, EncodesAsAsked) {
  v1::RenderFrameRequest request = frame_of(scene_);
  v1::RenderFrameResponse response;
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_JPEG);
  ASSERT_TRUE(render(request, &response).ok());
  EXPECT_THAT(response.image(), StartsWith("\xff\xd8\xff"));
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_EXR);
  ASSERT_TRUE(render(request, &response).ok());
  EXPECT_THAT(response.image(), StartsWith("v/1\x01"));
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_WEBP);
  ASSERT_TRUE(render(request, &response).ok());
  EXPECT_THAT(response.image(), StartsWith("RIFF"));
  EXPECT_EQ(response.content_type(), "image/webp");
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_H264);
  const grpc::Status video = render(request, &response);
  EXPECT_EQ(video.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(error_info(video).metadata().at("field"), "encoding.format");
}

TEST_F(RenderTest, EncodesTheChannelsThatWereAskedFor) {
  v1::RenderFrameRequest request = frame_of(scene_);
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_EXR);
  v1::RenderFrameResponse plain;
  ASSERT_TRUE(render(request, &plain).ok());
  EXPECT_THAT(plain.image(), Not(HasSubstr("N.X")));
  request.mutable_encoding()->add_channels(v1::CHANNEL_NORMAL);
  request.mutable_encoding()->add_channels(v1::CHANNEL_IRRADIANCE);
  v1::RenderFrameResponse response;
  ASSERT_TRUE(render(request, &response).ok());
  for (const char* name : {"N.X", "N.Y", "N.Z", "irradiance.R", "irradiance.G", "irradiance.B"}) {
    EXPECT_THAT(response.image(), HasSubstr(name));
  }
}

TEST_F(RenderTest, TakesShadowsWithEveryTechnique) {
  v1::RenderFrameRequest request = frame_of(scene_);
  for (const v1::Technique technique :
       {v1::TECHNIQUE_PAPER, v1::TECHNIQUE_LAMBERT, v1::TECHNIQUE_INTEGRAL, v1::TECHNIQUE_REFERENCE}) {
    request.mutable_settings()->set_technique(technique);
    for (const v1::Shadows shadows : {v1::SHADOWS_ON, v1::SHADOWS_OFF, v1::SHADOWS_UNSPECIFIED}) {
      request.mutable_settings()->set_shadows(shadows);
      v1::RenderFrameResponse response;
      EXPECT_TRUE(render(request, &response).ok()) << technique << " " << shadows;
    }
  }
}

TEST_F(RenderTest, SendsFramesLargerThanGrpcsDefault) {
  v1::RenderFrameRequest request = frame_of(scene_);
  request.mutable_size()->set_width_px(4096);
  request.mutable_size()->set_height_px(1024);
  request.mutable_encoding()->set_format(v1::IMAGE_FORMAT_EXR);
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  const auto stub = v1::RenderService::NewStub(
      grpc::CreateCustomChannel(server_->address(), grpc::InsecureChannelCredentials(), arguments));
  Context context;
  v1::RenderFrameResponse response;
  const grpc::Status status = stub->RenderFrame(&context, request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.size().width_px(), 4096u);
}

TEST_F(RenderTest, StopsAFrameWhoseCallerGoes) {
  control_->hold();
  Context context;
  std::thread caller([&] {
    v1::RenderFrameResponse response;
    EXPECT_EQ(frames_->RenderFrame(&context, frame_of(scene_), &response).error_code(), grpc::StatusCode::CANCELLED);
  });
  control_->wait_for_started(1);
  context.TryCancel();
  caller.join();
  // The renderer, still held, has seen it: a second frame starts.
  Context next;
  std::thread second([&] {
    v1::RenderFrameResponse response;
    EXPECT_TRUE(frames_->RenderFrame(&next, frame_of(scene_), &response).ok());
  });
  control_->wait_for_started(2);
  control_->release();
  second.join();
}

TEST_F(RenderTest, EndsAtTheCallersDeadline) {
  control_->hold();
  Context context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(50));
  v1::RenderFrameResponse response;
  EXPECT_EQ(frames_->RenderFrame(&context, frame_of(scene_), &response).error_code(),
            grpc::StatusCode::DEADLINE_EXCEEDED);
  control_->release();
  EXPECT_TRUE(render(frame_of(scene_), &response).ok());
}

TEST_F(RenderTest, RefusesFramesPastTheQueue) {
  service::ServiceLimits limits;
  limits.max_queued_frames = 1;
  start(limits);
  scene_ = create_scene().name();
  create_mesh(scene_);
  control_->hold();
  v1::RenderFrameResponse drawn_response;
  std::thread drawn([&] { EXPECT_TRUE(render(frame_of(scene_), &drawn_response).ok()); });
  control_->wait_for_started(1);
  // There is room for one of these two; the other one's refusal lets the first go on.
  grpc::Status statuses[2];
  std::vector<std::thread> callers;
  for (grpc::Status& status : statuses) {
    callers.emplace_back([&] {
      v1::RenderFrameResponse response;
      status = render(frame_of(scene_), &response);
      control_->release();
    });
  }
  for (std::thread& caller : callers) caller.join();
  drawn.join();
  if (statuses[0].ok()) std::swap(statuses[0], statuses[1]);
  EXPECT_TRUE(statuses[1].ok());
  EXPECT_EQ(statuses[0].error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(error_info(statuses[0]).metadata().at("field"), "queued_frames");
}

TEST_F(RenderTest, SurvivesARendererWithoutMemory) {
  control_->run_out_of_memory();
  v1::RenderFrameResponse response;
  EXPECT_EQ(render(frame_of(scene_), &response).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(render(frame_of(scene_), &response).ok());
}

TEST_F(RenderTest, DrawsWhileTheSceneIsDeleted) {
  control_->hold();
  v1::RenderFrameResponse response;
  std::thread caller([&] { EXPECT_TRUE(render(frame_of(scene_), &response).ok()); });
  control_->wait_for_started(1);
  Context context;
  v1::DeleteSceneRequest request;
  request.set_name(scene_);
  google::protobuf::Empty empty;
  ASSERT_TRUE(scenes_->DeleteScene(&context, request, &empty).ok());
  control_->release();
  caller.join();
  EXPECT_EQ(response.scene_revision(), 3u);
}

TEST_F(RenderTest, RefusesARevisionThatIsNotThere) {
  v1::RenderFrameRequest request = frame_of(scene_);
  v1::RenderFrameResponse response;
  request.set_min_revision(get_scene(scene_).revision());
  EXPECT_TRUE(render(request, &response).ok());
  request.set_min_revision(request.min_revision() + 1);
  const grpc::Status status = render(request, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(error_info(status).metadata().at("field"), "min_revision");
  EXPECT_EQ(control_->started(), 1);
}

}  // namespace
}  // namespace diaphane::e2e
