#include "edit_call.h"

#include "aliased_message.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
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

bool EditCall::write_payload(const std::shared_ptr<const std::string>& payload, size_t first, size_t count) {
  std::string tag;
  {
    google::protobuf::io::StringOutputStream stream(&tag);
    google::protobuf::io::CodedOutputStream out(&stream);
    constexpr uint32_t kLengthDelimited = 2;
    out.WriteTag(v1::EditSceneRequest::kPayloadFieldNumber << 3 | kLengthDelimited);
    out.WriteVarint64(count);
  }
  const grpc::Slice slices[] = {grpc::Slice(tag), aliased_slice(payload->data() + first, count, payload)};
  call_->Write({slices, 2}, nullptr);
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
