#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/convert/texture.h"
#include "service/payload.h"

namespace diaphane::service {

/// A texture on its way into a scene. One thread at a time; `store` outlives it.
class TextureUpload {
 public:
  using Request = v1::UploadTextureRequest;
  using Header = v1::TextureHeader;
  using Response = v1::TextureResponse;
  static constexpr std::string_view kMethod = "UploadTexture";

  explicit TextureUpload(scene::SceneStore& store) : store_(store) {}

  /// Checks the header and reserves memory for all that will come of it.
  absl::StatusOr<PayloadSpec> open(const Header& header);

  absl::Status apply(const Payload& payload, v1::TextureResponse& response);

 private:
  scene::SceneStore& store_;
  std::string parent_;
  TextureSpec spec_;
  scene::Reservation reservation_;
};

}  // namespace diaphane::service
