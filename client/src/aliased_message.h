// Messages on their way out without a copy of their bytes.
#pragma once

#include <memory>

#include "google/protobuf/message_lite.h"
#include "grpcpp/support/byte_buffer.h"
#include "grpcpp/support/slice.h"

namespace diaphane::internal {

/// Bytes where they lie; `owner` keeps them alive until gRPC has sent them.
grpc::Slice aliased_slice(const void* bytes, size_t count, std::shared_ptr<const void> owner);

/// `message` as it travels. Its long strings are not copied: they are kept alive until gRPC has sent them, and the
/// message must not change while the buffer, or a copy of it, lives. Thread-safe.
grpc::ByteBuffer aliased_bytes(const std::shared_ptr<const google::protobuf::MessageLite>& message);

}  // namespace diaphane::internal
