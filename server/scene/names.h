// Names of scenes and of what is in them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace diaphane::scene {

/// A name that a request gave, and the field it stood in, for the error that may come of it.
struct Reference {
  std::string_view field;
  std::string_view name;
};

enum class Collection { kMaterials, kLights, kMeshes, kTextures };

/// "materials", "lights", "meshes" or "textures".
std::string_view collection_id(Collection collection);

/// scenes/{scene} with 128 bits from the kernel's generator: it cannot be guessed. Thread-safe.
std::string make_scene_name();

/// scenes/{scene}/{collection}/{id}
std::string make_child_name(std::string_view scene_name, Collection collection, uint64_t id);

/// OK, or INVALID_ARGUMENT when `reference` has not the form scenes/{scene}.
absl::Status check_scene_name(const Reference& reference);

/// The scene's name, scenes/{scene}, of one of its children. INVALID_ARGUMENT when `reference` has not the form
/// scenes/{scene}/{collection}/{id}.
absl::StatusOr<std::string> scene_of_child(const Reference& reference, Collection collection);

/// scenes/{scene}/environment
std::string make_environment_name(std::string_view scene_name);

/// The scene's name. INVALID_ARGUMENT when `reference` has not the form scenes/{scene}/environment.
absl::StatusOr<std::string> scene_of_environment(const Reference& reference);

/// NOT_FOUND for a well-formed name of nothing. `what` is "scene", "mesh", ... An unknown scene and one that the caller
/// may not see look alike.
absl::Status not_found(const Reference& reference, std::string_view what);

}  // namespace diaphane::scene
