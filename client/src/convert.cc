#include "convert.h"

#include <utility>

namespace diaphane::internal {
namespace {

// Both spellings of an enumeration have the same numbers.
static_assert(int{v1::TECHNIQUE_UNSPECIFIED} == static_cast<int>(Technique::kServerDefault));
static_assert(int{v1::TECHNIQUE_PAPER} == static_cast<int>(Technique::kPaper));
static_assert(int{v1::TECHNIQUE_LAMBERT} == static_cast<int>(Technique::kLambert));
static_assert(int{v1::TECHNIQUE_INTEGRAL} == static_cast<int>(Technique::kIntegral));
static_assert(int{v1::TECHNIQUE_REFERENCE} == static_cast<int>(Technique::kReference));
static_assert(int{v1::QUALITY_DRAFT} == static_cast<int>(Quality::kDraft));
static_assert(int{v1::QUALITY_NORMAL} == static_cast<int>(Quality::kNormal));
static_assert(int{v1::QUALITY_FINE} == static_cast<int>(Quality::kFine));
static_assert(int{v1::SHADOWS_ON} == static_cast<int>(Shadows::kOn));
static_assert(int{v1::SHADOWS_OFF} == static_cast<int>(Shadows::kOff));
static_assert(int{v1::TERMS_BOTH} == static_cast<int>(Terms::kBoth));
static_assert(int{v1::TERMS_LOCAL} == static_cast<int>(Terms::kLocal));
static_assert(int{v1::TERMS_GLOBAL} == static_cast<int>(Terms::kGlobal));
static_assert(int{v1::TONE_MAPPING_NONE} == static_cast<int>(ToneMapping::kNone));
static_assert(int{v1::TONE_MAPPING_NEUTRAL} == static_cast<int>(ToneMapping::kNeutral));
static_assert(int{v1::IMAGE_FORMAT_PNG} == static_cast<int>(ImageFormat::kPng));
static_assert(int{v1::IMAGE_FORMAT_WEBP} == static_cast<int>(ImageFormat::kWebp));
static_assert(int{v1::IMAGE_FORMAT_H264} == static_cast<int>(ImageFormat::kH264));
static_assert(int{v1::IMAGE_FORMAT_JPEG} == static_cast<int>(ImageFormat::kJpeg));
static_assert(int{v1::IMAGE_FORMAT_EXR} == static_cast<int>(ImageFormat::kExr));
static_assert(int{v1::CHANNEL_IRRADIANCE} == static_cast<int>(Channel::kIrradiance));
static_assert(int{v1::CHANNEL_RADIOSITY} == static_cast<int>(Channel::kRadiosity));
static_assert(int{v1::CHANNEL_NORMAL} == static_cast<int>(Channel::kNormal));
static_assert(int{v1::CHANNEL_DEPTH} == static_cast<int>(Channel::kDepth));
static_assert(int{v1::CHANNEL_POSITION} == static_cast<int>(Channel::kPosition));

v1::Vec3 vec3(float x, float y, float z) {
  v1::Vec3 message;
  message.set_x(x);
  message.set_y(y);
  message.set_z(z);
  return message;
}

v1::PointLight point_to_proto(const PointLight& light) {
  v1::PointLight message;
  *message.mutable_position() = vec3(light.position.x, light.position.y, light.position.z);
  *message.mutable_intensity() = vec3(light.intensity_w_sr.r, light.intensity_w_sr.g, light.intensity_w_sr.b);
  message.set_radius_mm(light.radius_mm);
  return message;
}

PointLight point_from_proto(const v1::PointLight& message) {
  const v1::Vec3& position = message.position();
  const v1::Vec3& intensity = message.intensity();
  return {
      {position.x(), position.y(), position.z()}, {intensity.x(), intensity.y(), intensity.z()}, message.radius_mm()};
}

}  // namespace

v1::Vec3 to_proto(const Vec3& value) { return vec3(value.x, value.y, value.z); }

v1::Vec3 to_proto(const Rgb& value) { return vec3(value.r, value.g, value.b); }

v1::Camera to_proto(const Camera& camera) {
  v1::Camera message;
  *message.mutable_eye() = to_proto(camera.eye);
  *message.mutable_target() = to_proto(camera.target);
  *message.mutable_up() = to_proto(camera.up);
  message.set_fov_y_deg(camera.fov_y_deg);
  return message;
}

v1::Light to_proto(const Light& light) {
  v1::Light message;
  if (const auto* point = std::get_if<PointLight>(&light)) {
    *message.mutable_point() = point_to_proto(*point);
  } else if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
    *message.mutable_directional()->mutable_direction() = to_proto(directional->direction);
    *message.mutable_directional()->mutable_irradiance() = to_proto(directional->irradiance);
  } else {
    const auto& spot = std::get<SpotLight>(light);
    *message.mutable_spot()->mutable_point() = point_to_proto(spot.point);
    *message.mutable_spot()->mutable_direction() = to_proto(spot.direction);
    message.mutable_spot()->set_inner_angle_deg(spot.inner_angle_deg);
    message.mutable_spot()->set_outer_angle_deg(spot.outer_angle_deg);
  }
  return message;
}

