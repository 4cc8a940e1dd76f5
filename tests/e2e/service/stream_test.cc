// Frames as a scene changes, by gRPC.
#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "encode/h264.h"
#include "tests/e2e/service/test_server.h"
#include "tests/support/h264_decoder.h"

namespace diaphane::e2e {
namespace {

using Stream = grpc::ClientReaderWriter<v1::StreamFramesRequest, v1::StreamFramesResponse>;

class StreamTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    create_mesh(scene_);
  }

  static v1::StreamView view(uint64_t sequence, bool lossless_at_rest = false) {
    v1::StreamView view;
    view.set_sequence(sequence);
    *view.mutable_camera() = frame_of("").camera();
    *view.mutable_size() = frame_of("").size();
    view.mutable_moving()->set_format(v1::IMAGE_FORMAT_JPEG);
    view.set_lossless_at_rest(lossless_at_rest);
    return view;
  }

  std::unique_ptr<Stream> open(grpc::ClientContext* context, const v1::StreamView& view, uint32_t credits) {
    auto stream = frames_->StreamFrames(context);
    v1::StreamFramesRequest request;
    request.mutable_opening()->set_scene(scene_);
    *request.mutable_opening()->mutable_view() = view;
    request.mutable_opening()->set_credits(credits);
    stream->Write(request);
    return stream;
  }

  std::unique_ptr<Stream> open_every_revision(grpc::ClientContext* context, uint32_t credits) {
    auto stream = frames_->StreamFrames(context);
    v1::StreamFramesRequest request;
    request.mutable_opening()->set_scene(scene_);
    *request.mutable_opening()->mutable_view() = view(1);
    request.mutable_opening()->set_credits(credits);
    request.mutable_opening()->set_every_revision(true);
    stream->Write(request);
    return stream;
  }

  static void grant(Stream& stream, uint32_t credits) {
    v1::StreamFramesRequest request;
    request.set_credits(credits);
    stream.Write(request);
  }

  /// The next frame, heartbeats passed over.
  static v1::StreamedFrame next(Stream& stream) {
    v1::StreamFramesResponse response;
    while (stream.Read(&response)) {
      if (response.has_frame()) return response.frame();
    }
    ADD_FAILURE() << "the stream ended: " << stream.Finish().error_message();
    return {};
  }

  static grpc::Status end(Stream& stream) {
    stream.WritesDone();
    v1::StreamFramesResponse response;
    while (stream.Read(&response)) {
    }
    return stream.Finish();
  }

  /// Raises the scene's revision by one, and says to what.
  uint64_t change() {
    grpc::ClientContext context;
    v1::UpdateSceneRequest request;
    request.mutable_scene()->set_name(scene_);
    request.mutable_scene()->set_display_name("changed");
    request.mutable_update_mask()->add_paths("display_name");
    v1::Scene scene;
    EXPECT_TRUE(scenes_->UpdateScene(&context, request, &scene).ok());
    return scene.revision();
  }

  void expect_refused(Stream& stream, grpc::StatusCode code, const std::string& field) {
    v1::StreamFramesResponse response;
    while (stream.Read(&response)) {
    }
    const grpc::Status status = stream.Finish();
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    if (field.empty()) return;
    EXPECT_EQ(error_info(status).metadata().at("field"), field);
  }

  std::string scene_;
};

TEST_F(StreamTest, ShowsTheSceneThenEveryChangeThatIsWaitedFor) {
  grpc::ClientContext context;
  const auto stream = open(&context, view(7), 8);
  const v1::StreamedFrame first = next(*stream);
  EXPECT_EQ(first.view_sequence(), 7u);
  EXPECT_EQ(first.frame().content_type(), "image/jpeg");
  EXPECT_EQ(first.frame().scene_revision(), get_scene(scene_).revision());
  EXPECT_FALSE(first.at_rest());
  for (int i = 0; i < 3; ++i) {
    const uint64_t revision = change();
    EXPECT_EQ(next(*stream).frame().scene_revision(), revision);
  }
  EXPECT_TRUE(end(*stream).ok());
  EXPECT_EQ(control_->started(), 4);
}

TEST_F(StreamTest, ShowsANewViewOfAnOldScene) {
  grpc::ClientContext context;
  const auto stream = open(&context, view(1), 8);
  next(*stream);
  v1::StreamFramesRequest request;
  *request.mutable_view() = view(2);
  request.mutable_view()->mutable_size()->set_width_px(32);
  stream->Write(request);
  const v1::StreamedFrame frame = next(*stream);
  EXPECT_EQ(frame.view_sequence(), 2u);
  EXPECT_EQ(frame.frame().size().width_px(), 32u);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, SendsNoMoreThanWasGrantedAndThenTheNewest) {
  grpc::ClientContext context;
  const auto stream = open(&context, view(1), 1);
  next(*stream);
  uint64_t newest = 0;
  for (int i = 0; i < 20; ++i) newest = change();
  EXPECT_EQ(control_->started(), 1);
  grant(*stream, 1);
  EXPECT_EQ(next(*stream).frame().scene_revision(), newest);
  EXPECT_TRUE(end(*stream).ok());
  EXPECT_EQ(control_->started(), 2);
}

