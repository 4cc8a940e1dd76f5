#include "service/server_service.h"

#include <utility>

#include "service/convert/server_info.h"
#include "service/unary.h"

namespace diaphane::service {

ServerService::ServerService(std::string version, const ServiceLimits& limits, const render::RendererInfo& renderer) {
  info_.set_version(std::move(version));
  to_proto(renderer, info_);
  to_proto(limits, *info_.mutable_limits());
}

grpc::ServerUnaryReactor* ServerService::GetServerInfo(grpc::CallbackServerContext* context,
                                                       const v1::GetServerInfoRequest*, v1::ServerInfo* response) {
  *response = info_;
  return answer(context, absl::OkStatus());
}

}  // namespace diaphane::service
