// Frames that say how far they are, and the reference's time limit.
#include <gmock/gmock.h>

#include <algorithm>
#include <thread>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class ProgressTest : public ServiceTest {
 protected:
  void SetUp() override { start_with({}); }

  void start_with(const service::ServiceLimits& limits) {
    start(limits);
    const std::string scene = create_scene().name();
    create_mesh(scene);
    request_ = frame_of(scene);
    request_.mutable_settings()->set_technique(v1::TECHNIQUE_REFERENCE);
  }

  v1::RenderFrameRequest request_;
};

TEST_F(ProgressTest, GrowsToOneAndThenComesTheFrame) {
  control_->tell({0.25, 0.5, 0.75});
  Context context;
  const auto reader = frames_->RenderFrameWithProgress(&context, request_);
  std::vector<float> shares;
  std::vector<v1::RenderFrameResponse> frames;
  v1::RenderFrameWithProgressResponse part;
  while (reader->Read(&part)) {
    if (part.has_frame()) {
      frames.push_back(part.frame());
    } else {
      EXPECT_TRUE(frames.empty());
      shares.push_back(part.progress());
    }
  }
  ASSERT_TRUE(reader->Finish().ok());
  ASSERT_GE(shares.size(), 2u);
  EXPECT_EQ(shares.front(), 0.25f);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(std::count(shares.begin(), shares.end(), 1.0f), 1);
  EXPECT_EQ(shares.back(), 1);
  ASSERT_EQ(frames.size(), 1u);
  v1::RenderFrameResponse unary;
  ASSERT_TRUE(render(request_, &unary).ok());
  EXPECT_EQ(frames[0].image(), unary.image());
}

TEST_F(ProgressTest, ComesAtMostAboutTenTimesASecond) {
  std::vector<double> shares;
  for (int i = 0; i < 100'000; ++i) shares.push_back(i / 100'000.0);
  control_->tell(shares);
  const absl::Time start = absl::Now();
  Context context;
  const auto reader = frames_->RenderFrameWithProgress(&context, request_);
  int words = 0;
  v1::RenderFrameWithProgressResponse part;
  while (reader->Read(&part)) words += part.has_frame() ? 0 : 1;
  ASSERT_TRUE(reader->Finish().ok());
  EXPECT_LE(words, 2 + 10 * absl::ToDoubleSeconds(absl::Now() - start));
}

TEST_F(ProgressTest, StopsTheFrameOfACallerWhoGoes) {
  control_->tell({0.1});
  control_->hold();
  {
    Context context;
    const auto reader = frames_->RenderFrameWithProgress(&context, request_);
    v1::RenderFrameWithProgressResponse part;
    ASSERT_TRUE(reader->Read(&part));
    control_->wait_for_started(1);
    context.TryCancel();
    while (reader->Read(&part)) {
    }
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  // The renderer, still held, has seen it: another frame starts.
  std::thread second([&] {
    v1::RenderFrameResponse response;
    EXPECT_TRUE(render(request_, &response).ok());
  });
  control_->wait_for_started(2);
  control_->release();
  second.join();
}

TEST_F(ProgressTest, SurvivesACallerWhoNeverReads) {
  control_->tell({0.1, 0.2});
  {
    Context context;
    const auto reader = frames_->RenderFrameWithProgress(&context, request_);
    control_->wait_for_started(1);
    context.TryCancel();
    reader->Finish();
  }
  v1::RenderFrameResponse response;
  EXPECT_TRUE(render(request_, &response).ok());
}

TEST_F(ProgressTest, EndsWithTheServer) {
  control_->tell({0.1});
  control_->hold();
  Context context;
  const auto reader = frames_->RenderFrameWithProgress(&context, request_);
  v1::RenderFrameWithProgressResponse part;
  ASSERT_TRUE(reader->Read(&part));
  server_->stop(absl::ZeroDuration());
  while (reader->Read(&part)) {
  }
  EXPECT_FALSE(reader->Finish().ok());
}

TEST_F(ProgressTest, EndsWithTheErrorOfTheRenderer) {
  control_->tell({0.1});
  control_->run_out_of_memory();
  Context context;
  const auto reader = frames_->RenderFrameWithProgress(&context, request_);
  v1::RenderFrameWithProgressResponse part;
  while (reader->Read(&part)) EXPECT_FALSE(part.has_frame());
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(ProgressTest, ReferenceEndsAtItsTimeLimitAndTheOthersDoNot) {
  service::ServiceLimits limits;
  limits.max_reference_time = absl::Milliseconds(30);
  start_with(limits);
  v1::ServerInfo info;
  {
    Context context;
    ASSERT_TRUE(info_->GetServerInfo(&context, {}, &info).ok());
  }
  EXPECT_EQ(info.limits().max_reference_seconds(), 0.03);
  control_->hold();
  v1::RenderFrameResponse response;
  const grpc::Status over = render(request_, &response);
  EXPECT_EQ(over.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_EQ(error_info(over).metadata().at("field"), "reference_seconds");
  EXPECT_EQ(error_info(over).metadata().at("range"), "at most 0.03");
  {
    Context context;
    const auto reader = frames_->RenderFrameWithProgress(&context, request_);
    v1::RenderFrameWithProgressResponse part;
    EXPECT_FALSE(reader->Read(&part));
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  }
  request_.mutable_settings()->set_technique(v1::TECHNIQUE_INTEGRAL);
  std::thread other([&] { EXPECT_TRUE(render(request_, &response).ok()); });
  control_->wait_for_started(3);
  absl::SleepFor(2 * limits.max_reference_time);
  control_->release();
  other.join();
}

}  // namespace
}  // namespace diaphane::e2e
