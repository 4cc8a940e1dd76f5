// JSON types of what is read from a glTF document.
#pragma once

#include "absl/status/status.h"
#include "nlohmann/json.hpp"
#include "readers/source.h"

namespace diaphane::readers {

/// Whether every member that the reader looks at has the type that glTF 2.0 gives it. tinygltf reads an optional member
/// of another type as if it were not there, which would make another mesh of the file. kInvalidArgument names the
/// member.
absl::Status check_gltf_types(const nlohmann::json& root, const Source& source);

}  // namespace diaphane::readers