const char* kind_of(const Light& light) {
  constexpr const char* kKinds[] = {"point", "directional", "spot"};
  return kKinds[light.index()];
}

v1::RenderSettings to_proto(const RenderSettings& settings) {
  v1::RenderSettings message;
  message.set_technique(static_cast<v1::Technique>(settings.technique));
  message.mutable_paper()->set_terms(static_cast<v1::Terms>(settings.paper.terms));
  message.mutable_paper()->set_kernel_taps(settings.paper.kernel_taps);
  message.mutable_paper()->set_face_size_px(settings.paper.face_size_px);
  message.mutable_paper()->set_global_gain(settings.paper.global_gain);
  message.set_exposure_ev(settings.exposure_ev);
  message.set_quality(static_cast<v1::Quality>(settings.quality));
  message.set_shadows(static_cast<v1::Shadows>(settings.shadows));
  message.set_slab_correction(settings.slab_correction);
  message.set_auto_exposure(settings.auto_exposure);
  message.set_tone_mapping(static_cast<v1::ToneMapping>(settings.tone_mapping));
  message.set_samples(settings.samples);
  if (settings.background) *message.mutable_background()->mutable_color() = to_proto(*settings.background);
  if (settings.environment_background) message.mutable_background()->set_environment(true);
  return message;
}

v1::RenderFrameRequest to_proto(const RenderOptions& options) {
  v1::RenderFrameRequest message;
  *message.mutable_camera() = to_proto(options.camera);
  message.mutable_size()->set_width_px(options.size.width_px);
  message.mutable_size()->set_height_px(options.size.height_px);
  *message.mutable_settings() = to_proto(options.settings);
  message.mutable_encoding()->set_format(static_cast<v1::ImageFormat>(options.format));
  message.mutable_encoding()->set_quality(options.quality);
  message.set_min_revision(options.min_revision);
  for (const Channel channel : options.channels) {
    message.mutable_encoding()->add_channels(static_cast<v1::Channel>(channel));
  }
  return message;
}

Vec3 vec3_from_proto(const v1::Vec3& message) { return {message.x(), message.y(), message.z()}; }

Rgb rgb_from_proto(const v1::Vec3& message) { return {message.x(), message.y(), message.z()}; }

Light from_proto(const v1::Light& message) {
  if (message.has_directional()) {
    return DirectionalLight{vec3_from_proto(message.directional().direction()),
                            rgb_from_proto(message.directional().irradiance())};
  }
  if (message.has_spot()) {
    return SpotLight{point_from_proto(message.spot().point()), vec3_from_proto(message.spot().direction()),
                     message.spot().inner_angle_deg(), message.spot().outer_angle_deg()};
  }
  return point_from_proto(message.point());
}

SceneInfo from_proto(const v1::Scene& message) {
  return {.name = message.name(),
          .display_name = message.display_name(),
          .millimetres_per_unit = message.millimetres_per_unit() == 0 ? 1 : message.millimetres_per_unit(),
          .revision = message.revision(),
          .mesh_count = message.mesh_count(),
          .material_count = message.material_count(),
          .light_count = message.light_count(),
          .has_environment = message.has_environment(),
          .texture_count = message.texture_count()};
}

