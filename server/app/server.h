// The whole server but its command line.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "base/worker_pool.h"
#include "grpcpp/server.h"
#include "scene/scene_store.h"
#include "service/limits.h"
#include "service/open_streams.h"
#include "service/render_service.h"
#include "service/scene_service.h"
#include "service/server_service.h"
#include "session/render_thread.h"

namespace diaphane::app {

struct ServerOptions {
  std::string listen = "127.0.0.1:7373";  ///< HOST:PORT, [IPV6]:PORT or unix:PATH; port 0 picks one
  bool allow_public_plaintext = false;    ///< listen where other machines can connect
  service::ServiceLimits limits;
  uint64_t grpc_memory_bytes = uint64_t{512} << 20;  ///< that gRPC may hold for calls and what they read
};

/// Scenes, a render thread and the gRPC services over them, with health and reflection. Thread-safe, but for stop().
class Server {
 public:
  /// Returns when clients can connect. Errors: INVALID_ARGUMENT or FAILED_PRECONDITION for the address, UNAVAILABLE
  /// when it cannot be had, and those of `make_renderer`.
  static absl::StatusOr<std::unique_ptr<Server>> start(const ServerOptions& options,
                                                       const session::RendererFactory& make_renderer);

  /// stop(absl::ZeroDuration()), unless it was stopped.
  ~Server();

  /// Health goes to NOT_SERVING and no call is accepted any more; those in flight have `drain` to end, the rest is
  /// cancelled. Once.
  void stop(absl::Duration drain);

  /// Where it listens, with the port that was picked.
  const std::string& address() const { return address_; }
  const render::RendererInfo& renderer() const { return render_thread_->info(); }
  const scene::SceneStore& scenes() const { return store_; }

 private:
  Server(const ServerOptions& options, std::unique_ptr<session::RenderThread> render_thread);

  absl::Status listen(const ServerOptions& options);

  // In the order of who borrows whom: the server ends first.
  scene::SceneStore store_;
  base::WorkerPool workers_;
  base::WorkerPool video_;
  service::OpenStreams open_streams_;
  std::unique_ptr<session::RenderThread> render_thread_;
  service::SceneService scene_service_;
  service::RenderService render_service_;
  service::ServerService server_service_;
  std::string address_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace diaphane::app
