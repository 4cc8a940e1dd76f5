#include "scene/names.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::scene {
namespace {

constexpr std::string_view kScenes = "scenes/";
constexpr std::string_view kEnvironment = "/environment";

bool is_id(std::string_view id) {
  return !id.empty() &&
         std::all_of(id.begin(), id.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z'); });
}

}  // namespace

std::string_view collection_id(Collection collection) {
  switch (collection) {
    case Collection::kMaterials:
      return "materials";
    case Collection::kLights:
      return "lights";
    case Collection::kMeshes:
      return "meshes";
    case Collection::kTextures:
      return "textures";
  }
  std::abort();
}

std::string make_scene_name() {
  std::array<uint64_t, 2> bits;
  // Fails only for more than 256 bytes, or on a kernel older than 3.17.
  if (getentropy(bits.data(), sizeof(bits)) != 0) std::abort();
  return fmt::format("{}{:016x}{:016x}", kScenes, bits[0], bits[1]);
}

std::string make_child_name(std::string_view scene_name, Collection collection, uint64_t id) {
  return fmt::format("{}/{}/{}", scene_name, collection_id(collection), id);
}

absl::Status check_scene_name(const Reference& reference) {
  if (reference.name.starts_with(kScenes) && is_id(reference.name.substr(kScenes.size()))) return absl::OkStatus();
  return base::invalid_field(reference.field, "scenes/{scene}", reference.name);
}

absl::StatusOr<std::string> scene_of_child(const Reference& reference, Collection collection) {
  const std::string separator = fmt::format("/{}/", collection_id(collection));
  const size_t end = reference.name.find(separator);
  if (end != std::string_view::npos && is_id(reference.name.substr(end + separator.size()))) {
    const std::string_view scene = reference.name.substr(0, end);
    if (check_scene_name({reference.field, scene}).ok()) return std::string(scene);
  }
  return base::invalid_field(reference.field, fmt::format("scenes/{{scene}}{}{{id}}", separator), reference.name);
}

std::string make_environment_name(std::string_view scene_name) { return std::string(scene_name).append(kEnvironment); }

absl::StatusOr<std::string> scene_of_environment(const Reference& reference) {
  if (reference.name.ends_with(kEnvironment)) {
    const std::string_view scene = reference.name.substr(0, reference.name.size() - kEnvironment.size());
    if (check_scene_name({reference.field, scene}).ok()) return std::string(scene);
  }
  return base::invalid_field(reference.field, "scenes/{scene}/environment", reference.name);
}

absl::Status not_found(const Reference& reference, std::string_view what) {
  return base::field_error(absl::StatusCode::kNotFound, {std::string(reference.field), std::string(reference.name),
                                                         fmt::format("the name of an existing {}", what)});
}

}  // namespace diaphane::scene