MeshInfo from_proto(const v1::Mesh& message) {
  MeshInfo mesh{.handle = {message.name()},
                .material = {message.material()},
                .scene_from_mesh = MeshData().scene_from_mesh,
                .vertex_count = message.vertex_count(),
                .triangle_count = message.triangle_count(),
                .has_normals = message.has_normals(),
                .positions_revision = message.positions_revision(),
                .has_texture_coordinates = message.has_texture_coordinates(),
                .has_colors = message.has_colors()};
  if (message.scene_from_mesh_size() == static_cast<int>(mesh.scene_from_mesh.size())) {
    for (int i = 0; i < message.scene_from_mesh_size(); ++i) mesh.scene_from_mesh[i] = message.scene_from_mesh(i);
  }
  return mesh;
}

RenderSettings from_proto(const v1::RenderSettings& message) {
  RenderSettings settings{.technique = static_cast<Technique>(message.technique()),
                          .shadows = static_cast<Shadows>(message.shadows()),
                          .slab_correction = message.slab_correction(),
                          .exposure_ev = message.exposure_ev(),
                          .auto_exposure = message.auto_exposure()};
  if (message.tone_mapping() != v1::TONE_MAPPING_UNSPECIFIED) {
    settings.tone_mapping = static_cast<ToneMapping>(message.tone_mapping());
  }
  if (message.samples() != 0) settings.samples = message.samples();
  if (message.background().has_color()) settings.background = rgb_from_proto(message.background().color());
  settings.environment_background = message.background().environment();
  if (message.quality() != v1::QUALITY_UNSPECIFIED) settings.quality = static_cast<Quality>(message.quality());
  const v1::PaperSettings& paper = message.paper();
  if (paper.terms() != v1::TERMS_UNSPECIFIED) settings.paper.terms = static_cast<Terms>(paper.terms());
  if (paper.kernel_taps() != 0) settings.paper.kernel_taps = paper.kernel_taps();
  if (paper.face_size_px() != 0) settings.paper.face_size_px = paper.face_size_px();
  if (paper.has_global_gain()) settings.paper.global_gain = paper.global_gain();
  return settings;
}

RenderedFrame from_proto(v1::RenderFrameResponse&& message) {
  RenderedFrame frame{.image = std::move(*message.mutable_image()),
                      .content_type = message.content_type(),
                      .scene_revision = message.scene_revision(),
                      .size = {message.size().width_px(), message.size().height_px()},
                      .path = message.path(),
                      .exposure_ev = message.exposure_ev()};
  for (const v1::StageTime& stage : message.stages()) {
    frame.stages.push_back({stage.stage(), stage.milliseconds(), stage.ran()});
  }
  return frame;
}

ServerInfo from_proto(const v1::ServerInfo& message) {
  const v1::Limits& limits = message.limits();
  return {.version = message.version(),
          .gl_renderer = message.gl_renderer(),
          .gl_vendor = message.gl_vendor(),
          .gl_version = message.gl_version(),
          .software_rendering = message.software_rendering(),
          .context_reason = message.context_reason(),
          .max_pixels = limits.max_pixels(),
          .max_reference_pixels = limits.max_reference_pixels(),
          .max_reference_seconds = limits.max_reference_seconds(),
          .max_vertices_per_mesh = limits.max_vertices_per_mesh(),
          .max_triangles_per_mesh = limits.max_triangles_per_mesh(),
          .max_scenes = limits.max_scenes(),
          .max_meshes_per_scene = limits.max_meshes_per_scene(),
          .max_lights_per_scene = limits.max_lights_per_scene(),
          .max_materials_per_scene = limits.max_materials_per_scene(),
          .max_mesh_bytes = limits.max_mesh_bytes(),
          .max_chunk_bytes = limits.max_chunk_bytes(),
          .max_queued_frames = limits.max_queued_frames(),
          .image_formats = {message.image_formats().begin(), message.image_formats().end()},
          .techniques = {message.techniques().begin(), message.techniques().end()}};
}

}  // namespace diaphane::internal
