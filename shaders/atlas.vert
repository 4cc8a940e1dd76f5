#version 430 core
#include "shared/box.glsl"

// Pass 1: the mesh, orthographic, on one face of its box (paper §4.2).
layout(location = ATTRIBUTE_POSITION) in vec3 position_mm;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;
layout(location = 0) uniform int face;

out vec3 world_mm;
out vec3 world_normal;
#ifdef LIT
layout(location = ATTRIBUTE_IRRADIANCE) in vec3 irradiance_at_vertex;
out vec3 entering;
#endif

void main() {
  world_mm = position_mm;
  world_normal = normal;
#ifdef LIT
  entering = irradiance_at_vertex;
#endif
  int axis = face_axis(face);
  vec3 unit = 2.0 * (position_mm - box_centre_mm.xyz) / box_extent_mm.xyz;
  // The surface nearest to the face is the one that is kept.
  gl_Position = vec4(unit[u_axis(axis)], unit[v_axis(axis)], -face_sign(face) * unit[axis], 1.0);
}
