#include "stream_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "animator.h"
#include "fmt/format.h"
#include "frame_sink.h"
#include "json.h"
#include "moving_plan.h"
#include "progress.h"
#include "scene_upload.h"
#include "status.h"

namespace diaphane::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMorphSeconds = 4;
constexpr uint64_t kMostBehind = 16;  // edits whose frames have not come, where all are wanted

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

/// Frames as they come, on a thread of their own.
class Viewer {
 public:
  Viewer(const Scene& scene, const StreamOptions& options, FrameSink& sink)
      : stream_(scene.stream(options)), sink_(sink), thread_([this] { run(); }) {}
  ~Viewer() {
    stream_.close();
    if (thread_.joinable()) thread_.join();
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Of an edit that makes `revision` of the scene.
  void sent(uint64_t revision) {
    const std::lock_guard lock(mutex_);
    if (first_ == 0) first_ = revision;
    sent_.push_back(Clock::now());
  }

  /// Waits for a frame of `revision` or later, or for the stream's end.
  void wait_for(uint64_t revision) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return shown_ >= revision || !status_.ok(); });
  }

  absl::Status finish() {
    stream_.close();
    thread_.join();
    if (!absl::IsCancelled(status_)) return status_;
    return absl::OkStatus();
  }

  uint64_t frames() const { return frames_; }
  const std::vector<double>& latency_ms() const { return latency_ms_; }
  uint64_t bytes() const { return bytes_; }

 private:
  void run() {
    while (true) {
      const absl::StatusOr<StreamedFrame> frame = stream_.next();
      const absl::Status status = frame.ok() ? take(*frame) : frame.status();
      const std::lock_guard lock(mutex_);
      if (frame.ok()) shown_ = frame->frame.scene_revision;
      if (!status.ok()) status_ = status;
      changed_.notify_all();
      if (!status.ok()) return;
    }
  }

  absl::Status take(const StreamedFrame& frame) {
    {
      const std::lock_guard lock(mutex_);
      const uint64_t revision = frame.frame.scene_revision;
      // The first shows the scene before any edit.
      if (first_ != 0 && revision >= first_) latency_ms_.push_back(1000 * seconds_since(sent_[revision - first_]));
      bytes_ += frame.frame.image.size();
      ++frames_;
    }
    return sink_.add(frame);
  }

  FrameStream stream_;
  FrameSink& sink_;
  std::mutex mutex_;
  std::condition_variable changed_;
  uint64_t first_ = 0;                   // the revision of the first edit
  std::vector<Clock::time_point> sent_;  // by edit
  std::vector<double> latency_ms_;
  uint64_t frames_ = 0, bytes_ = 0;
  uint64_t shown_ = 0;
  absl::Status status_;
  std::thread thread_;
};

absl::StatusOr<MovingPlan> plan_stream(const StreamArguments& arguments) {
  if (!arguments.loop.any()) return usage_error("MOTION", "give one of --morph sphere, --animation NAME");
  return plan_motion(arguments.render, motion_of(arguments.loop, arguments.seconds.value_or(kMorphSeconds)));
}

struct Streamed {
  uint64_t edits = 0, frames = 0, bytes = 0;
  double seconds = 0;
  std::vector<double> latency_ms;
};

absl::Status stream_scene(const StreamArguments& arguments, const MovingPlan& moving, const Scene& scene,
                          std::vector<MeshHandle> meshes, FrameSink& sink, Progress& progress, Streamed* out) {
  const RenderOptions& render = moving.plan.options;
  StreamOptions options;
  options.view = {
      .camera = render.camera, .size = render.size, .settings = render.settings, .moving = arguments.format};
  options.view.quality = arguments.quality;
  options.view.bits_per_second = arguments.bits_per_second;
  options.view.lossless_at_rest = false;
  options.every_revision = arguments.every_revision;
  Animator animator(*moving.motion, arguments.loop.morph.has_value(), scene, std::move(meshes),
                    {.compress = arguments.compress});
  const uint64_t edits =
      arguments.seconds
          ? static_cast<uint64_t>(std::max(1.0, std::round(*arguments.seconds * arguments.loop.edits_per_second)))
          : animator.edits();
  const absl::StatusOr<SceneDescription> before = scene.describe();
  if (!before.ok()) return before.status();
  const uint64_t rest = before->scene.revision;
  Viewer viewer(scene, options, sink);
  viewer.wait_for(rest);  // the first frame compiles what it needs
  const Clock::time_point begin = Clock::now();
  for (uint64_t i = 0; i < edits; ++i) {
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double>(i / arguments.loop.edits_per_second)));
    if (arguments.every_revision && i >= kMostBehind) viewer.wait_for(rest + i + 1 - kMostBehind);
    progress.bar(fmt::format("edit {} of {}", i + 1, edits), static_cast<double>(i) / static_cast<double>(edits));
    viewer.sent(rest + i + 1);
    if (absl::Status sent = animator.send(static_cast<uint32_t>(i % animator.edits())); !sent.ok()) return sent;
  }
  const absl::StatusOr<uint64_t> last = animator.flush();
  if (!last.ok()) return last.status();
  viewer.wait_for(*last);
  out->seconds = seconds_since(begin);
  if (absl::Status finished = viewer.finish(); !finished.ok()) return finished;
  out->edits = edits;
  out->frames = viewer.frames();
  out->bytes = viewer.bytes();
  out->latency_ms = viewer.latency_ms();
  return sink.finish();
}

void report(const GlobalOptions& global, const StreamArguments& arguments, const Streamed& streamed) {
  const double p50 = quantile(streamed.latency_ms, 0.5), p99 = quantile(streamed.latency_ms, 0.99);
  if (global.json && arguments.output != "-") {
    print_json(Json{{"output", arguments.output},
                    {"edits", streamed.edits},
                    {"frames", streamed.frames},
                    {"seconds", streamed.seconds},
                    {"bytes", streamed.bytes},
                    {"latency_ms", {{"p50", p50}, {"p99", p99}}}});
    return;
  }
  print_note(fmt::format("{} edits, {} frames in {:.1f} s ({:.1f} a second), {:.1f} ms from edit to frame (p99 {:.1f})",
                         streamed.edits, streamed.frames, streamed.seconds,
                         static_cast<double>(streamed.frames) / streamed.seconds, p50, p99));
}

}  // namespace

absl::Status run_stream(const GlobalOptions& global, const StreamArguments& given) {
  StreamArguments arguments = given;
  if (arguments.output.ends_with(".mp4")) arguments.every_revision = true;
  Progress progress;
  progress.step("reading");
  absl::StatusOr<MovingPlan> moving = plan_stream(arguments);
  progress.clear();
  if (!moving.ok()) return moving.status();
  for (const std::string& note : moving->plan.notes) print_note(note);
  const absl::StatusOr<std::unique_ptr<FrameSink>> sink =
      open_frame_sink(arguments.output, arguments.format, moving->plan.options.size, arguments.loop.edits_per_second);
  if (!sink.ok()) return sink.status();
  absl::StatusOr<UploadedScene> uploaded = upload_plan(global, &moving->plan, progress);
  if (!uploaded.ok()) return uploaded.status();
  Streamed streamed;
  const absl::Status status = stream_scene(arguments, *moving, uploaded->scene.scene(), std::move(uploaded->meshes),
                                           **sink, progress, &streamed);
  progress.clear();
  if (!status.ok()) return status;
  if (absl::Status removed = uploaded->scene.remove(); !removed.ok()) return removed;
  report(global, arguments, streamed);
  return absl::OkStatus();
}

}  // namespace diaphane::cli
