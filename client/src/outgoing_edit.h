// Edits that are kept until they are applied.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "edit_call.h"

namespace diaphane::internal {

/// Memory of payloads, used again once nobody reads it any more. Thread-safe.
class PayloadPool {
 public:
  /// `count` bytes of no particular value.
  std::shared_ptr<std::string> take(size_t count);

 private:
  struct Spare {
    std::mutex mutex;
    std::unique_ptr<std::string> bytes;  ///< null: none
  };
  const std::shared_ptr<Spare> spare_ = std::make_shared<Spare>();
};

/// An edit, and the bytes that follow it, of its changes in order. Neither changes once it is written.
struct OutgoingEdit {
  std::shared_ptr<v1::EditSceneRequest> request = std::make_shared<v1::EditSceneRequest>();
  std::vector<std::shared_ptr<std::string>> payloads;

  uint64_t sequence() const { return request->edit().sequence(); }
  size_t payload_bytes() const;
};

/// Makes bytes `first` to before `first` + `count` of a payload at `to`; both are multiples of 12.
using FillPayload = absl::FunctionRef<void(char* to, size_t first, size_t count)>;

/// False once the call broke.
bool write(EditCall& call, const OutgoingEdit& edit);

/// The same of an edit whose one payload is made on the way, a piece while the one before it travels. All of it is
/// made, whatever becomes of the call.
bool write_filling(EditCall& call, const OutgoingEdit& edit, FillPayload fill);

}  // namespace diaphane::internal
