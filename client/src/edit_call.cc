#include "edit_call.h"

#include "aliased_message.h"
#include "retry.h"

namespace diaphane::internal {

EditCall::EditCall(const std::shared_ptr<grpc::Channel>& channel) {
  grpc::TemplatedGenericStub<grpc::ByteBuffer, v1::EditSceneResponse> stub(channel);
  call_ = stub.PrepareCall(&context_, "/diaphane.v1.SceneService/EditScene", &queue_);
  call_->StartCall(nullptr);
  wait();  // where it fails, so does what follows
}

EditCall::~EditCall() {
  if (!finished_) {
    context_.TryCancel();
    finish().IgnoreError();
  }
  queue_.Shutdown();
  void* tag = nullptr;
  bool ok = false;
  while (queue_.Next(&tag, &ok)) {
  }
}

bool EditCall::write(const std::shared_ptr<const v1::EditSceneRequest>& request) {
  call_->Write(aliased_bytes(request), nullptr);
  return wait();
}

bool EditCall::read(v1::EditSceneResponse* response) {
  call_->Read(response, nullptr);
  return wait();
}

absl::Status EditCall::finish() {
  grpc::Status status;
  call_->Finish(&status, nullptr);
  wait();
  finished_ = true;
  return to_absl(status);
}

/// For the one operation that is under way.
bool EditCall::wait() {
  void* tag = nullptr;
  bool ok = false;
  return queue_.Next(&tag, &ok) && ok;
}

}  // namespace diaphane::internal
