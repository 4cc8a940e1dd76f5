#include "shared/bindings.glsl"

// A light of any kind, in millimetres and world axes. C++: render/uniforms.h.
struct Light {
  vec4 position_mm;  // xyz; or the unit direction to a directional light
  vec4 power;        // rgb: W/sr, or W/mm² of a directional light; a: 1 directional, else 0
  vec4 axis;         // xyz: unit axis of a spot's cone; a: cosine of its outer angle, −2 without a cone
  vec4 shape;        // x: 1/(cosine inner − cosine outer); y: radius in mm; z: share that the body gets, with shadows
};

layout(std430, binding = STORAGE_LIGHTS) readonly buffer Lights {
  Light lights[];
};

// RGB irradiance on a surface that faces the light. As render/lights.h.
vec3 arriving_light(Light light, vec3 position_mm, out vec3 towards) {
  if (light.power.a != 0.0) {
    towards = light.position_mm.xyz;
    return light.power.rgb;
  }
  vec3 to_light = light.position_mm.xyz - position_mm;
  float squared = max(dot(to_light, to_light), 1e-12);
  towards = to_light * inversesqrt(squared);
  float cone = clamp((-dot(towards, light.axis.xyz) - light.axis.a) * light.shape.x, 0.0, 1.0);
  float share = light.axis.a < -1.0 ? 1.0 : cone * cone * (3.0 - 2.0 * cone);
  return light.power.rgb * (share / squared);
}
