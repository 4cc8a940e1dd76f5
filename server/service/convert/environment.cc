#include "service/convert/environment.h"

#include <cstring>

#include "base/status.h"
#include "fmt/format.h"
#include "render/ambient.h"
#include "service/convert/check.h"
#include "service/sha256.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kLargestWidth_px = 8192, kLargestHeight_px = 4096;
constexpr double kLargestRotation_deg = 1e6, kLargestIntensity = 1e6;
constexpr float kLargestRadiance = 1e9f;

absl::Status check_settings(const v1::Environment& message) {
  absl::Status rotation =
      check_range("environment.rotation_deg", message.rotation_deg(), -kLargestRotation_deg, kLargestRotation_deg);
  if (!rotation.ok()) return rotation;
  if (message.has_intensity()) {
    absl::Status intensity = check_range("environment.intensity", message.intensity(), 0, kLargestIntensity);
    if (!intensity.ok()) return intensity;
  }
  return absl::OkStatus();
}

float intensity_of(const v1::Environment& message) { return message.has_intensity() ? message.intensity() : 1.0f; }

}  // namespace

absl::StatusOr<EnvironmentSpec> from_proto(const v1::EnvironmentHeader& message) {
  const v1::Environment& environment = message.environment();
  absl::Status width = check_range("environment.width_px", environment.width_px(), 2, kLargestWidth_px);
  if (!width.ok()) return width;
  absl::Status height = check_range("environment.height_px", environment.height_px(), 1, kLargestHeight_px);
  if (!height.ok()) return height;
  if (absl::Status settings = check_settings(environment); !settings.ok()) return settings;
  const uint64_t needed = sizeof(glm::vec3) * uint64_t{environment.width_px()} * environment.height_px();
  if (message.total_bytes() != needed) {
    return base::invalid_field("total_bytes", fmt::format("{}, as the size says", needed),
                               fmt::format("{}", message.total_bytes()));
  }
  if (message.sha256().size() != Sha256::kBytes) {
    return base::invalid_field("sha256", "32 bytes", fmt::format("{} bytes", message.sha256().size()));
  }
  return EnvironmentSpec{environment.width_px(),    environment.height_px(), environment.rotation_deg(),
                         intensity_of(environment), environment.occlusion(), PayloadSpec{{}, needed, message.sha256()}};
}

absl::StatusOr<optics::LatLongMap> read_map(const EnvironmentSpec& spec, std::span<const char> bytes) {
  optics::LatLongMap map{spec.width_px, spec.height_px, {}};
  map.radiance.resize(size_t{spec.width_px} * spec.height_px);
  std::memcpy(map.radiance.data(), bytes.data(), map.radiance.size() * sizeof(glm::vec3));
  for (size_t i = 0; i < map.radiance.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = map.radiance[i][c];
      // Written so that NaN fails too.
      if (value >= 0 && value <= kLargestRadiance) continue;
      return base::invalid_field(fmt::format("pixels[{}][{}].{}", i / spec.width_px, i % spec.width_px, "rgb"[c]),
                                 "0..1e9", value);
    }
  }
  return map;
}

absl::StatusOr<scene::EnvironmentPatch> from_proto(const v1::Environment& message,
                                                   const google::protobuf::FieldMask& mask) {
  absl::Status known = check_mask(mask, {"rotation_deg", "intensity", "occlusion"});
  if (!known.ok()) return known;
  if (absl::Status settings = check_settings(message); !settings.ok()) return settings;
  scene::EnvironmentPatch patch;
  if (names(mask, "rotation_deg")) patch.rotation_deg = message.rotation_deg();
  if (names(mask, "intensity")) patch.intensity = intensity_of(message);
  if (names(mask, "occlusion")) patch.occlusion = message.occlusion();
  return patch;
}

void to_proto(const scene::EnvironmentPtr& environment, v1::Environment& message) {
  message.set_name(environment->name);
  message.set_width_px(environment->map->width_px);
  message.set_height_px(environment->map->height_px);
  message.set_rotation_deg(environment->rotation_deg);
  message.set_intensity(environment->intensity);
  message.set_occlusion(environment->occlusion);
  for (const optics::EnvironmentLamp& lamp : environment->light->lamps) {
    v1::EnvironmentLamp& shown = *message.add_lamps();
    to_proto(render::rotated_about_y(lamp.direction, environment->rotation_deg), *shown.mutable_direction());
    to_proto(environment->intensity * lamp.irradiance, *shown.mutable_irradiance());
  }
}

void to_proto(const scene::Changed<scene::EnvironmentPtr>& changed, v1::EnvironmentResponse& message) {
  to_proto(changed.value, *message.mutable_environment());
  message.set_scene_revision(changed.scene_revision);
}

}  // namespace diaphane::service
