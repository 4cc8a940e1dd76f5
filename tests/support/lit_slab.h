// A slab lit evenly from one side, by the surface integral.
#pragma once

#include "glm/vec3.hpp"
#include "optics/dipole.h"

namespace diaphane::testing {

/// B over E at the middle of each face, RGB: of what enters, what leaves through the lit face and through the other.
struct FacePair {
  glm::vec3 reflected, transmitted;
};
struct LitSlab {
  FacePair integral;   ///< as the integral says
  FacePair corrected;  ///< after the slab correction, thickness and opposite points from the mesh
};

/// Two discs `thickness_mm` apart, as wide as the light spreads and without a rim, at quality fine.
LitSlab light_slab(const optics::Coefficients& material, float thickness_mm);

}  // namespace diaphane::testing
