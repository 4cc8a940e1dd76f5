#include "session/render_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <mutex>

#include "absl/time/clock.h"
#include "tests/fakes/fake_renderer.h"

namespace diaphane::session {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

using Answer = std::future<absl::StatusOr<EncodedFrame>>;

// A task whose answer comes in `answer`; a second answer would throw, and end the test.
FrameTask task(Answer& answer, uint64_t revision = 1) {
  auto promise = std::make_shared<std::promise<absl::StatusOr<EncodedFrame>>>();
  answer = promise->get_future();
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->revision = revision;
  FrameTask task;
  task.request.scene = std::move(scene);
  task.request.width_px = 4;
  task.request.height_px = 2;
  task.done = [promise](absl::StatusOr<EncodedFrame> result) { promise->set_value(std::move(result)); };
  return task;
}

bool answered(const Answer& answer) { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

class RenderThreadTest : public ::testing::Test {
 protected:
  void SetUp() override { start({}); }
  void TearDown() override { control_->release(); }

  void start(const RenderThreadOptions& options) {
    thread_.reset();
    thread_ = *RenderThread::start(options, fakes::fake_renderers(control_));
  }

  // A frame that the renderer has begun and does not end.
  std::shared_ptr<FrameJob> hold_one(Answer& answer) {
    control_->hold();
    auto job = *thread_->submit(task(answer));
    control_->wait_for_started(1);
    return job;
  }

  std::shared_ptr<fakes::RendererControl> control_ = std::make_shared<fakes::RendererControl>();
  std::unique_ptr<RenderThread> thread_;
};

TEST_F(RenderThreadTest, AnswersWithTheFrameAndItsStages) {
  Answer answer;
  ASSERT_TRUE(thread_->submit(task(answer, 7)).ok());
  const auto frame = answer.get();
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->scene_revision, 7u);
  EXPECT_EQ(frame->width_px, 4u);
  EXPECT_EQ(frame->height_px, 2u);
  EXPECT_EQ(frame->content_type, "image/png");
  EXPECT_EQ(frame->path, "fake");
  std::vector<std::string> stages;
  for (const render::StageTime& stage : frame->stages) stages.push_back(stage.stage);
  EXPECT_THAT(stages, ElementsAre("queue", "shade", "atlas", "encode"));
}

TEST_F(RenderThreadTest, GivesFramesBackToTheRendererBeforeTheNext) {
  for (uint64_t revision = 1; revision <= 3; ++revision) {
    Answer answer;
    ASSERT_TRUE(thread_->submit(task(answer, revision)).ok());
    ASSERT_TRUE(answer.get().ok());
  }
  thread_->recycle({2, 1, std::vector<uint8_t>(8, 77)});
  Answer answer;
  ASSERT_TRUE(thread_->submit(task(answer, 4)).ok());
  ASSERT_TRUE(answer.get().ok());
  std::vector<int> firsts;
  for (const base::Image8& image : control_->recycled()) firsts.push_back(image.rgba.at(0));
  EXPECT_THAT(firsts, IsSupersetOf({1, 2, 77}));
}

TEST_F(RenderThreadTest, TellsThatAFrameHasBegunWhileItIsDrawn) {
  control_->hold();
  std::promise<void> begun;
  Answer answer;
  FrameTask told = task(answer);
  told.begun = [&] { begun.set_value(); };
  ASSERT_TRUE(thread_->submit(std::move(told)).ok());
  begun.get_future().wait();
  EXPECT_FALSE(answered(answer));
  control_->release();
  EXPECT_TRUE(answer.get().ok());
}

TEST_F(RenderThreadTest, AsksForThePixelsThatTheFormatNeeds) {
  Answer answer;
  FrameTask exr = task(answer);
  exr.encoding.format = encode::ImageFormat::kExr;
  ASSERT_TRUE(thread_->submit(std::move(exr)).ok());
  EXPECT_EQ(answer.get()->content_type, "image/x-exr");
}

TEST_F(RenderThreadTest, DrawsInTheOrderOfSubmission) {
  start({.encode_threads = 1});
  absl::Mutex mutex;
  std::vector<uint64_t> order;
  std::vector<Answer> answers(8);
  for (uint64_t i = 0; i < answers.size(); ++i) {
    FrameTask next = task(answers[i], i);
    next.done = [&, done = std::move(next.done)](absl::StatusOr<EncodedFrame> result) {
      {
        absl::MutexLock lock(&mutex);
        order.push_back(result->scene_revision);
      }
      done(std::move(result));
    };
    ASSERT_TRUE(thread_->submit(std::move(next)).ok());
  }
  for (Answer& answer : answers) answer.wait();
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

TEST(FairSharesTest, GiveALightOneHalfOfTheTimeBesideAHeavyOne) {
  FairShares shares;
  const std::string light = "light", heavy = "heavy";
  const std::string* const both[] = {&heavy, &light};
  double light_ms = 0, heavy_ms = 0;
  for (int i = 0; i < 1020; ++i) {
    if (shares.choose(both) == 1) {
      shares.book(light, 1);
      light_ms += 1;
    } else {
      shares.book(heavy, 50);
      heavy_ms += 50;
    }
  }
  EXPECT_NEAR(light_ms / (light_ms + heavy_ms), 0.5, 0.01);
}

TEST(FairSharesTest, TakeNoTurnFromWhoIsLateNowAndThen) {
  FairShares shares;
  const std::string light = "light", heavy = "heavy";
  const std::string* const both[] = {&heavy, &light};
  double light_ms = 0, heavy_ms = 0;
  for (int i = 0; i < 5000; ++i) {
    const bool is_late = i % 60 == 0;
    if (shares.choose(std::span(both).first(is_late ? 1 : 2)) == 1) {
      shares.book(light, 1);
      light_ms += 1;
    } else {
      shares.book(heavy, 50);
      heavy_ms += 50;
    }
  }
  EXPECT_NEAR(light_ms / (light_ms + heavy_ms), 0.5, 0.02);
}

TEST(FairSharesTest, SaveNothingForWhoDidNotAsk) {
  FairShares shares;
  const std::string busy = "busy", late = "late";
  const std::string* const one[] = {&busy};
  for (int i = 0; i < 100; ++i) {
    shares.choose(one);
    shares.book(busy, 10);
  }
  const std::string* const both[] = {&busy, &late};
  int turns_of_late = 0;
  for (int i = 0; i < 20; ++i) {
    const bool is_late = shares.choose(both) == 1;
    shares.book(is_late ? late : busy, 10);
    turns_of_late += is_late ? 1 : 0;
  }
  EXPECT_NEAR(turns_of_late, 10, 1);
}

TEST_F(RenderThreadTest, DrawsTheSceneThatHadLessOfItsTimeFirst) {
  std::mutex mutex;
  std::vector<std::string> drawn;
  const auto named = [&](const std::string& name, Answer& answer) {
    FrameTask next = task(answer);
    auto scene = std::make_shared<scene::SceneSnapshot>();
    scene->name = name;
    next.request.scene = std::move(scene);
    next.latest = [&, name](render::FrameRequest&, encode::Encoding&) {
      const std::lock_guard lock(mutex);
      drawn.push_back(name);
      return true;
    };
    return next;
  };
  Answer answers[5];
  const std::string names[] = {"heavy", "heavy", "heavy", "light", "light"};
  control_->hold();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(thread_->submit(named(names[i], answers[i])).ok());
  control_->wait_for_started(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  control_->release();
  for (Answer& answer : answers) EXPECT_TRUE(answer.get().ok());
  // The first had 30 ms: both light ones come before the next.
  EXPECT_THAT(drawn, ElementsAre("heavy", "light", "light", "heavy", "heavy"));
}

TEST_F(RenderThreadTest, RefusesAJobWhenTheQueueIsFull) {
  start({.max_queued_frames = 2});
  Answer drawn, first, second, third;
  hold_one(drawn);
  ASSERT_TRUE(thread_->submit(task(first)).ok());
  ASSERT_TRUE(thread_->submit(task(second)).ok());
  const absl::Status full = thread_->submit(task(third)).status();
  EXPECT_EQ(full.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(std::string(full.message()), "queued_frames: must be at most 2, got 3");
  control_->release();
  EXPECT_TRUE(drawn.get().ok());
  EXPECT_TRUE(second.get().ok());
}

TEST_F(RenderThreadTest, EndsACancelledJobInTheQueueAtOnceAndFreesItsPlace) {
  start({.max_queued_frames = 1});
  Answer drawn, waiting, next;
  hold_one(drawn);
  const auto job = *thread_->submit(task(waiting));
  thread_->cancel(job);
  ASSERT_TRUE(answered(waiting));
  EXPECT_EQ(waiting.get().status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(thread_->submit(task(next)).ok());
  control_->release();
  EXPECT_TRUE(next.get().ok());
  EXPECT_EQ(control_->started(), 2);
}

TEST_F(RenderThreadTest, EndsACancelledJobThatIsBeingDrawn) {
  Answer drawn, next;
  thread_->cancel(hold_one(drawn));
  EXPECT_EQ(drawn.get().status().code(), absl::StatusCode::kCancelled);
  control_->release();
  ASSERT_TRUE(thread_->submit(task(next)).ok());
  EXPECT_TRUE(next.get().ok());
}

TEST_F(RenderThreadTest, DropsTheFrameOfARendererThatDidNotSeeTheCancellation) {
  control_->ignore_cancellation();
  Answer drawn, next;
  thread_->cancel(hold_one(drawn));
  EXPECT_EQ(drawn.get().status().code(), absl::StatusCode::kCancelled);
  control_->release();
  ASSERT_TRUE(thread_->submit(task(next)).ok());
  EXPECT_TRUE(next.get().ok());
}

TEST_F(RenderThreadTest, IgnoresACancellationAfterTheAnswer) {
  Answer answer;
  const auto job = *thread_->submit(task(answer));
  ASSERT_TRUE(answer.get().ok());
  thread_->cancel(job);
  EXPECT_EQ(control_->started(), 1);
}

TEST_F(RenderThreadTest, EndsAJobInTheQueueAtItsDeadline) {
  Answer drawn, waiting;
  hold_one(drawn);
  FrameTask hurried = task(waiting);
  hurried.deadline = absl::Now() + absl::Milliseconds(20);
  ASSERT_TRUE(thread_->submit(std::move(hurried)).ok());
  EXPECT_EQ(waiting.get().status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_FALSE(answered(drawn));
}

TEST_F(RenderThreadTest, EndsAJobThatIsBeingDrawnAtItsDeadline) {
  control_->hold();
  Answer drawn;
  FrameTask hurried = task(drawn);
  hurried.deadline = absl::Now() + absl::Milliseconds(20);
  ASSERT_TRUE(thread_->submit(std::move(hurried)).ok());
  EXPECT_EQ(drawn.get().status().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST_F(RenderThreadTest, EndsAJobThatIsDrawnForTooLong) {
  control_->hold();
  Answer drawn, next;
  FrameTask slow = task(drawn);
  slow.time_limit = absl::Milliseconds(20);
  slow.limit_field = "reference_seconds";
  ASSERT_TRUE(thread_->submit(std::move(slow)).ok());
  const absl::Status over = drawn.get().status();
  EXPECT_EQ(over.code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_EQ(std::string(over.message()), "reference_seconds: must be at most 0.02, got more");
  control_->release();
  ASSERT_TRUE(thread_->submit(task(next)).ok());
  EXPECT_TRUE(next.get().ok());
}

TEST_F(RenderThreadTest, CountsATimeLimitFromWhenTheRendererBegins) {
  Answer drawn, waiting, hurried;
  hold_one(drawn);
  FrameTask limited = task(waiting);
  limited.time_limit = absl::Milliseconds(1);
  ASSERT_TRUE(thread_->submit(std::move(limited)).ok());
  // By the time this one's deadline has passed, so would the other's limit have, if it ran.
  FrameTask late = task(hurried);
  late.deadline = absl::Now() + absl::Milliseconds(20);
  ASSERT_TRUE(thread_->submit(std::move(late)).ok());
  EXPECT_EQ(hurried.get().status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_FALSE(answered(waiting));
}

TEST_F(RenderThreadTest, SurvivesARendererThatRunsOutOfMemory) {
  control_->run_out_of_memory();
  Answer failed, next;
  ASSERT_TRUE(thread_->submit(task(failed)).ok());
  EXPECT_EQ(failed.get().status().code(), absl::StatusCode::kResourceExhausted);
  ASSERT_TRUE(thread_->submit(task(next)).ok());
  EXPECT_TRUE(next.get().ok());
}

TEST_F(RenderThreadTest, StopLetsJobsAtHandEnd) {
  Answer drawn, waiting;
  hold_one(drawn);
  ASSERT_TRUE(thread_->submit(task(waiting)).ok());
  std::thread stopper([&] { thread_->stop(absl::InfiniteFuture()); });
  Answer late;
  while (thread_->submit(task(late)).status().code() != absl::StatusCode::kUnavailable)
    absl::SleepFor(absl::Milliseconds(1));
  control_->release();
  stopper.join();
  EXPECT_TRUE(drawn.get().ok());
  EXPECT_TRUE(waiting.get().ok());
}

TEST_F(RenderThreadTest, StopEndsWhatIsLeftAtItsDeadline) {
  Answer drawn, waiting;
  hold_one(drawn);
  ASSERT_TRUE(thread_->submit(task(waiting)).ok());
  thread_->stop(absl::Now());
  EXPECT_EQ(drawn.get().status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(waiting.get().status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(thread_->submit(task(drawn)).status().code(), absl::StatusCode::kUnavailable);
}

TEST(RenderThreadStart, ReportsTheFactorysError) {
  const auto failed = RenderThread::start({}, []() -> absl::StatusOr<std::unique_ptr<render::FrameRenderer>> {
    return absl::UnavailableError("no EGL device");
  });
  EXPECT_EQ(failed.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(failed.status().message()), HasSubstr("no EGL device"));
}

TEST(RenderThreadStart, MakesTheRendererOnItsOwnThread) {
  std::thread::id made_on;
  const auto control = std::make_shared<fakes::RendererControl>();
  const auto thread = RenderThread::start({}, [&]() -> absl::StatusOr<std::unique_ptr<render::FrameRenderer>> {
    made_on = std::this_thread::get_id();
    return std::make_unique<fakes::FakeRenderer>(control);
  });
  ASSERT_TRUE(thread.ok());
  EXPECT_NE(made_on, std::this_thread::get_id());
  EXPECT_EQ((*thread)->info().gl_renderer, "fake renderer");
}

}  // namespace
}  // namespace diaphane::session
