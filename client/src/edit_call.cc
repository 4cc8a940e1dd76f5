#include "edit_call.h"

#include <algorithm>
#include <utility>

#include "aliased_message.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
#include "retry.h"

namespace diaphane::internal {
namespace {

// One is read, one is on its way, one is made.
constexpr uint64_t kPayloadsAtOnce = 3;
constexpr uint64_t kOverhead = 64;  // of each: where it begins
// The server gives no more.
constexpr uint64_t kMostSharedBytes = uint64_t{64} << 20;

}  // namespace

EditCall::EditCall(const std::shared_ptr<grpc::Channel>& channel, bool shares_memory) : shares_memory_(shares_memory) {
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

void EditCall::ask_for_shared(size_t count) {
  const uint64_t wanted = kPayloadsAtOnce * (count + kOverhead);
  if (!shares_memory_ || count == 0 || wanted <= asked_bytes_ || wanted > kMostSharedBytes) return;
  // Twice as much as before at least: few are asked for however sizes grow.
  asked_bytes_ = std::min(std::max(wanted, 2 * asked_bytes_), kMostSharedBytes);
  auto request = std::make_shared<v1::EditSceneRequest>();
  request->set_shared_memory_bytes(asked_bytes_);
  write(request);  // where it fails, so does what follows
}

PayloadPtr EditCall::take_shared(size_t count) {
  for (const auto& memory : shared_) {
    if (PayloadPtr payload = memory->take(count)) return payload;
  }
  ask_for_shared(count);
  return nullptr;
}

bool EditCall::shares(const SharedMemory& memory) const {
  return std::any_of(shared_.begin(), shared_.end(), [&](const auto& shared) { return shared.get() == &memory; });
}

bool EditCall::write_payload(const PayloadPtr& payload, size_t first, size_t count) {
  std::string tag;
  {
    google::protobuf::io::StringOutputStream stream(&tag);
    google::protobuf::io::CodedOutputStream out(&stream);
    constexpr uint32_t kLengthDelimited = 2;
    out.WriteTag(v1::EditSceneRequest::kPayloadFieldNumber << 3 | kLengthDelimited);
    out.WriteVarint64(count);
  }
  const grpc::Slice slices[] = {grpc::Slice(tag), aliased_slice(payload->bytes.data() + first, count, payload)};
  call_->Write({slices, 2}, nullptr);
  return wait();
}

bool EditCall::read(v1::EditSceneResponse* response) {
  do {
    call_->Read(response, nullptr);
    if (!wait()) return false;
    if (!response->has_shared_memory()) continue;
    if (auto memory = SharedMemory::open(response->shared_memory())) shared_.push_back(std::move(memory));
  } while (response->applied() == 0);
  return true;
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
