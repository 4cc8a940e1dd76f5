// EditScene, without a copy of what is sent.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "diaphane/v1/scene_service.pb.h"
#include "grpcpp/channel.h"
#include "grpcpp/completion_queue.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/impl/codegen/proto_utils.h"
#include "payload_memory.h"

namespace diaphane::internal {

/// One call of EditScene. One thread at a time.
class EditCall {
 public:
  /// `shares_memory`: whether payloads may lie in memory that is shared with the server, where it gives any.
  EditCall(const std::shared_ptr<grpc::Channel>& channel, bool shares_memory);
  /// Cancels what goes on.
  ~EditCall();

  EditCall(const EditCall&) = delete;
  EditCall& operator=(const EditCall&) = delete;

  /// Waits until gRPC takes more; false once the call broke. The request must not change before it is acknowledged.
  bool write(const std::shared_ptr<const v1::EditSceneRequest>& request);
  /// Has the server share memory for payloads of `count` bytes, unless it was asked for as much. Not between an edit
  /// and its payloads.
  void ask_for_shared(size_t count);
  /// Shared memory for a payload of `count` bytes; null where there is none, and then it is asked for: for edits to
  /// come.
  PayloadPtr take_shared(size_t count);
  /// Whether this call's server reads what lies there.
  bool shares(const SharedMemory& memory) const;
  /// Bytes `first` to before `first` + `count` of a payload; they must not change any more.
  bool write_payload(const PayloadPtr& payload, size_t first, size_t count);
  /// Waits for a response to an edit; false once there are no more.
  bool read(v1::EditSceneResponse* response);
  /// Why there are no more. Once, after a read that was false.
  absl::Status finish();

 private:
  bool wait();

  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::ClientAsyncReaderWriter<grpc::ByteBuffer, v1::EditSceneResponse>> call_;
  bool finished_ = false;
  const bool shares_memory_;
  uint64_t asked_bytes_ = 0;  // the most that were
  std::vector<std::shared_ptr<SharedMemory>> shared_;
};

}  // namespace diaphane::internal
