// Answers to calls with one request and one response.
#pragma once

#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/server_callback.h"
// fill() looks for to_proto() among these.
#include "service/convert/deletion.h"
#include "service/convert/environment.h"
#include "service/convert/light.h"
#include "service/convert/material.h"
#include "service/convert/mesh.h"
#include "service/convert/scene.h"
#include "service/convert/status.h"
#include "service/reply_memory.h"

namespace diaphane::service {

/// Finishes a call whose response is made.
grpc::ServerUnaryReactor* answer(grpc::CallbackServerContext* context, const absl::Status& status);

/// Writes `result` to `message`, or returns its error.
template <typename T, typename Message>
absl::Status fill(const absl::StatusOr<T>& result, Message& message) {
  if (!result.ok()) return result.status();
  to_proto(*result, message);
  return absl::OkStatus();
}

/// Runs `apply(response)`, unless a call with the same request id did: then the response is that call's.
template <typename Request, typename Response, typename Apply>
absl::Status apply_once(ReplyMemory& replies, std::string_view method, const Request& request, Response& response,
                        const Apply& apply) {
  absl::StatusOr<ReplyMemory::Call> call = replies.begin(method, request.request_id(), request.SerializeAsString());
  if (!call.ok()) return call.status();
  if (const std::optional<std::string>& reply = call->reply()) {
    response.ParseFromString(*reply);
    return absl::OkStatus();
  }
  absl::Status status = apply(response);
  if (status.ok()) call->remember(response.SerializeAsString());
  return status;
}

}  // namespace diaphane::service