TEST_F(StreamTest, PassesOverWhatChangedWhileAFrameWasDrawn) {
  grpc::ClientContext context;
  control_->hold();
  const auto stream = open(&context, view(1), 8);
  control_->wait_for_started(1);
  uint64_t newest = 0;
  for (int i = 0; i < 50; ++i) newest = change();
  control_->release();
  // The first, which is older, may come before the newest, and never after it.
  int seen = 1;
  while (next(*stream).frame().scene_revision() != newest) ++seen;
  EXPECT_LE(seen, 2);
  EXPECT_TRUE(end(*stream).ok());
  EXPECT_EQ(control_->started(), 2);
}

TEST_F(StreamTest, AtRestSendsRenderFramesOwnPngAndThenNothing) {
  grpc::ClientContext context;
  const auto stream = open(&context, view(1, true), 8);
  EXPECT_EQ(next(*stream).frame().content_type(), "image/jpeg");
  const v1::StreamedFrame still = next(*stream);
  EXPECT_TRUE(still.at_rest());
  EXPECT_EQ(still.frame().content_type(), "image/png");
  v1::RenderFrameRequest request;
  request.set_scene(scene_);
  *request.mutable_camera() = view(1).camera();
  *request.mutable_size() = view(1).size();
  v1::RenderFrameResponse frame;
  grpc::ClientContext of_frame;
  ASSERT_TRUE(frames_->RenderFrame(&of_frame, request, &frame).ok());
  EXPECT_EQ(still.frame().image(), frame.image());
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  EXPECT_EQ(control_->started(), 3);
  const uint64_t revision = change();
  EXPECT_EQ(next(*stream).frame().scene_revision(), revision);
  EXPECT_TRUE(next(*stream).at_rest());
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, WaitsForTheRevisionThatItIsToldToAndForAMesh) {
  const uint64_t now = get_scene(scene_).revision();
  v1::StreamView later = view(1);
  later.set_min_revision(now + 2);
  {
    grpc::ClientContext context;
    const auto stream = open(&context, later, 8);
    change();
    EXPECT_EQ(change(), now + 2);
    EXPECT_EQ(next(*stream).frame().scene_revision(), now + 2);
    EXPECT_TRUE(end(*stream).ok());
  }
  scene_ = create_scene().name();
  grpc::ClientContext context;
  const auto stream = open(&context, view(1), 8);
  create_mesh(scene_);
  EXPECT_EQ(next(*stream).frame().scene_revision(), get_scene(scene_).revision());
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, SendsEveryRevisionInOrderWhereAsked) {
  grpc::ClientContext context;
  const uint64_t first = get_scene(scene_).revision();
  const auto stream = open_every_revision(&context, 3);
  EXPECT_EQ(next(*stream).frame().scene_revision(), first);
  for (int i = 0; i < 60; ++i) change();
  for (uint64_t revision = first + 1; revision <= first + 60; ++revision) {
    const v1::StreamedFrame frame = next(*stream);
    ASSERT_EQ(frame.frame().scene_revision(), revision);
    EXPECT_FALSE(frame.reduced());
    grant(*stream, 1);
  }
  EXPECT_TRUE(end(*stream).ok());
  EXPECT_EQ(control_->started(), 61);
}

TEST_F(StreamTest, EndsRatherThanLeaveARevisionOut) {
  grpc::ClientContext context;
  const auto stream = open_every_revision(&context, 1);
  next(*stream);
  for (int i = 0; i < 70; ++i) change();
  expect_refused(*stream, grpc::StatusCode::RESOURCE_EXHAUSTED, "every_revision");
}

