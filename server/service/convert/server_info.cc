#include "service/convert/server_info.h"

#include "encode/h264.h"
#include "service/convert/frame.h"
#include "service/convert/upload.h"

namespace diaphane::service {

void to_proto(const render::RendererInfo& renderer, v1::ServerInfo& message) {
  message.set_gl_renderer(renderer.gl_renderer);
  message.set_gl_vendor(renderer.gl_vendor);
  message.set_gl_version(renderer.gl_version);
  message.set_software_rendering(renderer.software);
  message.set_context_reason(renderer.reason);
  for (const char* format : {"png", "jpeg", "exr", "webp"}) message.add_image_formats(format);
  if (!encode::h264_encoder().empty()) message.add_image_formats("h264");
  message.set_h264_encoder(encode::h264_encoder());
  for (const char* technique : {"integral", "paper", "reference", "lambert"}) message.add_techniques(technique);
}

void to_proto(const ServiceLimits& limits, v1::Limits& message) {
  message.set_max_pixels(limits.max_pixels);
  message.set_max_vertices_per_mesh(limits.scene.max_vertices_per_mesh);
  message.set_max_triangles_per_mesh(limits.scene.max_triangles_per_mesh);
  message.set_max_scenes(limits.scene.max_scenes);
  message.set_max_meshes_per_scene(limits.scene.max_meshes_per_scene);
  message.set_max_lights_per_scene(limits.scene.max_lights_per_scene);
  message.set_max_materials_per_scene(limits.scene.max_materials_per_scene);
  message.set_max_textures_per_scene(limits.scene.max_textures_per_scene);
  message.set_max_mesh_bytes(limits.scene.max_mesh_bytes);
  message.set_max_chunk_bytes(kMaxChunkBytes);
  message.set_max_queued_frames(limits.max_queued_frames);
  message.set_max_morph_targets_per_mesh(kMaxMorphTargets);
  message.set_max_reference_pixels(kMaxReferencePixels);
  message.set_max_reference_seconds(absl::ToDoubleSeconds(limits.max_reference_time));
}

}  // namespace diaphane::service
