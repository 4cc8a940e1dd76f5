// Positions of vertices as edits carry them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "glm/vec3.hpp"
#include "scene/scene_store.h"

namespace diaphane::service {

/// The bytes that a message means; they may change while they are read. Errors name the field, from "shared" on.
using FindShared = absl::FunctionRef<absl::StatusOr<std::string_view>(const v1::SharedBytes&)>;

/// Positions as their bytes come: plain, quantised or compressed, with their message, after it or in shared
/// memory. What is decoded is
/// bounded by decoded_bytes(). Errors name the field, from "positions" on. One thread.
class PositionsReader {
 public:
  /// `find_shared` is for now alone.
  static absl::StatusOr<PositionsReader> begin(const v1::VertexPositions& message, FindShared find_shared);

  /// Of the payload; 0 where all came with the message.
  uint64_t bytes_to_come() const { return bytes_to_come_; }
  /// The next of them. Errors name "payload" where their number is wrong.
  absl::Status add(std::string_view bytes);
  /// Once nothing is to come; ends the reader.
  scene::PositionsPatch finish() { return std::move(patch_); }

 private:
  PositionsReader() = default;
  absl::Status take(std::string_view bytes);
  absl::Status take_floats(std::span<const glm::vec3> values);
  void take_steps(std::span<const glm::vec<3, uint16_t>> steps);

  scene::PositionsPatch patch_;
  bool quantized_ = false;
  glm::vec3 lowest_{}, highest_{};  ///< of the box
  uint32_t coded_count_ = 0;        ///< not 0: elements that the codec made the bytes of
  std::string coded_;               ///< the codec's bytes, where they come in pieces
  uint64_t bytes_to_come_ = 0;
};

/// What a reader takes at most for what does not come with the message or is compressed; 0 for what it refuses before.
uint64_t decoded_bytes(const v1::VertexPositions& message);

}  // namespace diaphane::service
