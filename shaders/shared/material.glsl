#include "shared/bindings.glsl"

const float PI = 3.14159265358979;

// optics::Dipole, and the refractive index.
layout(std140, binding = UNIFORMS_MATERIAL) uniform MaterialUniforms {
  vec4 mean_free_path_mm;       // rgb; a: refractive index
  vec4 virtual_height_mm;       // rgb; a: mean of the three mean free paths
  vec4 effective_transport_mm;  // rgb
  vec4 reduced_albedo;          // rgb
  vec4 total_reflectance;       // rgb
  vec4 normal_map_scale;        // x: 0 where there is none
};

vec3 source_term(vec3 height_mm, float squared_distance_mm) {
  vec3 d2 = squared_distance_mm + height_mm * height_mm;
  vec3 inverse_d = inversesqrt(d2);
  vec3 optical = effective_transport_mm.rgb * d2 * inverse_d;
  return height_mm * (1.0 + optical) * exp(-optical) * inverse_d * inverse_d * inverse_d;
}

// Rd of JB02 at a squared distance in mm², in mm⁻².
vec3 diffuse_reflectance(float squared_distance_mm) {
  return reduced_albedo.rgb / (4.0 * PI) *
         (source_term(mean_free_path_mm.rgb, squared_distance_mm) +
          source_term(virtual_height_mm.rgb, squared_distance_mm));
}
