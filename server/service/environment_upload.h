#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/convert/environment.h"
#include "service/payload.h"

namespace diaphane::service {

/// An environment on its way into a scene. One thread at a time; `store` outlives it.
class EnvironmentUpload {
 public:
  using Request = v1::UploadEnvironmentRequest;
  using Header = v1::EnvironmentHeader;
  using Response = v1::EnvironmentResponse;
  static constexpr std::string_view kMethod = "UploadEnvironment";

  explicit EnvironmentUpload(scene::SceneStore& store) : store_(store) {}

  /// Checks the header and reserves memory for all that will come of it.
  absl::StatusOr<PayloadSpec> open(const Header& header);

  /// Takes lamps out and projects the rest: slow.
  absl::Status apply(const Payload& payload, v1::EnvironmentResponse& response);

 private:
  scene::SceneStore& store_;
  std::string parent_;
  EnvironmentSpec spec_;
  scene::Reservation reservation_;
};

}  // namespace diaphane::service
