#include "service/convert/picture.h"

#include <optional>

#include "base/status.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kMostSamples = 64;
constexpr float kBrightestBackground = 1e6f;

absl::StatusOr<render::ToneMapping> from_proto(v1::ToneMapping tone_mapping) {
  switch (tone_mapping) {
    case v1::TONE_MAPPING_UNSPECIFIED:
    case v1::TONE_MAPPING_NONE:
      return render::ToneMapping::kNone;
    case v1::TONE_MAPPING_NEUTRAL:
      return render::ToneMapping::kNeutral;
    default:
      return unknown_value("settings.tone_mapping", tone_mapping);
  }
}

absl::StatusOr<std::optional<glm::vec3>> from_proto(const v1::Background& message) {
  if (!message.has_color()) return std::optional<glm::vec3>();
  absl::Status color = check_range("settings.background.color", message.color(), 0, kBrightestBackground);
  if (!color.ok()) return color;
  return std::optional<glm::vec3>(service::from_proto(message.color()));
}

}  // namespace

absl::Status take_picture_settings(const v1::RenderSettings& message, render::RenderSettings& settings) {
  absl::Status exposure = check_range("settings.exposure_ev", message.exposure_ev(), -32, 32);
  if (!exposure.ok()) return exposure;
  if (message.samples() != 0) {
    absl::Status samples = check_range("settings.samples", message.samples(), 1, kMostSamples);
    if (!samples.ok()) return samples;
    settings.samples = message.samples();
  }
  const absl::StatusOr<render::ToneMapping> tone_mapping = from_proto(message.tone_mapping());
  if (!tone_mapping.ok()) return tone_mapping.status();
  const absl::StatusOr<std::optional<glm::vec3>> background = from_proto(message.background());
  if (!background.ok()) return background.status();
  settings.exposure_ev = message.exposure_ev();
  settings.auto_exposure = message.auto_exposure();
  settings.tone_mapping = *tone_mapping;
  settings.background = *background;
  settings.environment_background = message.background().environment();
  return absl::OkStatus();
}

}  // namespace diaphane::service
