// Edits that are kept until they are applied.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "absl/functional/function_ref.h"
#include "edit_call.h"
#include "payload_memory.h"

namespace diaphane::internal {

/// An edit, and the bytes of its changes in order that follow it, or lie in shared memory. Neither changes once it is
/// written.
struct OutgoingEdit {
  std::shared_ptr<v1::EditSceneRequest> request = std::make_shared<v1::EditSceneRequest>();
  std::vector<PayloadPtr> payloads;  ///< some of them shared with the call that it is written to first

  uint64_t sequence() const { return request->edit().sequence(); }
  size_t payload_bytes() const;
  size_t longest_payload() const;
  /// Makes payloads that follow of those that are not shared with `call`.
  void unshare_but_with(const EditCall& call);
};

/// Says in `positions` where its bytes are.
void announce(const PayloadBytes& payload, v1::VertexPositions& positions);

/// Makes bytes `first` to before `first` + `count` of a payload at `to`; both are multiples of 12.
using FillPayload = absl::FunctionRef<void(char* to, size_t first, size_t count)>;

/// False once the call broke.
bool write(EditCall& call, const OutgoingEdit& edit);

/// The same of an edit whose one payload is made on the way, a piece while the one before it travels. All of it is
/// made, whatever becomes of the call.
bool write_filling(EditCall& call, const OutgoingEdit& edit, FillPayload fill);

}  // namespace diaphane::internal