TEST_F(StreamTest, HoldsABandwidthThenShowsWhatWasAskedFor) {
  grpc::ClientContext context;
  v1::StreamView narrow = view(1);
  narrow.set_bytes_per_second(10'000);
  const auto stream = open(&context, narrow, 64);
  const auto begin = std::chrono::steady_clock::now();
  size_t bytes = 0;
  bool reduced = false;
  for (int i = 0; i < 12; ++i) {
    const uint64_t revision = change();
    v1::StreamedFrame frame = next(*stream);
    for (; frame.frame().scene_revision() < revision; frame = next(*stream)) bytes += frame.frame().image().size();
    bytes += frame.frame().image().size();
    reduced = reduced || frame.reduced();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_TRUE(reduced);
  EXPECT_LT(static_cast<double>(bytes), 10'000 * (seconds + 0.5));
  v1::StreamedFrame last = next(*stream);
  EXPECT_FALSE(last.reduced());
  EXPECT_EQ(last.frame().size().width_px(), narrow.size().width_px());
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, SendsNoMoreFramesASecondThanAsked) {
  grpc::ClientContext context;
  v1::StreamView slow = view(1);
  slow.set_frames_per_second(20);
  const auto stream = open(&context, slow, 64);
  next(*stream);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 10; ++i) {
    change();
    next(*stream);
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(445));
  EXPECT_TRUE(end(*stream).ok());
}

/// A view that comes as video.
v1::StreamView as_video(v1::StreamView view) {
  view.mutable_size()->set_width_px(64);
  view.mutable_size()->set_height_px(48);
  view.mutable_moving()->set_format(v1::IMAGE_FORMAT_H264);
  return view;
}

TEST_F(StreamTest, SendsVideoWhoseEveryFrameDecodesAtOnce) {
  if (encode::h264_encoder().empty()) GTEST_SKIP() << "no encoder of H.264 here";
  grpc::ClientContext context;
  const auto stream = open(&context, as_video(view(1)), 2);
  testing_support::H264Decoder decoder;
  uint64_t revision = get_scene(scene_).revision();
  for (int i = 0; i < 40; ++i) {
    const v1::StreamedFrame frame = next(*stream);
    EXPECT_EQ(frame.frame().scene_revision(), revision);
    EXPECT_EQ(frame.frame().content_type(), "video/h264");
    EXPECT_EQ(frame.key_frame(), i == 0);
    EXPECT_EQ(frame.frame().stages(frame.frame().stages_size() - 1).stage(), "encode");
    const auto decoded = decoder.decode(frame.frame().image());
    ASSERT_TRUE(decoded.has_value()) << "frame " << i;
    EXPECT_EQ(decoded->width_px, 64);
    revision = change();
    grant(*stream, 1);
  }
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, SendsAKeyFrameWhereNothingChangesAndALosslessOneAtRest) {
  if (encode::h264_encoder().empty()) GTEST_SKIP() << "no encoder of H.264 here";
  grpc::ClientContext context;
  const auto stream = open(&context, as_video(view(1, true)), 8);
  EXPECT_TRUE(next(*stream).key_frame());
  const v1::StreamedFrame still = next(*stream);
  EXPECT_TRUE(still.at_rest());
  EXPECT_EQ(still.frame().content_type(), "image/png");
  v1::StreamFramesRequest request;
  request.mutable_key_frame();
  stream->Write(request);
  const v1::StreamedFrame key = next(*stream);
  EXPECT_TRUE(key.key_frame());
  EXPECT_TRUE(testing_support::H264Decoder().decode(key.frame().image()).has_value());
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, ViewersOfVideoMayLeaveAtAnyTime) {
  if (encode::h264_encoder().empty()) GTEST_SKIP() << "no encoder of H.264 here";
  v1::StreamView large = as_video(view(1));
  large.mutable_size()->set_width_px(1280);
  large.mutable_size()->set_height_px(720);
  for (int i = 0; i < 20; ++i) {
    grpc::ClientContext context;
    const auto stream = open(&context, large, 8);
    change();
    // While the first frame is drawn, or encoded, or written.
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * i));
    context.TryCancel();
    v1::StreamFramesResponse response;
    while (stream->Read(&response)) {
    }
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  grpc::ClientContext context;
  const auto stream = open(&context, as_video(view(1)), 1);
  EXPECT_TRUE(next(*stream).key_frame());
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, LeavesNoFrameOfAVideoOutWhateverTheViewerIsLike) {
  if (encode::h264_encoder().empty()) GTEST_SKIP() << "no encoder of H.264 here";
  grpc::ClientContext context;
  const auto stream = open(&context, as_video(view(1)), 32);
  testing_support::H264Decoder decoder;
  uint64_t newest = 0;
  for (int i = 0; i < 100; ++i) newest = change();
  uint64_t before = 0;
  while (before < newest) {
    const v1::StreamedFrame frame = next(*stream);
    ASSERT_GT(frame.frame().scene_revision(), before);
    before = frame.frame().scene_revision();
    ASSERT_TRUE(decoder.decode(frame.frame().image()).has_value());
    grant(*stream, 1);
  }
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, EndsWithTheScene) {
  grpc::ClientContext context;
  const auto stream = open(&context, view(1), 8);
  next(*stream);
  grpc::ClientContext of_deletion;
  v1::DeleteSceneRequest request;
  request.set_name(scene_);
  google::protobuf::Empty nothing;
  ASSERT_TRUE(scenes_->DeleteScene(&of_deletion, request, &nothing).ok());
  expect_refused(*stream, grpc::StatusCode::NOT_FOUND, "");
}

TEST_F(StreamTest, RefusesWhatItCannotShowAndNamesIt) {
  const auto refuses = [&](const v1::StreamFramesRequest& request, grpc::StatusCode code, const std::string& field) {
    grpc::ClientContext context;
    const auto stream = frames_->StreamFrames(&context);
    stream->Write(request);
    expect_refused(*stream, code, field);
  };
  v1::StreamFramesRequest request;
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "part");
  request.set_credits(1);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "part");
  request.mutable_opening()->set_scene(scene_);
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->set_credits(65);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "credits");
  request.mutable_opening()->set_credits(1);
  request.mutable_opening()->mutable_view()->mutable_size()->set_width_px(0);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "size.width_px");
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->mutable_view()->mutable_moving()->set_format(v1::IMAGE_FORMAT_EXR);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "moving.format");
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->mutable_view()->mutable_settings()->set_technique(v1::TECHNIQUE_REFERENCE);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "settings.technique");
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->mutable_view()->set_frames_per_second(241);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "frames_per_second");
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->mutable_view()->set_bytes_per_second(9999);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "bytes_per_second");
  request.mutable_opening()->mutable_view()->set_bytes_per_second(10'000);
  request.mutable_opening()->set_every_revision(true);
  refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "bytes_per_second");
  request.mutable_opening()->set_every_revision(false);
  if (!encode::h264_encoder().empty()) {
    *request.mutable_opening()->mutable_view() = as_video(view(1));
    request.mutable_opening()->mutable_view()->mutable_size()->set_width_px(65);
    refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "size.width_px");
    *request.mutable_opening()->mutable_view() = as_video(view(1));
    request.mutable_opening()->mutable_view()->mutable_moving()->set_bits_per_second(9999);
    refuses(request, grpc::StatusCode::INVALID_ARGUMENT, "encoding.bits_per_second");
  }
  *request.mutable_opening()->mutable_view() = view(1);
  *request.mutable_opening()->mutable_view() = view(1);
  request.mutable_opening()->set_scene("scenes/0");
  refuses(request, grpc::StatusCode::NOT_FOUND, "scene");

  grpc::ClientContext context;
  const auto stream = open(&context, view(5), 4);
  v1::StreamFramesRequest again;
  *again.mutable_view() = view(5);
  stream->Write(again);
  expect_refused(*stream, grpc::StatusCode::INVALID_ARGUMENT, "view.sequence");
}

