// What becomes of radiance once it is found.
#pragma once

#include "absl/status/status.h"
#include "diaphane/v1/frame.pb.h"
#include "render/frame.h"

namespace diaphane::service {

/// Exposure, samples, tone mapping and background; INVALID_ARGUMENT names the field. `settings` is then as it was.
absl::Status take_picture_settings(const v1::RenderSettings& message, render::RenderSettings& settings);

}  // namespace diaphane::service
