#version 430 core
#include "shared/view.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 position_mm;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;
layout(location = ATTRIBUTE_RADIOSITY) in vec3 radiosity;

out vec3 to_eye;
out vec3 world_normal;
out vec3 leaving;
#ifdef TEXTURED
layout(location = ATTRIBUTE_TEXTURE_COORDINATE) in vec2 coordinate_at_vertex;
layout(location = ATTRIBUTE_COLOR) in vec3 color_at_vertex;
out vec2 coordinate;
out vec3 color;
#endif
#ifdef CHANNELS
layout(location = ATTRIBUTE_IRRADIANCE) in vec3 irradiance_at_vertex;
out vec3 entering;
#endif

void main() {
  to_eye = eye_mm.xyz - position_mm;
  world_normal = normal;
#ifdef TEXTURED
  coordinate = coordinate_at_vertex;
  color = color_at_vertex;
#endif
  leaving = radiosity;
#ifdef CHANNELS
  entering = irradiance_at_vertex;
#endif
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
}
