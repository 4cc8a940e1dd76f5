#include "shared/bindings.glsl"

// The box that the mesh is projected on. Face f = 2·axis + (0 looks along −axis from above, 1 along +axis from below);
// a face's u and v are the two other axes in cyclic order.
layout(std140, binding = UNIFORMS_BOX) uniform Box {
  vec4 box_centre_mm;   // xyz
  vec4 box_extent_mm;   // xyz, all above 0
  int face_size_px;
};

int face_axis(int face) { return face >> 1; }
float face_sign(int face) { return (face & 1) == 0 ? 1.0 : -1.0; }
int u_axis(int axis) { return axis == 2 ? 0 : axis + 1; }
int v_axis(int axis) { return axis == 0 ? 2 : axis - 1; }
