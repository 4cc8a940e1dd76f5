#version 430 core
#include "shared/box.glsl"
#include "shared/irradiance.glsl"

layout(location = 0) uniform int face;

in vec3 world_mm;
in vec3 world_normal;
#ifdef LIT
in vec3 entering;  // E with shadows, from the vertices
#endif

layout(location = 0) out vec4 irradiance;  // E; a: dot(N, P − box centre), the paper's self-occlusion key
layout(location = 1) out vec4 surface;     // N along u and v; depth over the box centre in mm; coverage

void main() {
  vec3 n = normalize(world_normal);
#ifdef LIT
  vec3 e = entering;
#else
  vec3 e = entering_irradiance(world_mm, n);
#endif
  int axis = face_axis(face);
  vec3 from_centre = world_mm - box_centre_mm.xyz;
  // Only the size of N along the face is told by u and v: the stored normal looks at the face.
  vec3 towards_face = n[axis] * face_sign(face) < 0.0 ? -n : n;
  irradiance = vec4(e, dot(towards_face, from_centre));
  surface = vec4(towards_face[u_axis(axis)], towards_face[v_axis(axis)], from_centre[axis], 1.0);
}
