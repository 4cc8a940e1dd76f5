#version 430 core
#include "shared/lights.glsl"
#include "shared/material.glsl"
#include "shared/view.glsl"

// Opaque and matt, with the body's own total reflectance as its colour: light leaves where it came in (Fig. 8, right).
layout(binding = UNIT_GBUFFER_POSITION) uniform sampler2D gbuffer_position;
layout(binding = UNIT_GBUFFER_NORMAL) uniform sampler2D gbuffer_normal;

#ifdef LIT
layout(binding = UNIT_GBUFFER_IRRADIANCE) uniform sampler2D gbuffer_irradiance;
#endif

#ifdef TEXTURED
layout(binding = UNIT_GBUFFER_ALBEDO) uniform sampler2D gbuffer_albedo;
#endif

layout(location = TARGET_RADIANCE) out vec4 radiance;
#ifdef CHANNELS
layout(location = TARGET_IRRADIANCE) out vec4 irradiance_channel;
layout(location = TARGET_RADIOSITY) out vec4 radiosity_channel;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (position.w != mesh_id) discard;
#ifdef LIT
  vec3 e = texelFetch(gbuffer_irradiance, pixel, 0).rgb;
#else
  vec3 n = texelFetch(gbuffer_normal, pixel, 0).xyz;
  vec3 e = vec3(0.0);
  for (int i = 0; i < lights.length(); ++i) {
    vec3 towards;
    vec3 arriving = arriving_light(lights[i], position.xyz, towards);
    e += arriving * max(dot(n, towards), 0.0);
  }
#endif
  vec3 radiosity = total_reflectance.rgb * e;
#ifdef TEXTURED
  radiosity *= texelFetch(gbuffer_albedo, pixel, 0).rgb;
#endif
  radiance = vec4(radiance_scale / PI * radiosity, 1.0);
#ifdef CHANNELS
  irradiance_channel = vec4(e, 1.0);
  radiosity_channel = vec4(radiosity, 1.0);
#endif
}
