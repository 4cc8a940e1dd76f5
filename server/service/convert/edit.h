// Edits of a scene.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/convert/vertex_positions.h"

namespace diaphane::service {

/// The changes of an edit, as the bytes of their positions come. Errors name the field, from "changes[i]" on, or
/// "payload". One thread.
class EditReader {
 public:
  /// `find_shared` is for now alone.
  static absl::StatusOr<EditReader> begin(const v1::SceneEdit& message, FindShared find_shared);

  /// Of all payloads; 0 where all came with the edit.
  uint64_t bytes_to_come() const;
  absl::Status add(std::string_view payload);
  /// In order, once nothing is to come; ends the reader.
  std::vector<scene::SceneChange> finish() { return std::move(changes_); }

 private:
  struct Waiting {
    size_t change;
    PositionsReader reader;
  };

  std::vector<scene::SceneChange> changes_;  ///< those that wait have no positions yet
  std::vector<Waiting> waiting_;             ///< for their payloads
  size_t next_ = 0;                          ///< of waiting_
};

/// What a reader takes at most for what does not come with the edit or is compressed.
uint64_t decoded_bytes(const v1::SceneEdit& message);

}  // namespace diaphane::service
