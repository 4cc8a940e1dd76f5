#version 430 core
#include "shared/view.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 position_mm;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;
layout(location = ATTRIBUTE_RADIOSITY) in vec3 radiosity;

out vec3 to_eye;
out vec3 world_normal;
out vec3 leaving;

void main() {
  to_eye = eye_mm.xyz - position_mm;
  world_normal = normal;
  leaving = radiosity;
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
}
