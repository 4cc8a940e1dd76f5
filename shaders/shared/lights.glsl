#include "shared/bindings.glsl"

struct PointLight {
  vec4 position_mm;     // xyz
  vec4 intensity_w_sr;  // rgb
};

layout(std430, binding = STORAGE_LIGHTS) readonly buffer Lights {
  PointLight lights[];
};
