// The light that coats reflect, on top of what leaves the bodies.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "glm/vec4.hpp"
#include "optics/coat.h"
#include "render/channels.h"
#include "render/map_pyramid.h"
#include "render/shadow.h"
#include "render/uniforms.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// What shines on coats. Lamps of the environment are seen in its map, so `lights` has none of them.
struct CoatLight {
  std::span<const LightStorage> lights;
  const scene::Environment* environment;  ///< null: none
  const ShadowScene* shadows;             ///< ready for rays; null: unshadowed
};

/// Keeps tables and the pyramid of a map from frame to frame. Render thread only.
class CoatLayer {
 public:
  /// Adds what the coat of one mesh sends to `eye_mm` to those of `radiance` (one a pixel of `tile`, linear, alpha 1)
  /// that show it: `mesh_id` in the tile's positions. Point lights and lamps make one highlight each; the environment
  /// is looked up in 32 directions, in one by a mirror, and nothing stands before it. Spread over all cores.
  void add(const optics::Coat& coat, float refractive_index, float mesh_id, const CoatLight& light,
           const glm::vec3& eye_mm, const ChannelTile& tile, std::span<glm::vec4> radiance);

 private:
  const optics::BalancedCoat& balanced(const optics::Coat& coat, float refractive_index);
  const MapPyramid* pyramid_of(const CoatLight& light);

  std::map<std::pair<float, float>, optics::BalancedCoat> balanced_;
  std::optional<MapPyramid> pyramid_;
};

}  // namespace diaphane::render