TEST_F(StreamTest, CancelledWhileAFrameIsDrawnLeavesNothingBehind) {
  control_->hold();
  {
    grpc::ClientContext context;
    const auto stream = open(&context, view(1, true), 8);
    control_->wait_for_started(1);
    context.TryCancel();
    v1::StreamFramesResponse response;
    while (stream->Read(&response)) {
    }
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  control_->release();
  grpc::ClientContext context;
  const auto stream = open(&context, view(1), 1);
  EXPECT_GT(next(*stream).frame().image().size(), 0u);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(StreamTest, IsToldThatTheServerStopsAndDoesNotHoldItUp) {
  grpc::ClientContext context, of_edits;
  const auto stream = open(&context, view(1), 8);
  next(*stream);
  const auto edits = scenes_->EditScene(&of_edits);
  v1::EditSceneRequest request;
  request.mutable_opening()->set_scene(scene_);
  edits->Write(request);
  // Its answer says that the call has come to the server, which refuses those that come later.
  request.set_shared_memory_bytes(65536);
  edits->Write(request);
  v1::EditSceneResponse response;
  ASSERT_TRUE(edits->Read(&response));
  const auto begin = std::chrono::steady_clock::now();
  std::thread stopper([&] { server_->stop(absl::Seconds(60)); });
  expect_refused(*stream, grpc::StatusCode::UNAVAILABLE, "");
  while (edits->Read(&response)) {
  }
  EXPECT_EQ(edits->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  stopper.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST_F(StreamTest, ManyViewersOfAChangingSceneAllSeeItsEnd) {
  std::vector<std::future<uint64_t>> seen;
  const uint64_t last = get_scene(scene_).revision() + 60;
  for (int viewer = 0; viewer < 8; ++viewer) {
    seen.push_back(std::async(std::launch::async, [&] {
      grpc::ClientContext context;
      const auto stream = open(&context, view(1), 4);
      uint64_t before = 0;
      while (before < last) {
        const uint64_t revision = next(*stream).frame().scene_revision();
        EXPECT_GT(revision, before);
        if (revision <= before) break;
        before = revision;
        grant(*stream, 1);
      }
      EXPECT_TRUE(end(*stream).ok());
      return before;
    }));
  }
  for (int i = 0; i < 60; ++i) change();
  for (auto& viewer : seen) EXPECT_EQ(viewer.get(), last);
}

}  // namespace
}  // namespace diaphane::e2e
