#version 430 core
#include "shared/lights.glsl"
#include "shared/material.glsl"
#include "shared/view.glsl"

// Opaque and matt, with the body's own total reflectance as its colour: light leaves where it came in (Fig. 8, right).
layout(binding = UNIT_GBUFFER_POSITION) uniform sampler2D gbuffer_position;
layout(binding = UNIT_GBUFFER_NORMAL) uniform sampler2D gbuffer_normal;

layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (position.w != mesh_id) discard;
  vec3 n = texelFetch(gbuffer_normal, pixel, 0).xyz;
  vec3 e = vec3(0.0);
  for (int i = 0; i < lights.length(); ++i) {
    vec3 towards;
    vec3 arriving = arriving_light(lights[i], position.xyz, towards);
    e += arriving * max(dot(n, towards), 0.0);
  }
  radiance = vec4(radiance_scale / PI * total_reflectance.rgb * e, 1.0);
}
