#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/payload.h"

namespace diaphane::service {

/// A new mesh on its way into the store. One thread at a time; `store` outlives it.
class MeshUpload {
 public:
  using Request = v1::UploadMeshRequest;
  using Header = v1::MeshHeader;
  using Response = v1::MeshResponse;
  static constexpr std::string_view kMethod = "UploadMesh";

  explicit MeshUpload(scene::SceneStore& store) : store_(store) {}

  /// Checks the header and reserves memory for all that will come of it.
  absl::StatusOr<PayloadSpec> open(const Header& header);

  /// Makes the mesh of a complete payload: slow.
  absl::Status apply(const Payload& payload, v1::MeshResponse& response);

 private:
  scene::SceneStore& store_;
  std::string parent_;
  scene::NewMesh mesh_;
  scene::Reservation reservation_;
};

}  // namespace diaphane::service
