#include "shared/bindings.glsl"

layout(std140, binding = UNIFORMS_VIEW) uniform View {
  mat4 clip_from_world;
  vec4 eye_mm;            // xyz
  float radiance_scale;   // 2^exposure for pictures, 1 for linear pixels
  float mesh_id;          // of the mesh being drawn, 1…
};
