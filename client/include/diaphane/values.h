// Small values that the client's calls take and return.
#pragma once

namespace diaphane {

/// Three coordinates. Lengths are in scene units (mesh units where a mesh says so), right-handed. Finite.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

}  // namespace diaphane
