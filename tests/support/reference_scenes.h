// The three scenes with independent ground truth, for tests that skip without them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glm/vec3.hpp"
#include "optics/dipole.h"
#include "tests/support/meshes.h"

namespace diaphane::testing {

/// One case of ../shared/reference: mesh, material, light, camera, and the picture that an independent program made.
struct ReferenceScene {
  Mesh mesh;
  optics::Coefficients material;
  glm::vec3 light_position_mm{0};
  float light_intensity_w_sr = 0;
  glm::vec3 eye_mm{0};
  glm::vec3 target_mm{0};
  glm::vec3 up{0};
  float fov_y_deg = 0;
  uint32_t size_px = 0;
};

/// Names: sphere_skin1_side, slab_marble_back, bunny20_marble_front. Nothing where the folder is absent.
std::optional<ReferenceScene> load_reference_scene(const std::string& name);

/// Outgoing radiance, linear RGB, rows top to bottom; (0, 0, 0) outside the body.
std::vector<glm::vec3> load_reference_image(const std::string& name, bool shadowed);

/// RMS difference over mean of `truth` by channel, over the pixels whose eight neighbours are all inside the body.
glm::vec3 relative_rms_inside(const std::vector<glm::vec3>& image, const std::vector<glm::vec3>& truth,
                              uint32_t size_px);

}  // namespace diaphane::testing
