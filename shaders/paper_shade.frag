#version 430 core
#include "shared/atlas_lookup.glsl"
#include "shared/irradiance.glsl"
#include "shared/view.glsl"

// Pass 2: local scattering from the selected face, and the global term (paper §4.3, §4.4).
layout(std140, binding = UNIFORMS_PAPER) uniform Paper {
  int terms;         // TERM_LOCAL | TERM_GLOBAL
  int kernel_taps;   // a side
  float global_gain;
};

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

// Σ E·Rd·dA over N×N bilinear taps that span the half-width k = (N·f)·l around the point on its face.
vec3 gather(int face, float scalar_product, vec3 from_centre_mm) {
  int axis = face_axis(face);
  vec2 extent_mm = vec2(box_extent_mm[u_axis(axis)], box_extent_mm[v_axis(axis)]);
  vec2 centre = face_uv(axis, from_centre_mm);
  float spacing_mm = 2.0 * scalar_product * virtual_height_mm.a / float(kernel_taps);
  vec3 sum = vec3(0.0);
  for (int j = 0; j < kernel_taps; ++j) {
    for (int i = 0; i < kernel_taps; ++i) {
      vec2 uv = centre + spacing_mm * (vec2(i, j) - 0.5 * float(kernel_taps - 1)) / extent_mm;
      vec4 surface = texture(atlas_surface, vec3(uv, face));
      if (surface.w < 1e-3) continue;
      vec3 tap_mm;
      tap_mm[u_axis(axis)] = (uv.x - 0.5) * extent_mm.x;
      tap_mm[v_axis(axis)] = (uv.y - 0.5) * extent_mm.y;
      tap_mm[axis] = surface.z / surface.w;
      vec2 along = surface.xy / surface.w;
      float facing = max(sqrt(max(0.0, 1.0 - dot(along, along))), 0.05);
      vec3 apart_mm = tap_mm - from_centre_mm;
      // The filtered E is already weighted by coverage.
      sum += texture(atlas_irradiance, vec3(uv, face)).rgb * diffuse_reflectance(dot(apart_mm, apart_mm)) / facing;
    }
  }
  return sum * spacing_mm * spacing_mm;
}

vec3 local_radiosity(vec3 from_centre_mm, vec3 n, float facet_sine) {
  // A face with N·f > 0 always has a corner above the tangent plane (Fig. 2), so the products alone choose and sort.
  vec3 products = abs(n);
  for (int i = 0; i < 3; ++i) {
    int axis = products.x >= products.y ? (products.x >= products.z ? 0 : 2) : (products.y >= products.z ? 1 : 2);
    float product = products[axis];
    if (product <= 0.05) break;
    products[axis] = -1.0;
    int face = 2 * axis + (n[axis] < 0.0 ? 1 : 0);
    if (agrees(face, from_centre_mm, n, facet_sine)) return gather(face, product, from_centre_mm);
  }
  return vec3(0.0);
}

// How far light has come within reach of the body. The paper's S is the distance to a point light; parallel light has
// none, and takes the way through the body's box (ours).
float travelled_mm(Light light, vec3 position_mm, vec3 towards) {
  if (light.power.a == 0.0) return length(light.position_mm.xyz - position_mm);
  vec3 walls_mm = box_centre_mm.xyz + 0.5 * sign(towards) * box_extent_mm.xyz - position_mm;
  vec3 ways_mm = walls_mm / mix(towards, vec3(1e-9), equal(towards, vec3(0.0)));
  return min(min(abs(ways_mm.x), abs(ways_mm.y)), abs(ways_mm.z));
}

// Eqs. 9 and 10 with zs = zr, an area of π l², and a distance of at least l; E with |N·ω| at the point itself.
vec3 global_radiosity(vec3 position_mm, vec3 n) {
  vec3 sum = vec3(0.0);
  vec3 l = mean_free_path_mm.rgb;
  for (int i = 0; i < lights.length(); ++i) {
    vec3 towards;
    vec3 arriving = arriving_light(lights[i], position_mm, towards);
    float cosine = abs(dot(n, towards));
    vec3 e = arriving * (cosine * fresnel_transmittance(mean_free_path_mm.a, cosine));
#ifdef LIT
    e *= lights[i].shape.z;  // what the body still gets of this light
#endif
    vec3 s = max(vec3(travelled_mm(lights[i], position_mm, towards)), l);
    vec3 optical = effective_transport_mm.rgb * s;
    vec3 ratio = l / s;
    sum += e * reduced_albedo.rgb * 0.25 * ratio * ratio * ratio * (1.0 + optical) * exp(-optical);
  }
  return global_gain * sum;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (position.w != mesh_id) discard;
  vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
  vec3 n = normal.xyz;
  vec3 radiosity = vec3(0.0);
  if ((terms & TERM_LOCAL) != 0) radiosity += local_radiosity(position.xyz - box_centre_mm.xyz, n, normal.w);
  if ((terms & TERM_GLOBAL) != 0) radiosity += global_radiosity(position.xyz, n);
#ifdef TEXTURED
  radiosity *= texelFetch(gbuffer_albedo, pixel, 0).rgb;
#endif
  float exit_cosine = abs(dot(n, normalize(eye_mm.xyz - position.xyz)));
  float transmittance = fresnel_transmittance(mean_free_path_mm.a, exit_cosine);
  radiance = vec4(radiance_scale * transmittance / PI * radiosity, 1.0);
#ifdef CHANNELS
#ifdef LIT
  vec3 e = texelFetch(gbuffer_irradiance, pixel, 0).rgb;
#else
  vec3 e = entering_irradiance(position.xyz, n);
#endif
  irradiance_channel = vec4(e, 1.0);
  radiosity_channel = vec4(radiosity, 1.0);
#endif
}
