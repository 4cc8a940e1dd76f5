#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/payload.h"

namespace diaphane::service {

/// New positions of a mesh on their way into the store. One thread at a time; `store` outlives it.
class PositionsUpload {
 public:
  using Request = v1::UpdatePositionsRequest;
  using Header = v1::PositionsHeader;
  using Response = v1::MeshResponse;
  static constexpr std::string_view kMethod = "UpdatePositions";

  explicit PositionsUpload(scene::SceneStore& store) : store_(store) {}

  /// Checks the header and reserves memory for all that will come of it.
  absl::StatusOr<PayloadSpec> open(const Header& header);

  /// Replaces the mesh's positions by a complete payload's.
  absl::Status apply(const Payload& payload, v1::MeshResponse& response);

 private:
  scene::SceneStore& store_;
  std::string mesh_;
  scene::Reservation reservation_;
};

}  // namespace diaphane::service
