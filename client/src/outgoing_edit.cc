#include "outgoing_edit.h"

#include <algorithm>
#include <utility>

namespace diaphane::internal {
namespace {

// The server takes up to 1 MiB; smaller ones cost more calls than reading early saves. A multiple of what positions
// take.
constexpr size_t kPieceBytes = 12 * 65536;

}  // namespace

std::shared_ptr<std::string> PayloadPool::take(size_t count) {
  std::unique_ptr<std::string> bytes;
  {
    const std::lock_guard lock(spare_->mutex);
    bytes = std::move(spare_->bytes);
  }
  if (bytes == nullptr) bytes = std::make_unique<std::string>();
  bytes->resize(count);
  // gRPC may be the last to let go, on a thread of its own.
  return {bytes.release(), [spare = spare_](std::string* used) {
            const std::lock_guard lock(spare->mutex);
            spare->bytes.reset(used);
          }};
}

size_t OutgoingEdit::payload_bytes() const {
  size_t bytes = 0;
  for (const auto& payload : payloads) bytes += payload->size();
  return bytes;
}

bool write(EditCall& call, const OutgoingEdit& edit) {
  if (!call.write(edit.request)) return false;
  for (const auto& payload : edit.payloads) {
    for (size_t first = 0; first < payload->size(); first += kPieceBytes) {
      if (!call.write_payload(payload, first, std::min(kPieceBytes, payload->size() - first))) return false;
    }
  }
  return true;
}

bool write_filling(EditCall& call, const OutgoingEdit& edit, FillPayload fill) {
  bool going = call.write(edit.request);
  const std::shared_ptr<std::string>& payload = edit.payloads.front();
  for (size_t first = 0; first < payload->size(); first += kPieceBytes) {
    const size_t count = std::min(kPieceBytes, payload->size() - first);
    fill(payload->data() + first, first, count);
    going = going && call.write_payload(payload, first, count);
  }
  return going;
}

}  // namespace diaphane::internal
