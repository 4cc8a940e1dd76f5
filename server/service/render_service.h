#pragma once

#include "base/worker_pool.h"
#include "diaphane/v1/render_service.grpc.pb.h"
#include "scene/scene_store.h"
#include "service/limits.h"
#include "service/open_streams.h"
#include "session/render_thread.h"

namespace diaphane::service {

/// Frames of scenes. Thread-safe. What it borrows outlives it, and the server that serves it.
class RenderService final : public v1::RenderService::CallbackService {
 public:
  /// `workers` look for what is picked; `video` encodes what streams send as H.264.
  RenderService(const ServiceLimits& limits, scene::SceneStore& store, session::RenderThread& render_thread,
                base::WorkerPool& workers, base::WorkerPool& video, OpenStreams& open_streams)
      : limits_(limits),
        store_(store),
        render_thread_(render_thread),
        workers_(workers),
        video_(video),
        open_streams_(open_streams) {}

 private:
  grpc::ServerUnaryReactor* RenderFrame(grpc::CallbackServerContext* context, const v1::RenderFrameRequest* request,
                                        v1::RenderFrameResponse* response) override;
  grpc::ServerWriteReactor<v1::RenderFrameWithProgressResponse>* RenderFrameWithProgress(
      grpc::CallbackServerContext* context, const v1::RenderFrameRequest* request) override;

  grpc::ServerBidiReactor<v1::StreamFramesRequest, v1::StreamFramesResponse>* StreamFrames(
      grpc::CallbackServerContext* context) override;

  grpc::ServerUnaryReactor* Pick(grpc::CallbackServerContext* context, const v1::PickRequest* request,
                                 v1::PickResponse* response) override;

  const ServiceLimits limits_;
  scene::SceneStore& store_;
  session::RenderThread& render_thread_;
  base::WorkerPool& workers_;
  base::WorkerPool& video_;
  OpenStreams& open_streams_;
};

}  // namespace diaphane::service
