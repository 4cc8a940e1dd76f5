// Primitives that Draco compressed (KHR_draco_mesh_compression).
#pragma once

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "readers/gltf_accessor.h"
#include "readers/gltf_extensions.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// Bounds on one primitive, which keep the decoder's own tables below some 250 MiB.
inline constexpr uint64_t kMostDracoTriangles = 4'000'000;
inline constexpr uint64_t kMostDracoPoints = 4'000'000;

/// The accessors of `primitive` as `compressed` has them, in their own types. The counts that the bytes state are
/// compared with the accessors' before anything is allocated. kInvalidArgument where they differ, or the bytes cannot
/// be decoded; kResourceExhausted past the bounds; kUnimplemented strips, and bitstreams of before 2.2.
absl::StatusOr<GltfReplacedAccessors> decode_draco(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const GltfDraco& draco, std::string_view compressed,
                                                   std::string_view where, const Source& source);

}  // namespace diaphane::readers
