#include "shared/bindings.glsl"

layout(binding = UNIT_ALBEDO) uniform sampler2D albedo_map;
layout(binding = UNIT_NORMAL) uniform sampler2D normal_map;
layout(binding = UNIT_ROUGHNESS) uniform sampler2D roughness_map;

// What multiplies the light that leaves: the picture and the vertices' colours, each once.
vec3 surface_albedo(vec2 coordinate, vec3 color) { return color * texture(albedo_map, coordinate).rgb; }

// What multiplies the coat's alpha: glTF's roughness is alpha's root.
float roughness_share(vec2 coordinate) {
  float root = texture(roughness_map, coordinate).g;
  return root * root;
}

// The unit normal `n` as a tangent-space map turns it. The tangents run along the texture coordinates, which the
// derivatives of a pixel know (Schüler 2013): no tangents are uploaded, and a mesh may deform.
vec3 mapped_normal(vec3 n, vec3 position_mm, vec2 coordinate, float scale) {
  vec3 step_x_mm = dFdx(position_mm), step_y_mm = dFdy(position_mm);
  vec2 step_x = dFdx(coordinate), step_y = dFdy(coordinate);
  vec3 along_y = cross(step_y_mm, n), along_x = cross(n, step_x_mm);
  vec3 tangent = along_y * step_x.x + along_x * step_y.x;
  vec3 bitangent = along_y * step_x.y + along_x * step_y.y;
  float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
  if (!(scale > 0.0) || !(longest > 0.0)) return n;
  vec3 map = texture(normal_map, coordinate).xyz * (255.0 / 127.0) - 128.0 / 127.0;
  // Rows of a picture run down, its +y up.
  vec2 slope = scale * map.xy * vec2(1.0, -1.0) * inversesqrt(longest);
  return normalize(slope.x * tangent + slope.y * bitangent + max(map.z, 1e-3) * n);
}
