#include "outgoing_edit.h"

#include <algorithm>
#include <utility>

namespace diaphane::internal {
namespace {

// The server takes up to 1 MiB; smaller ones cost more calls than reading early saves. A multiple of what positions
// take.
constexpr size_t kPieceBytes = 12 * 65536;

}  // namespace

void announce(const PayloadBytes& payload, v1::VertexPositions& positions) {
  if (payload.shared == nullptr) return positions.set_payload_bytes(payload.bytes.size());
  positions.mutable_shared()->set_memory(payload.shared->id());
  positions.mutable_shared()->set_offset(payload.offset);
  positions.mutable_shared()->set_bytes(payload.bytes.size());
}

size_t OutgoingEdit::payload_bytes() const {
  size_t bytes = 0;
  for (const auto& payload : payloads) bytes += payload->bytes.size();
  return bytes;
}

size_t OutgoingEdit::longest_payload() const {
  size_t longest = 0;
  for (const auto& payload : payloads) longest = std::max(longest, payload->bytes.size());
  return longest;
}

void OutgoingEdit::unshare_but_with(const EditCall& call) {
  size_t next = 0;
  for (v1::SceneChange& change : *request->mutable_edit()->mutable_changes()) {
    if (!change.has_positions()) continue;
    v1::VertexPositions& positions = *change.mutable_positions();
    if (!positions.has_shared() && positions.payload_bytes() == 0) continue;
    PayloadPtr& payload = payloads[next++];
    if (payload->shared == nullptr || call.shares(*payload->shared)) continue;
    // What a broken call still holds of the request are its long strings, which stay as they are.
    positions.set_payload_bytes(payload->bytes.size());
    positions.clear_shared();
    payload = std::make_shared<PayloadBytes>(PayloadBytes{payload->bytes, payload});
  }
}

bool write(EditCall& call, const OutgoingEdit& edit) {
  if (!call.write(edit.request)) return false;
  for (const PayloadPtr& payload : edit.payloads) {
    if (payload->shared != nullptr) continue;
    for (size_t first = 0; first < payload->bytes.size(); first += kPieceBytes) {
      if (!call.write_payload(payload, first, std::min(kPieceBytes, payload->bytes.size() - first))) return false;
    }
  }
  return true;
}

bool write_filling(EditCall& call, const OutgoingEdit& edit, FillPayload fill) {
  const PayloadPtr& payload = edit.payloads.front();
  if (payload->shared != nullptr) {
    fill(payload->bytes.data(), 0, payload->bytes.size());
    return call.write(edit.request);
  }
  bool going = call.write(edit.request);
  for (size_t first = 0; first < payload->bytes.size(); first += kPieceBytes) {
    const size_t count = std::min(kPieceBytes, payload->bytes.size() - first);
    fill(payload->bytes.data() + first, first, count);
    going = going && call.write_payload(payload, first, count);
  }
  return going;
}

}  // namespace diaphane::internal
