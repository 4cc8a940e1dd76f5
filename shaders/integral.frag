#version 430 core
#include "shared/fresnel.glsl"
#include "shared/material.glsl"
#include "shared/view.glsl"
#ifdef TEXTURED
#include "shared/surface_textures.glsl"
#endif

// The integral is in the vertices' radiosity already: L = Ft(eta, cos)·B/π (paper Eq. 2).
in vec3 to_eye;
in vec3 world_normal;
in vec3 leaving;
#ifdef TEXTURED
in vec2 coordinate;
in vec3 color;
#endif

layout(location = TARGET_RADIANCE) out vec4 radiance;
#ifdef CHANNELS
in vec3 entering;
layout(location = TARGET_IRRADIANCE) out vec4 irradiance_channel;
layout(location = TARGET_RADIOSITY) out vec4 radiosity_channel;
#endif

void main() {
  float cosine = abs(dot(world_normal, to_eye)) * inversesqrt(dot(world_normal, world_normal) * dot(to_eye, to_eye));
  float transmittance = fresnel_transmittance(mean_free_path_mm.a, cosine);
  vec3 radiosity = leaving;
#ifdef TEXTURED
  radiosity *= surface_albedo(coordinate, color);
#endif
  radiance = vec4(radiance_scale * transmittance / PI * radiosity, 1.0);
#ifdef CHANNELS
  irradiance_channel = vec4(entering, 1.0);
  radiosity_channel = vec4(radiosity, 1.0);
#endif
}
