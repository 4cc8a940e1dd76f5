// Edits that come faster than frames are drawn.
#include <thread>

#include "tests/e2e/service/edit_fixture.h"

namespace diaphane::e2e {
namespace {

/// While a frame is being drawn.
class PacedEditTest : public EditTest {
 protected:
  void SetUp() override {
    EditTest::SetUp();
    control_->hold();
    viewer_ = std::thread([this] {
      v1::RenderFrameResponse response;
      drawn_ = render(frame_of(scene_), &response);
    });
    control_->wait_for_started(1);
  }
  void TearDown() override {
    control_->release();
    viewer_.join();
    EditTest::TearDown();
  }

  grpc::Status drawn_;

 private:
  std::thread viewer_;
};

TEST_F(PacedEditTest, AllAreAppliedInTheirOrder) {
  constexpr uint64_t kEdits = 100;
  Context context;
  const auto stream = open(&context);
  for (uint64_t i = 1; i <= kEdits; ++i) {
    ASSERT_TRUE(send(*stream, i, {moved({3}, {0, 0, static_cast<float>(i)})}));
  }
  const uint64_t before = get_scene(scene_).revision();
  EXPECT_GE(wait_for(*stream, kEdits), before);
  EXPECT_EQ(server_positions()[3].z, static_cast<float>(kEdits));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(PacedEditTest, StreamsMayEndWhileTheirNextEditIsHeldBack) {
  for (int i = 0; i < 300; ++i) {
    Context context;
    const auto stream = open(&context);
    for (uint64_t edit = 1; edit <= 20; ++edit) send(*stream, edit, {moved({3}, {0, 0, 1})});
    v1::EditSceneResponse response;
    EXPECT_TRUE(stream->Read(&response));
    // Anywhere between two alarms.
    std::this_thread::sleep_for(std::chrono::microseconds(i * 7));
    context.TryCancel();
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  EXPECT_EQ(server_positions()[3].z, 1);
}

TEST_F(PacedEditTest, AServerThatStopsEndsThemAtOnce) {
  Context context;
  const auto stream = open(&context);
  for (uint64_t edit = 1; edit <= 50; ++edit) send(*stream, edit, {moved({3}, {0, 0, 1})});
  v1::EditSceneResponse response;
  EXPECT_TRUE(stream->Read(&response));
  server_->stop(absl::ZeroDuration());
  EXPECT_EQ(end(*stream).error_code(), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace diaphane::e2e
