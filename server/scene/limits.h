#pragma once

#include <cstdint>

namespace diaphane::scene {

/// What a SceneStore holds at most.
struct SceneLimits {
  uint32_t max_scenes = 1000;
  uint32_t max_meshes_per_scene = 256;
  uint32_t max_lights_per_scene = 256;
  uint32_t max_materials_per_scene = 256;
  uint32_t max_textures_per_scene = 256;
  uint32_t max_vertices_per_mesh = 1u << 24;
  uint32_t max_triangles_per_mesh = 1u << 25;
  uint64_t max_mesh_bytes =
      uint64_t{4} << 30;  ///< of all meshes, environments and textures of all scenes, and of uploads in flight
};

}  // namespace diaphane::scene
