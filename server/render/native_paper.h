// What the paper technique keeps of one mesh where it runs natively.
#pragma once

#include <optional>

#include "diffusion/kernel_table.h"
#include "glm/geometric.hpp"
#include "render/native_cube.h"

namespace diaphane::render {

/// One thread.
struct NativePaper {
  NativeCube cube;
  diffusion::KernelSet kernels;  ///< of `material`, by the paper's dipole
  std::optional<optics::Coefficients> material;

  /// Makes the kernels fit a material and the box of the cube.
  void prepare_kernels(optics::Coefficients of) {
    of.profile = optics::Profile::kDipole;
    if (material != of) kernels.set_material(of);
    material = of;
    kernels.prepare(glm::length(glm::vec3(cube.box().extent_mm)), {});
  }
};

}  // namespace diaphane::render
