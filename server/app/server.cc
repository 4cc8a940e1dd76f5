#include "app/server.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "absl/cleanup/cleanup.h"
#include "absl/time/clock.h"
#include "app/listen_address.h"
#include "app/version.h"
#include "base/log.h"
#include "fmt/format.h"
#include "grpcpp/ext/proto_server_reflection_plugin.h"
#include "grpcpp/health_check_service_interface.h"
#include "grpcpp/resource_quota.h"
#include "grpcpp/server_builder.h"

namespace diaphane::app {
namespace {

constexpr size_t kUploadThreads = 2;
constexpr int kLookaheadBytes = 4 << 20;
constexpr int kHttp2FrameBytes = 1 << 20;
constexpr size_t kMaxWaitingUploads = 64;
constexpr size_t kVideoThreads = 2;
constexpr size_t kMaxWaitingVideo = 256;    // one a stream
constexpr int kMaxConcurrentStreams = 100;  // of one connection
constexpr int kMaxRequestBytes = 4 << 20;   // chunks are at most 1 MiB, and nothing else is near it
constexpr int kKeepaliveMs = 60'000;
constexpr int kKeepaliveTimeoutMs = 20'000;

// gRPC would take a Unix socket's path from a server that is alive.
absl::Status check_free(const std::string& unix_path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, unix_path.data(), unix_path.size());
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const absl::Cleanup close_probe = [probe] { close(probe); };
  if (connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) return absl::OkStatus();
  return absl::UnavailableError(fmt::format("a server listens on unix:{} already", unix_path));
}

absl::Status check_address(const ListenAddress& address, bool allow_public_plaintext) {
  if (!address.unix_path.empty()) return check_free(address.unix_path);
  if (address.is_local()) return absl::OkStatus();
  if (!allow_public_plaintext) {
    return absl::FailedPreconditionError(
        fmt::format("{} can be reached from other machines, and what is sent there can be read by others: listen on "
                    "loopback or a Unix socket, or say --allow-public-plaintext",
                    address.text()));
  }
  spdlog::warn("plain text on a public address address={}", address.text());
  return absl::OkStatus();
}

}  // namespace

Server::Server(const ServerOptions& options, std::unique_ptr<session::RenderThread> render_thread)
    : store_(options.limits.scene),
      workers_(kUploadThreads, kMaxWaitingUploads),
      video_(kVideoThreads, kMaxWaitingVideo),
      render_thread_(std::move(render_thread)),
      scene_service_(options.limits, store_, *render_thread_, workers_, open_streams_),
      render_service_(options.limits, store_, *render_thread_, workers_, video_, open_streams_),
      server_service_(kVersion, options.limits, render_thread_->info()) {}

absl::StatusOr<std::unique_ptr<Server>> Server::start(const ServerOptions& options,
                                                      const session::RendererFactory& make_renderer) {
  // What the address is wrong about should not take a context's time to tell.
  const absl::StatusOr<ListenAddress> address = parse_listen_address(options.listen);
  if (!address.ok()) return address.status();
  absl::Status allowed = check_address(*address, options.allow_public_plaintext);
  if (!allowed.ok()) return allowed;
  auto render_thread =
      session::RenderThread::start({.max_queued_frames = options.limits.max_queued_frames}, make_renderer);
  if (!render_thread.ok()) return render_thread.status();
  std::unique_ptr<Server> server(new Server(options, *std::move(render_thread)));
  if (absl::Status listening = server->listen(options); !listening.ok()) return listening;
  return server;
}

absl::Status Server::listen(const ServerOptions& options) {
  ListenAddress address = *parse_listen_address(options.listen);
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort(address.text(), grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&scene_service_);
  builder.RegisterService(&render_service_);
  builder.RegisterService(&server_service_);
  builder.SetMaxReceiveMessageSize(kMaxRequestBytes);
  builder.SetMaxSendMessageSize(-1);  // frames are bounded by max_pixels
  builder.SetResourceQuota(grpc::ResourceQuota("server").Resize(options.grpc_memory_bytes));
  // Two servers would share a port in silence.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxConcurrentStreams);
  // An edit of a large mesh is megabytes: it comes whole, in few frames, without waiting for the window to open.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, kLookaheadBytes);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kHttp2FrameBytes);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  // A Unix socket is for its owner alone.
  const mode_t mask = umask(0077);
  server_ = builder.BuildAndStart();
  umask(mask);
  if (server_ == nullptr || (address.unix_path.empty() && port == 0)) {
    return absl::UnavailableError(fmt::format("cannot listen on {}", address.text()));
  }
  // The health service knows no service but "" by itself.
  for (const char* service : {v1::SceneService::service_full_name(), v1::RenderService::service_full_name(),
                              v1::ServerService::service_full_name()}) {
    server_->GetHealthCheckService()->SetServingStatus(service, true);
  }
  address.port = port;
  address_ = address.text();
  return absl::OkStatus();
}

void Server::stop(absl::Duration drain) {
  if (server_ == nullptr) return;
  const absl::Time deadline = absl::Now() + drain;
  server_->GetHealthCheckService()->Shutdown();
  open_streams_.end_all();
  server_->Shutdown(absl::ToChronoTime(deadline));
  server_->Wait();
  server_.reset();
  render_thread_->stop(absl::InfinitePast());
}

Server::~Server() { stop(absl::ZeroDuration()); }

}  // namespace diaphane::app
