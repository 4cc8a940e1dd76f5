// A head with two horns, made here: a thick body with thin parts, as the paper's demon. Plain values.
#pragma once

#include "diaphane/mesh_data.h"

namespace diaphane::gallery {

/// Around the origin, facing +z, the skull of radius about 1; closed, wound outward, 20·4^`levels` triangles.
MeshData horned_head(int levels = 6);

/// Whether a point of it lies on a horn's outer part, or (thick) on the skull below the horns.
bool on_horn(const Vec3& position);
bool on_skull(const Vec3& position);

}  // namespace diaphane::gallery
