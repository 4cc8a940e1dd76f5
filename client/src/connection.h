// A channel, its stubs, and how calls are made on them.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "diaphane/v1/render_service.grpc.pb.h"
#include "diaphane/v1/scene_service.grpc.pb.h"
#include "diaphane/v1/server_service.grpc.pb.h"
#include "grpcpp/channel.h"
#include "retry.h"

namespace diaphane::internal {

using SceneStub = v1::SceneService::Stub;
using RenderStub = v1::RenderService::Stub;
using ServerStub = v1::ServerService::Stub;

/// A plain-text channel to what Client::connect takes, without a proxy and without gRPC's own retries.
std::shared_ptr<grpc::Channel> make_channel(const std::string& address);

/// Thread-safe.
class Connection {
 public:
  /// OK, or INVALID_ARGUMENT for an address that is neither HOST:PORT nor unix:PATH.
  static absl::Status check_address(std::string_view address);

  Connection(const std::string& address, ClientOptions options);

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }
  /// Whether the address says that the server is a process of this machine, or something here that leads to it.
  bool is_local() const { return is_local_; }
  const std::unique_ptr<SceneStub>& scene_service() const { return scene_service_; }
  const std::unique_ptr<RenderStub>& render_service() const { return render_service_; }
  const std::unique_ptr<ServerStub>& server_service() const { return server_service_; }

  /// Makes a call that may be repeated; see run_with_retries.
  absl::Status run(const std::function<grpc::Status(grpc::ClientContext&)>& attempt) const;
  /// The same, but ClientOptions::stop does not stop it.
  absl::Status run_to_the_end(const std::function<grpc::Status(grpc::ClientContext&)>& attempt) const;

  /// One unary call of the scene or render service, repeated as run() does.
  template <typename Stub, typename Request, typename Response>
  absl::StatusOr<Response> call(const std::unique_ptr<Stub>& stub,
                                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                                const Request& request) const {
    Response response;
    const absl::Status status =
        run([&](grpc::ClientContext& context) { return (stub.get()->*method)(&context, request, &response); });
    if (!status.ok()) return status;
    return response;
  }

  const ClientOptions& options() const { return options_; }

 private:
  ClientOptions options_;
  bool is_local_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<SceneStub> scene_service_;
  std::unique_ptr<RenderStub> render_service_;
  std::unique_ptr<ServerStub> server_service_;
};

/// 128 random bits in hexadecimal: the request_id by which the server knows a repeated mutation. Thread-safe.
std::string new_request_id();

}  // namespace diaphane::internal
