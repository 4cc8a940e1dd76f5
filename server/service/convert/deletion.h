#pragma once

#include <cstdint>

#include "diaphane/v1/scene_service.pb.h"

namespace diaphane::service {

inline void to_proto(uint64_t scene_revision, v1::DeleteResponse& message) {
  message.set_scene_revision(scene_revision);
}

}  // namespace diaphane::service
