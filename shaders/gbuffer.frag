#version 430 core
#include "shared/view.glsl"
#ifdef TEXTURED
#include "shared/material.glsl"
#include "shared/surface_textures.glsl"
#endif

in vec3 world_mm;
in vec3 world_normal;
#ifdef LIT
in vec3 entering;  // E with shadows, from the vertices
#endif
#ifdef TEXTURED
in vec2 coordinate;
in vec3 color;
#endif

layout(location = TARGET_POSITION) out vec4 position;  // mm; a: mesh id
layout(location = TARGET_NORMAL) out vec4 normal;    // unit; a: sine of the angle to the triangle's own normal
#ifdef LIT
layout(location = TARGET_ENTERING) out vec4 irradiance;
#endif
#ifdef TEXTURED
layout(location = TARGET_ALBEDO) out vec4 albedo;
layout(location = TARGET_COAT) out vec4 coat;  // its unit normal; a: share of its alpha
#endif

void main() {
  vec3 n = normalize(world_normal);
  // The inside of an open surface is shaded as a surface of its own. Both signs are asked: a silhouette's normal may look
  // away from the eye on a front face, and a file may wind its triangles against its normals.
  bool inside = !gl_FrontFacing && dot(n, eye_mm.xyz - world_mm) < 0.0;
  if (inside) n = -n;
  position = vec4(world_mm, mesh_id);
  vec3 facet = cross(dFdx(world_mm), dFdy(world_mm));
  float sine = length(cross(n, facet)) / max(length(facet), 1e-20);
  normal = vec4(n, min(sine, 1.0));
#ifdef LIT
  // The vertices know what falls on the outside alone.
  irradiance = vec4(inside ? vec3(0.0) : entering, 1.0);
#endif
#ifdef TEXTURED
  albedo = vec4(surface_albedo(coordinate, color), 1.0);
  coat = vec4(mapped_normal(n, world_mm, coordinate, normal_map_scale.x), roughness_share(coordinate));
#endif
}
