#pragma once

#include <string>

#include "diaphane/v1/server_service.grpc.pb.h"
#include "render/frame.h"
#include "service/limits.h"

namespace diaphane::service {

/// What the server is. Thread-safe.
class ServerService final : public v1::ServerService::CallbackService {
 public:
  ServerService(std::string version, const ServiceLimits& limits, const render::RendererInfo& renderer);

 private:
  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context, const v1::GetServerInfoRequest*,
                                          v1::ServerInfo* response) override;

  v1::ServerInfo info_;
};

}  // namespace diaphane::service
