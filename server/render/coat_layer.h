// The light that coats reflect, on top of what leaves the bodies.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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

/// A coat, and the directions in which it looks at an environment, for eyes at 64 angles. Immutable.
class CoatTable {
 public:
  static constexpr uint32_t kDraws = 16;

  /// From where light may come, with z along the normal and the eye above +x; by how much it counts; how far around.
  struct Look {
    glm::vec3 direction{0};  ///< about unit
    float weight = 0;
    float solid_angle_sr = 0;
  };

  CoatTable(const optics::Coat& coat, float refractive_index);

  const optics::BalancedCoat& coat() const { return coat_; }
  /// Look `draw` of an eye at that cosine, between the two nearest angles.
  Look look(float cosine, uint32_t draw) const;

 private:
  optics::BalancedCoat coat_;
  std::vector<Look> looks_;  ///< [angle][draw], evenly in the root of the cosine
};

/// Of a roughness map.
inline constexpr uint32_t kRoughnessSteps = 32;

/// Keeps tables and the pyramid of a map from frame to frame. Render thread only.
class CoatLayer {
 public:
  /// Adds what the coat of one mesh sends to `eye_mm` to those of `radiance` (one a pixel of `tile`, linear, alpha 1)
  /// that show it: `mesh_id` in the tile's positions. Where the tile is textured its coat gives normals and, in steps
  /// of 1/32, the share of the roughness. Point lights and lamps make one highlight each; the environment is looked up
  /// in 16 directions, in one by a mirror, and nothing stands before it. Spread over all cores.
  void add(const optics::Coat& coat, float refractive_index, float mesh_id, const CoatLight& light,
           const glm::vec3& eye_mm, const ChannelTile& tile, std::span<glm::vec4> radiance);

  /// Drops what was made of a map that is no more.
  void forget_orphans();

 private:
  /// Of every roughness that the pixels of a mesh have, by step; null where none has it.
  using TableSteps = std::array<const CoatTable*, kRoughnessSteps + 1>;

  const CoatTable& table_of(const optics::Coat& coat, float refractive_index);
  TableSteps tables_of(const optics::Coat& coat, float refractive_index, float mesh_id, const ChannelTile& tile);
  const MapPyramid* pyramid(const CoatLight& light);

  std::map<std::pair<float, float>, CoatTable> tables_;
  std::weak_ptr<const optics::LatLongMap> pyramid_of_;
  std::optional<MapPyramid> pyramid_;
};

}  // namespace diaphane::render
