// A map of radiance at coarser and coarser sizes.
#pragma once

#include <vector>

#include "optics/environment.h"

namespace diaphane::render {

/// What is coarser than a map, halved until one row is left; the map itself stays its owner's. Immutable once built;
/// any thread may ask.
class MapPyramid {
 public:
  explicit MapPyramid(const optics::LatLongMap& map);

  /// Mean radiance around a unit direction of `map`, that it was built of, over about `solid_angle_sr`; between levels
  /// linear.
  glm::vec3 around(const optics::LatLongMap& map, const glm::vec3& direction, float solid_angle_sr) const;

 private:
  std::vector<optics::LatLongMap> coarser_;
};

}  // namespace diaphane::render
