#version 430 core
#include "shared/view.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 position_mm;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;

out vec3 world_mm;
out vec3 world_normal;
#ifdef TEXTURED
layout(location = ATTRIBUTE_TEXTURE_COORDINATE) in vec2 coordinate_at_vertex;
layout(location = ATTRIBUTE_COLOR) in vec3 color_at_vertex;
out vec2 coordinate;
out vec3 color;
#endif
#ifdef LIT
layout(location = ATTRIBUTE_IRRADIANCE) in vec3 irradiance_at_vertex;
out vec3 entering;
#endif

void main() {
  world_mm = position_mm;
  world_normal = normal;
#ifdef TEXTURED
  coordinate = coordinate_at_vertex;
  color = color_at_vertex;
#endif
#ifdef LIT
  entering = irradiance_at_vertex;
#endif
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
}
