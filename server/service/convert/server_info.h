#pragma once

#include "diaphane/v1/server_service.pb.h"
#include "render/frame.h"
#include "service/limits.h"

namespace diaphane::service {

/// The renderer, and the formats and techniques that every renderer has.
void to_proto(const render::RendererInfo& renderer, v1::ServerInfo& message);
void to_proto(const ServiceLimits& limits, v1::Limits& message);

}  // namespace diaphane::service
