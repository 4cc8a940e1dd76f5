#pragma once

#include <memory>
#include <span>

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/convert/upload.h"

namespace diaphane::service {

/// What a header says of an environment and its payload.
struct EnvironmentSpec {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  float rotation_deg = 0;
  float intensity = 1;
  bool occlusion = false;
  PayloadSpec payload;
};

/// Errors name the field.
absl::StatusOr<EnvironmentSpec> from_proto(const v1::EnvironmentHeader& message);

/// `bytes` are the spec's. INVALID_ARGUMENT names the first pixel that is not within 0..1e9.
absl::StatusOr<optics::LatLongMap> read_map(const EnvironmentSpec& spec, std::span<const char> bytes);

absl::StatusOr<scene::EnvironmentPatch> from_proto(const v1::Environment& message,
                                                   const google::protobuf::FieldMask& mask);

void to_proto(const scene::EnvironmentPtr& environment, v1::Environment& message);
void to_proto(const scene::Changed<scene::EnvironmentPtr>& changed, v1::EnvironmentResponse& message);

}  // namespace diaphane::service
