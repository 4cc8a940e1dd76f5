#pragma once

#include "absl/status/status.h"
#include "grpcpp/support/status.h"

namespace diaphane::service {

/// The same code and message. A status that names a field carries google.rpc details with the field, its value and its
/// range: ErrorInfo, and by code BadRequest, QuotaFailure or PreconditionFailure. Thread-safe.
grpc::Status to_grpc(const absl::Status& status);

}  // namespace diaphane::service
