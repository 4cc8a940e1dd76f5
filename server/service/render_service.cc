#include "service/render_service.h"

#include <memory>
#include <utility>

#include "absl/synchronization/mutex.h"
#include "base/status.h"
#include "fmt/format.h"
#include "scene/pick.h"
#include "service/convert/frame.h"
#include "service/convert/pick.h"
#include "service/frame_stream.h"
#include "service/progress_reactor.h"
#include "service/unary.h"

namespace diaphane::service {
namespace {

/// One frame on its way. Finishes exactly once, when its job ends; a cancelled call ends its job. Deletes itself.
class FrameReactor final : public grpc::ServerUnaryReactor {
 public:
  FrameReactor(session::RenderThread& render_thread, session::FrameTask task, v1::RenderFrameResponse* response)
      : render_thread_(render_thread) {
    task.done = [this, response](absl::StatusOr<session::EncodedFrame> frame) {
      const absl::Status status = frame.status();
      if (status.ok()) to_proto(*std::move(frame), *response);
      Finish(to_grpc(status));
    };
    // gRPC binds the reactor, and may then cancel it, only after this.
    const auto job = render_thread_.submit(std::move(task));
    if (!job.ok()) {
      Finish(to_grpc(job.status()));
    } else {
      job_ = *job;
    }
  }

  void OnCancel() override {
    if (const auto job = job_.lock()) render_thread_.cancel(job);
  }

  void OnDone() override { delete this; }

 private:
  session::RenderThread& render_thread_;
  // Not an owner: a frame that waits for a slow client must not keep its scene alive.
  std::weak_ptr<session::FrameJob> job_;
};

/// The newest revision of a request's scene.
template <typename Request>
absl::StatusOr<scene::SnapshotPtr> scene_at(const scene::SceneStore& store, const Request& request) {
  absl::StatusOr<scene::SnapshotPtr> scene = store.scene({"scene", request.scene()});
  if (scene.ok() && (*scene)->revision < request.min_revision()) {
    return base::field_error(
        absl::StatusCode::kFailedPrecondition,
        {"min_revision", fmt::format("{}", request.min_revision()), fmt::format("at most {}", (*scene)->revision)});
  }
  return scene;
}

absl::StatusOr<session::FrameTask> make_task(const scene::SceneStore& store, const ServiceLimits& limits,
                                             const grpc::CallbackServerContext& context,
                                             const v1::RenderFrameRequest& request) {
  absl::StatusOr<session::FrameTask> task = from_proto(request, limits.max_pixels);
  if (!task.ok()) return task;
  if (task->encoding.format == encode::ImageFormat::kH264) {
    return base::invalid_field("encoding.format", "PNG, JPEG, EXR or WebP; H.264 is of StreamFrames", "H.264");
  }
  absl::StatusOr<scene::SnapshotPtr> scene = scene_at(store, request);
  if (!scene.ok()) return scene.status();
  if ((*scene)->meshes.empty()) {
    return base::field_error(absl::StatusCode::kFailedPrecondition,
                             {"scene", request.scene(), "a scene with a mesh in it"});
  }
  task->request.scene = *std::move(scene);
  task->deadline = absl::FromChrono(context.deadline());
  if (task->request.settings.technique == render::Technique::kReference) {
    task->time_limit = limits.max_reference_time;
    task->limit_field = "reference_seconds";
  }
  return task;
}

/// A stream that ends before it begins.
class RefusedStream final : public grpc::ServerWriteReactor<v1::RenderFrameWithProgressResponse> {
 public:
  explicit RefusedStream(const absl::Status& status) { Finish(to_grpc(status)); }
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerUnaryReactor* RenderService::RenderFrame(grpc::CallbackServerContext* context,
                                                     const v1::RenderFrameRequest* request,
                                                     v1::RenderFrameResponse* response) {
  absl::StatusOr<session::FrameTask> task = make_task(store_, limits_, *context, *request);
  if (!task.ok()) return answer(context, task.status());
  return new FrameReactor(render_thread_, *std::move(task), response);
}

grpc::ServerWriteReactor<v1::RenderFrameWithProgressResponse>* RenderService::RenderFrameWithProgress(
    grpc::CallbackServerContext* context, const v1::RenderFrameRequest* request) {
  absl::StatusOr<session::FrameTask> task = make_task(store_, limits_, *context, *request);
  if (!task.ok()) return new RefusedStream(task.status());
  return new ProgressReactor(render_thread_, *std::move(task));
}

grpc::ServerBidiReactor<v1::StreamFramesRequest, v1::StreamFramesResponse>* RenderService::StreamFrames(
    grpc::CallbackServerContext*) {
  return new FrameStream(store_, render_thread_, video_, limits_, open_streams_);
}

grpc::ServerUnaryReactor* RenderService::Pick(grpc::CallbackServerContext* context, const v1::PickRequest* request,
                                              v1::PickResponse* response) {
  const absl::StatusOr<PickQuery> query = from_proto(*request, limits_.max_pixels);
  if (!query.ok()) return answer(context, query.status());
  absl::StatusOr<scene::SnapshotPtr> scene = scene_at(store_, *request);
  if (!scene.ok()) return answer(context, scene.status());
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  const bool queued = workers_.try_submit([reactor, response, query = *query, scene = *std::move(scene)] {
    response->set_scene_revision(scene->revision);
    const auto picked = scene::pick(*scene, query.camera, query.size_px, query.pixel);
    if (picked.has_value()) to_proto(*picked, *response->mutable_point());
    reactor->Finish(grpc::Status::OK);
  });
  if (!queued) reactor->Finish(to_grpc(absl::ResourceExhaustedError("too many calls wait to be worked on")));
  return reactor;
}

}  // namespace diaphane::service
