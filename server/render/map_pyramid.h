// A map of radiance at coarser and coarser sizes.
#pragma once

#include <memory>
#include <vector>

#include "optics/environment.h"

namespace diaphane::render {

/// Halved until one row is left. Immutable once built; any thread may ask.
class MapPyramid {
 public:
  explicit MapPyramid(std::shared_ptr<const optics::LatLongMap> map);

  /// Mean radiance around a unit direction of the map, over about `solid_angle_sr`; between levels linear.
  glm::vec3 around(const glm::vec3& direction, float solid_angle_sr) const;

  const std::shared_ptr<const optics::LatLongMap>& map() const { return map_; }

 private:
  const optics::LatLongMap& level(size_t index) const { return index == 0 ? *map_ : coarser_[index - 1]; }

  std::shared_ptr<const optics::LatLongMap> map_;
  std::vector<optics::LatLongMap> coarser_;
};

}  // namespace diaphane::render
