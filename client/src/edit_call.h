// EditScene, without a copy of what is sent.
#pragma once

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "diaphane/v1/scene_service.pb.h"
#include "grpcpp/channel.h"
#include "grpcpp/completion_queue.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/impl/codegen/proto_utils.h"

namespace diaphane::internal {

/// One call of EditScene. One thread at a time.
class EditCall {
 public:
  explicit EditCall(const std::shared_ptr<grpc::Channel>& channel);
  /// Cancels what goes on.
  ~EditCall();

  EditCall(const EditCall&) = delete;
  EditCall& operator=(const EditCall&) = delete;

  /// Waits until gRPC takes more; false once the call broke. The request must not change before it is acknowledged.
  bool write(const std::shared_ptr<const v1::EditSceneRequest>& request);
  /// Bytes `first` to before `first` + `count` of a payload; they must not change any more.
  bool write_payload(const std::shared_ptr<const std::string>& payload, size_t first, size_t count);
  /// Waits for a response; false once there are no more.
  bool read(v1::EditSceneResponse* response);
  /// Why there are no more. Once, after a read that was false.
  absl::Status finish();

 private:
  bool wait();

  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::ClientAsyncReaderWriter<grpc::ByteBuffer, v1::EditSceneResponse>> call_;
  bool finished_ = false;
};

}  // namespace diaphane::internal
