// A candle, made here: nobody else's mesh is needed for it. Plain values.
#pragma once

#include "diaphane/mesh_data.h"

namespace diaphane::gallery {

/// Millimetres; the foot stands on y = 0, around the y axis.
struct CandleShape {
  float radius = 10;
  float height = 38;       ///< of the rim where it is highest
  float hollow_depth = 9;  ///< of the molten hollow below the rim
  float wall = 2.2f;       ///< of the rim
  float spacing = 0.45f;   ///< of vertices along the outline
};

/// A body of revolution with a rounded rim around a hollow, the rim sunk on one side and runs of wax below it. Closed,
/// wound outward.
MeshData candle(const CandleShape& shape = {});

/// A thin rod out of the hollow's floor; it is a body of its own.
MeshData wick(const CandleShape& shape = {});

/// Where the flame stands: on the axis, above the wick, below the rim.
Vec3 flame(const CandleShape& shape = {});

}  // namespace diaphane::gallery
