#include "shared/box.glsl"

layout(binding = UNIT_ATLAS_IRRADIANCE) uniform sampler2DArray atlas_irradiance;
layout(binding = UNIT_ATLAS_SURFACE) uniform sampler2DArray atlas_surface;

vec2 face_uv(int axis, vec3 from_centre_mm) {
  vec3 unit = from_centre_mm / box_extent_mm.xyz + 0.5;
  return vec2(unit[u_axis(axis)], unit[v_axis(axis)]);
}

vec3 stored_normal(int face, vec2 along) {
  int axis = face_axis(face);
  vec3 n;
  n[u_axis(axis)] = along.x;
  n[v_axis(axis)] = along.y;
  n[axis] = face_sign(face) * sqrt(max(0.0, 1.0 - dot(along, along)));
  return n;
}

// Whether the surface that a face stores where `from_centre_mm` projects is the one that the point is on (paper §4.3.1).
// The paper compares the point's own dot(N, P) with the stored one. With the stored N in both products the difference is
// the distance from the point to the stored tangent plane, which one smooth surface keeps far below a texel. Where normals
// are interpolated over large triangles it is not the plane of the triangle: `facet_sine`, between the two at the point,
// widens the tolerance. A quarter of the bilinear footprint must agree, which steadies the answer at silhouettes.
bool agrees(int face, vec3 from_centre_mm, vec3 n, float facet_sine) {
  int axis = face_axis(face);
  vec2 texel_mm = vec2(box_extent_mm[u_axis(axis)], box_extent_mm[v_axis(axis)]) / float(face_size_px);
  float tolerance_mm = (0.2 + facet_sine) * max(texel_mm.x, texel_mm.y) / sqrt(abs(n[axis]));
  vec2 texel = face_uv(axis, from_centre_mm) * float(face_size_px) - 0.5;
  ivec2 lowest = ivec2(floor(texel));
  vec2 above = texel - vec2(lowest);
  float agreeing = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 at = clamp(lowest + corner, ivec2(0), ivec2(face_size_px - 1));
    vec4 stored = texelFetch(atlas_surface, ivec3(at, face), 0);
    if (stored.w == 0.0) continue;
    vec3 stored_n = stored_normal(face, stored.xy);
    float key = texelFetch(atlas_irradiance, ivec3(at, face), 0).a;
    if (dot(stored_n, n) > 0.5 && abs(dot(stored_n, from_centre_mm) - key) < tolerance_mm) {
      vec2 weight = mix(1.0 - above, above, vec2(corner));
      agreeing += weight.x * weight.y;
    }
  }
  return agreeing > 0.25;
}
