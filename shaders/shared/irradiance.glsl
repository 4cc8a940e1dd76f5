#include "shared/fresnel.glsl"
#include "shared/lights.glsl"
#include "shared/material.glsl"

// E of all lights, unshadowed: clamped cosine and Fresnel transmittance (paper Eq. 4). As render/lights.h.
vec3 entering_irradiance(vec3 position_mm, vec3 n) {
  vec3 e = vec3(0.0);
  for (int i = 0; i < lights.length(); ++i) {
    vec3 towards;
    vec3 arriving = arriving_light(lights[i], position_mm, towards);
    float cosine = max(dot(n, towards), 0.0);
    e += arriving * (cosine * fresnel_transmittance(mean_free_path_mm.a, cosine));
  }
  return e;
}
