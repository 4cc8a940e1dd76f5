#include "render/scene_painter.h"

#include <algorithm>
#include <cmath>

#include "absl/cleanup/cleanup.h"
#include "fmt/format.h"
#include "render/backdrop.h"
#include "render/develop.h"
#include "render/projection.h"

namespace diaphane::render {
namespace {

bool contains(const geometry::Bounds& bounds, const glm::vec3& point) {
  return glm::clamp(point, bounds.lowest, bounds.highest) == point;
}

bool is_textured(const std::vector<DrawnMesh>& meshes) {
  return std::any_of(meshes.begin(), meshes.end(), [](const DrawnMesh& drawn) {
    const geometry::SurfaceAttributes* attributes = drawn.mesh->attributes.get();
    if (attributes == nullptr) return false;
    return !attributes->colors.empty() || (!attributes->texture_coordinates.empty() && drawn.textures.any());
  });
}

bool has_native_path(Technique technique) {
  return technique == Technique::kPaper || technique == Technique::kIntegral;
}

}  // namespace

absl::Status ScenePainter::check_cancelled(const Job& job) {
  return job.cancelled.load() ? absl::CancelledError("the frame was cancelled while it was drawn") : absl::OkStatus();
}

void ScenePainter::bind_view(const Job& job, size_t mesh_index) {
  ViewUniforms of_mesh = job.view;
  of_mesh.mesh_id = static_cast<float>(mesh_index + 1);
  shading_.bind(of_mesh);
  const DrawnMesh& drawn = job.meshes[mesh_index];
  shading_.bind(material_uniforms(drawn.material, drawn.textures.normal.empty() ? 0 : drawn.textures.normal_scale));
  if (!job.variant.textured) return;
  textures_.bind(drawn.textures);
  // Of meshes without colours or texture coordinates.
  glVertexAttrib3f(ATTRIBUTE_COLOR, 1, 1, 1);
  glVertexAttrib2f(ATTRIBUTE_TEXTURE_COORDINATE, 0, 0);
}

/// Whether triangles that look away are hidden by others.
bool ScenePainter::shows_outside_alone(const Job& job, size_t mesh_index) {
  const DrawnMesh& drawn = job.meshes[mesh_index];
  return drawn.mesh->topology->encloses_volume &&
         !contains(drawn.state->placed.bounds_mm(), glm::vec3(job.view.eye_mm));
}

void ScenePainter::draw_meshes(const Job& job) {
  for (size_t i = 0; i < job.meshes.size(); ++i) {
    bind_view(job, i);
    job.meshes[i].state->gpu.draw(shows_outside_alone(job, i));
  }
}

void ScenePainter::set_viewport(const Job& job, const Tile& tile) const {
  glViewport(-static_cast<GLint>(tile.x_px), -static_cast<GLint>(tile.y_px), static_cast<GLsizei>(job.request.width_px),
             static_cast<GLsizei>(job.request.height_px));
}

void ScenePainter::draw_gbuffer(Job& job, const Tile& tile) {
  job.clock.run("gbuffer", [&] {
    targets_->begin_gbuffer(job.variant);
    set_viewport(job, tile);
    glUseProgram(shading_.gbuffer(job.variant).id());
    draw_meshes(job);
    glFinish();
  });
}

void ScenePainter::draw_forward(Job& job, const Tile& tile) {
  job.clock.run("draw", [&] {
    targets_->begin_forward(job.variant);
    set_viewport(job, tile);
    glUseProgram(shading_.integral(job.variant).id());
    draw_meshes(job);
    glFinish();
  });
}

void ScenePainter::shade_tile(Job& job, const Tile& tile) {
  const RenderSettings& settings = job.request.settings;
  job.clock.run("shade", [&] {
    targets_->begin_shading(job.variant);
    glViewport(0, 0, static_cast<GLsizei>(tile.width_px), static_cast<GLsizei>(tile.height_px));
    for (size_t i = 0; i < job.meshes.size(); ++i) {
      const MeshState& state = *job.meshes[i].state;
      bind_view(job, i);
      if (job.variant.lit) shading_.bind(state.vertex_light.lights());
      if (settings.technique == Technique::kPaper) {
        shading_.shade_paper(*state.atlas, settings.paper, job.variant);
      } else {
        shading_.shade_lambert(job.variant);
      }
    }
    glFinish();
  });
}

/// The G-buffer, as far as it was drawn.
void ScenePainter::read_surface(Job& job, const Tile& tile) {
  const size_t count = size_t{tile.width_px} * tile.height_px;
  ChannelTile& channels = job.channels;
  channels.position_mm.resize(count);
  channels.normal.resize(count);
  channels.albedo.resize(job.variant.textured ? count : 0);
  channels.coat.resize(job.variant.textured ? count : 0);
  job.clock.run("read_back", [&] {
    targets_->read_gbuffer(tile.width_px, tile.height_px, channels.position_mm.data(), channels.normal.data());
    if (!job.variant.textured) return;
    targets_->read_textured(tile.width_px, tile.height_px, channels.albedo.data(), channels.coat.data());
  });
}

void ScenePainter::read_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  const uint32_t width = tile.width_px;
  const uint32_t height = tile.height_px;
  const size_t count = size_t{width} * height;
  job.clock.run("read_back", [&] { targets_->read_back(width, height, pixels); });
  ChannelTile& channels = job.channels;
  if (job.needs.light) {
    channels.irradiance.resize(count);
    channels.radiosity.resize(count);
    job.clock.run("read_back", [&] {
      targets_->read_channels(width, height, channels.irradiance.data(), channels.radiosity.data());
    });
  }
  if (!job.needs.surface && !job.coated) return;
  if (job.request.settings.technique == Technique::kIntegral) draw_gbuffer(job, tile);
  read_surface(job, tile);
}

