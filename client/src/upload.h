// Streams of one header and then chunks.
#pragma once

#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "connection.h"
#include "diaphane/environment.h"
#include "diaphane/mesh_data.h"
#include "diaphane/scene.h"

namespace diaphane::internal {

/// Scene::add_mesh.
absl::StatusOr<MeshHandle> upload_mesh(const Connection& connection, const std::string& scene, const MeshData& mesh,
                                       const MeshOptions& options);

/// Scene::add_texture.
absl::StatusOr<TextureHandle> upload_texture(const Connection& connection, const std::string& scene,
                                             const TextureData& texture);

/// Scene::update_positions.
absl::StatusOr<uint64_t> upload_positions(const Connection& connection, const MeshHandle& handle,
                                          std::span<const Vec3> positions, std::span<const Vec3> normals);

/// Scene::set_environment.
absl::StatusOr<uint64_t> upload_environment(const Connection& connection, const std::string& scene,
                                            const EnvironmentMap& map, const EnvironmentOptions& options);

}  // namespace diaphane::internal
