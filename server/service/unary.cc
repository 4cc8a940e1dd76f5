#include "service/unary.h"

#include "base/log.h"

namespace diaphane::service {

grpc::ServerUnaryReactor* answer(grpc::CallbackServerContext* context, const absl::Status& status) {
  if (!status.ok()) spdlog::debug("call refused peer={} status=\"{}\"", context->peer(), status.ToString());
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(to_grpc(status));
  return reactor;
}

}  // namespace diaphane::service