absl::Status ScenePainter::draw_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  if (absl::Status status = check_cancelled(job); !status.ok()) return status;
  const Technique technique = job.request.settings.technique;
  if (technique == Technique::kReference) {
    if (absl::Status status = draw_reference_tile(job, tile, pixels); !status.ok()) return status;
  } else if (job.native) {
    draw_native_tile(job, tile, pixels);
  } else {
    if (technique == Technique::kIntegral) {
      draw_forward(job, tile);
    } else {
      draw_gbuffer(job, tile);
      shade_tile(job, tile);
    }
    read_tile(job, tile, pixels);
  }
  if (job.coated) {
    add_coats(job, {reinterpret_cast<glm::vec4*>(pixels), size_t{tile.width_px} * tile.height_px});
  }
  return absl::OkStatus();
}

absl::StatusOr<Frame> ScenePainter::paint(const FrameRequest& request, const std::atomic<bool>& cancelled,
                                          Frame spare) {
  const scene::SceneSnapshot& scene = *request.scene;
  if (scene.meshes.empty()) return absl::FailedPreconditionError(fmt::format("{}: has no mesh to draw", scene.name));
  if (request.settings.environment_background && scene.environment == nullptr) {
    return absl::FailedPreconditionError(
        fmt::format("settings.background.environment: {} has no environment to show", scene.name));
  }
  const bool picture = request.format == PixelFormat::kSrgb8;
  const bool coated = has_coats(request);
  const bool developed = picture && (coated || needs_developing(request.settings));
  Job job{request, cancelled, needs_of(request), developed ? PixelFormat::kLinearFloat : request.format, coated,
          drawn_,  lights_};
  // What a scene lets go of is not kept by its last frame.
  const absl::Cleanup forget = [this] { drawn_.clear(); };
  drawn_.clear();
  job.clock = StageClock(std::move(spare.stages));
  const Technique technique = request.settings.technique;
  job.variant.lit = (casts_shadows(request.settings) || scene.environment != nullptr) &&
                    (technique == Technique::kPaper || technique == Technique::kLambert);
  job.variant.channels = job.needs.light;
  gather_meshes(job);
  job.variant.textured = is_textured(job.meshes);
  job.native = native_ && !job.variant.textured && has_native_path(technique);
  was_native_ = job.native;
  if (absl::Status updated = update(job); !updated.ok()) return updated;

  const float aspect = static_cast<float>(request.width_px) / static_cast<float>(request.height_px);
  job.view.clip_from_world = clip_from_world(request.camera, scene.millimetres_per_unit, aspect, job.bounds_mm);
  job.view.eye_mm = glm::vec4(request.camera.eye * static_cast<float>(scene.millimetres_per_unit), 1);
  job.view.radiance_scale = picture && !developed ? std::exp2(request.settings.exposure_ev) : 1.0f;

  Frame frame = std::move(spare);
  frame.exposure_ev = 0;
  frame.scene_revision = scene.revision;
  if (absl::Status drawn = draw_tiles(job, frame); !drawn.ok()) return drawn;
  if (request.settings.background) lay_over(*request.settings.background, std::get<base::ImageF>(frame.image));
  if (request.settings.environment_background) {
    job.clock.run("backdrop", [&] {
      lay_over_environment(*scene.environment, request.camera, request.settings.samples,
                           std::get<base::ImageF>(frame.image));
    });
  }
  if (picture) frame.exposure_ev = request.settings.exposure_ev;
  if (developed) {
    job.clock.run("develop", [&] {
      const auto& linear = std::get<base::ImageF>(frame.image);
      if (request.settings.auto_exposure) frame.exposure_ev += find_exposure_ev(linear);
      frame.image = develop(linear, frame.exposure_ev, request.settings.tone_mapping);
    });
  }
  frame.stages = job.clock.take();
  return frame;
}

}  // namespace diaphane::render
