#include "render/scene_painter.h"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"
#include "render/brute_force.h"
#include "render/lights.h"
#include "render/pixels.h"
#include "render/projection.h"

namespace diaphane::render {
namespace {

// Beyond this, meshes that the frame does not show lose what was kept of them.
constexpr size_t kMaxKeptBytes = size_t{2} << 30;

const optics::Coefficients& material_of(const scene::SceneSnapshot& scene, const scene::Mesh& mesh) {
  static const optics::Coefficients kFallback;
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const scene::Material& m) { return m.name == mesh.material; });
  return found == scene.materials.end() ? kFallback : found->coefficients;
}

// What the expansions of the integral take in float.
constexpr float kLargestIntegral_mm = 1e7f;

bool beyond(const geometry::Bounds& bounds_mm, float limit_mm) {
  const glm::vec3 farthest = glm::max(glm::abs(bounds_mm.lowest), glm::abs(bounds_mm.highest));
  return !(std::max({farthest.x, farthest.y, farthest.z}) <= limit_mm);
}

bool contains(const geometry::Bounds& bounds, const glm::vec3& point) {
  return glm::clamp(point, bounds.lowest, bounds.highest) == point;
}

absl::Status check(const std::atomic<bool>& cancelled) {
  return cancelled.load() ? absl::CancelledError("the frame was cancelled while it was drawn") : absl::OkStatus();
}

}  // namespace

void ScenePainter::gather_meshes(Job& job) {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.placed.orphaned(); });
  const scene::SceneSnapshot& scene = *job.request.scene;
  for (const auto& mesh : scene.meshes) {
    MeshState& state = meshes_[mesh->name];
    state.placed.update(*mesh, scene.millimetres_per_unit, job.clock);
    job.meshes.push_back({mesh.get(), &state, material_of(scene, *mesh)});
  }
  job.bounds_mm = job.meshes.front().state->placed.bounds_mm();
  for (const DrawnMesh& drawn : job.meshes) {
    const geometry::Bounds& bounds = drawn.state->placed.bounds_mm();
    job.bounds_mm.lowest = glm::min(job.bounds_mm.lowest, bounds.lowest);
    job.bounds_mm.highest = glm::max(job.bounds_mm.highest, bounds.highest);
  }
  job.lights = lights_of(scene, job.bounds_mm);
}

void ScenePainter::update_shadows(Job& job) {
  const bool refined = job.request.settings.technique == Technique::kIntegral;
  std::vector<uint64_t> reads;
  std::vector<ShadowCaster> casters;
  for (const DrawnMesh& drawn : job.meshes) {
    const MeshState& state = *drawn.state;
    reads.push_back(refined ? state.refined.generation() : state.placed.generation());
    const geometry::MeshTopology& topology = refined ? *state.refined.topology() : *drawn.mesh->topology;
    const geometry::PlacedShape& shape = refined ? state.refined.shape() : state.placed.shape();
    casters.push_back({topology.triangles, shape.positions_mm, topology.encloses_volume, shape.flipped});
  }
  if (!shadow_reads_.renew(std::move(reads))) return;
  shadows_.set_casters(std::move(casters), job.bounds_mm);
  ++shadows_generation_;
}

absl::Status ScenePainter::refine(Job& job) {
  for (const DrawnMesh& drawn : job.meshes) {
    if (absl::Status status = check(job.cancelled); !status.ok()) return status;
    absl::Status status = drawn.state->refined.update(*drawn.mesh, drawn.state->placed, drawn.material, job.clock);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

void ScenePainter::bound_memory(const Job& job) {
  const auto bytes_of = [](const MeshState& state) {
    return state.light.bytes() + (state.atlas.has_value() ? state.atlas->bytes() : 0);
  };
  size_t bytes = 0;
  for (const auto& [name, state] : meshes_) bytes += bytes_of(state);
  std::erase_if(meshes_, [&](const auto& entry) {
    const MeshState& state = entry.second;
    if (bytes <= kMaxKeptBytes) return false;
    const auto draws = [&](const DrawnMesh& drawn) { return drawn.state == &state; };
    if (std::any_of(job.meshes.begin(), job.meshes.end(), draws)) return false;
    bytes -= bytes_of(state);
    return true;
  });
}

void ScenePainter::update_atlas(const DrawnMesh& drawn, Job& job) {
  const uint32_t face_size_px = job.request.settings.paper.face_size_px;
  AtlasKey key{drawn.state->placed.generation(), job.lights, drawn.material.refractive_index, face_size_px};
  if (drawn.state->atlas.has_value() && drawn.state->atlas->key() == key) {
    job.clock.sleep("atlas");
    return;
  }
  job.clock.run("atlas", [&] {
    const BoxUniforms box = fit_box(drawn.state->placed.bounds_mm(), face_size_px);
    drawn.state->atlas.emplace(std::move(key), box);
    shading_.bind(box);
    shading_.bind(material_uniforms(drawn.material));
    drawn.state->atlas->render(shading_.atlas(), [&] { drawn.state->gpu.draw(); });
    glFinish();
  });
}

absl::Status ScenePainter::update(Job& job) {
  const RenderSettings& settings = job.request.settings;
  const bool shadowed =
      settings.shadows && (settings.technique == Technique::kIntegral || settings.technique == Technique::kReference);
  if (settings.technique == Technique::kIntegral && beyond(job.bounds_mm, kLargestIntegral_mm)) {
    return absl::FailedPreconditionError(fmt::format("{}: the integral takes bodies within ±{:g} mm of the origin",
                                                     job.request.scene->name, kLargestIntegral_mm));
  }
  if (settings.technique == Technique::kIntegral) {
    if (absl::Status refined = refine(job); !refined.ok()) return refined;
  }
  if (shadowed) update_shadows(job);
  shading_.bind(std::span<const LightStorage>(job.lights));
  for (const DrawnMesh& drawn : job.meshes) {
    if (absl::Status status = check(job.cancelled); !status.ok()) return status;
    MeshState& state = *drawn.state;
    if (settings.technique == Technique::kIntegral) {
      RefinedMesh& refined = state.refined;
      state.light.update({refined, job.lights, drawn.material, settings.quality, shadowed ? &shadows_ : nullptr,
                          shadowed ? shadows_generation_ : 0},
                         job.clock);
      state.gpu.update(refined.topology(), refined.shape(), refined.generation(), job.clock);
      state.gpu.update_radiosity(state.light.radiosity(), state.light.generation(), job.clock);
    } else {
      state.placed.complete_normals(job.clock);
      state.gpu.update(drawn.mesh->topology, state.placed.shape(), state.placed.generation(), job.clock);
      if (settings.technique == Technique::kPaper) update_atlas(drawn, job);
    }
  }
  bound_memory(job);
  return absl::OkStatus();
}

void ScenePainter::bind_view(const Job& job, size_t mesh_index) const {
  ViewUniforms of_mesh = job.view;
  of_mesh.mesh_id = static_cast<float>(mesh_index + 1);
  of_mesh.flipped = job.meshes[mesh_index].state->gpu.flipped() ? 1.0f : 0.0f;
  shading_.bind(of_mesh);
  shading_.bind(material_uniforms(job.meshes[mesh_index].material));
}

void ScenePainter::draw_meshes(const Job& job) const {
  for (size_t i = 0; i < job.meshes.size(); ++i) {
    bind_view(job, i);
    const MeshState& state = *job.meshes[i].state;
    const bool from_outside = !contains(state.placed.bounds_mm(), glm::vec3(job.view.eye_mm));
    state.gpu.draw(from_outside && job.meshes[i].mesh->topology->encloses_volume);
  }
}

void ScenePainter::set_viewport(const Job& job, const Tile& tile) const {
  glViewport(-static_cast<GLint>(tile.x_px), -static_cast<GLint>(tile.y_px), static_cast<GLsizei>(job.request.width_px),
             static_cast<GLsizei>(job.request.height_px));
}

void ScenePainter::draw_gbuffer(Job& job, const Tile& tile) {
  job.clock.run("gbuffer", [&] {
    targets_->begin_gbuffer();
    set_viewport(job, tile);
    glUseProgram(shading_.gbuffer().id());
    draw_meshes(job);
    glFinish();
  });
}

absl::Status ScenePainter::draw_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  if (absl::Status status = check(job.cancelled); !status.ok()) return status;
  const RenderSettings& settings = job.request.settings;
  if (settings.technique == Technique::kReference) return draw_reference_tile(job, tile, pixels);
  if (settings.technique == Technique::kIntegral) {
    job.clock.run("draw", [&] {
      targets_->begin_forward();
      set_viewport(job, tile);
      glUseProgram(shading_.integral().id());
      draw_meshes(job);
      glFinish();
    });
  } else {
    draw_gbuffer(job, tile);
    job.clock.run("shade", [&] {
      targets_->begin_shading();
      glViewport(0, 0, static_cast<GLsizei>(tile.width_px), static_cast<GLsizei>(tile.height_px));
      for (size_t i = 0; i < job.meshes.size(); ++i) {
        bind_view(job, i);
        if (settings.technique == Technique::kPaper) {
          shading_.shade_paper(*job.meshes[i].state->atlas, settings.paper);
        } else {
          shading_.shade_lambert();
        }
      }
      glFinish();
    });
  }
  job.clock.run("read_back", [&] { targets_->read_back(tile.width_px, tile.height_px, pixels); });
  return absl::OkStatus();
}

absl::Status ScenePainter::draw_reference_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  draw_gbuffer(job, tile);
  const size_t count = size_t{tile.width_px} * tile.height_px;
  std::vector<glm::vec4> positions(count);
  std::vector<glm::vec4> normals(count);
  job.clock.run("read_back",
                [&] { targets_->read_gbuffer(tile.width_px, tile.height_px, positions.data(), normals.data()); });
  std::vector<glm::vec4> radiance(count, glm::vec4(0));
  for (size_t i = 0; i < job.meshes.size(); ++i) {
    const DrawnMesh& drawn = job.meshes[i];
    std::vector<size_t> pixels_of_mesh;
    std::vector<glm::vec3> points_mm;
    std::vector<glm::vec3> points_normals;
    for (size_t p = 0; p < count; ++p) {
      if (positions[p].w != static_cast<float>(i + 1)) continue;
      pixels_of_mesh.push_back(p);
      points_mm.emplace_back(positions[p]);
      points_normals.emplace_back(normals[p]);
    }
    if (job.request.settings.shadows) shadows_.prepare_rays();
    const BruteForceBody body{*drawn.mesh->topology, drawn.state->placed.shape(), drawn.material, job.lights,
                              job.request.settings.shadows ? &shadows_ : nullptr};
    const auto leaving = job.clock.run("brute_force", [&] {
      return brute_force_radiance(body, points_mm, points_normals, glm::vec3(job.view.eye_mm), job.cancelled);
    });
    if (!leaving.ok()) return leaving.status();
    for (size_t k = 0; k < pixels_of_mesh.size(); ++k) radiance[pixels_of_mesh[k]] = glm::vec4((*leaving)[k], 1);
  }
  store_pixels(radiance, job.view.radiance_scale, job.request.format, pixels);
  return absl::OkStatus();
}

absl::StatusOr<Frame> ScenePainter::paint(const FrameRequest& request, const std::atomic<bool>& cancelled) {
  const scene::SceneSnapshot& scene = *request.scene;
  if (scene.meshes.empty()) return absl::FailedPreconditionError(fmt::format("{}: has no mesh to draw", scene.name));
  Job job{request, cancelled, {}, {}, {}, {}, {}};
  gather_meshes(job);
  if (absl::Status updated = update(job); !updated.ok()) return updated;

  const float aspect = static_cast<float>(request.width_px) / static_cast<float>(request.height_px);
  job.view.clip_from_world = clip_from_world(request.camera, scene.millimetres_per_unit, aspect, job.bounds_mm);
  job.view.eye_mm = glm::vec4(request.camera.eye * static_cast<float>(scene.millimetres_per_unit), 1);
  const bool picture = request.format == PixelFormat::kSrgb8;
  job.view.radiance_scale = picture ? std::exp2(request.settings.exposure_ev) : 1.0f;

  const uint32_t target_width = std::min(request.width_px, kTile_px);
  const uint32_t target_height = std::min(request.height_px, kTile_px);
  if (!targets_.has_value() || !targets_->fits(target_width, target_height, request.format)) {
    targets_.reset();
    targets_.emplace(target_width, target_height, request.format);
  }
  Frame frame;
  frame.scene_revision = scene.revision;
  const Canvas canvas = make_canvas(frame, request);
  std::vector<uint8_t> pixels(size_t{target_width} * target_height * canvas.bytes_per_pixel);
  const absl::Status drawn = for_each_tile(request.width_px, request.height_px, [&](const Tile& tile) {
    absl::Status status = draw_tile(job, tile, pixels.data());
    if (status.ok()) place_tile(canvas, tile, pixels.data());
    return status;
  });
  if (!drawn.ok()) return drawn;
  frame.stages = job.clock.take();
  return frame;
}

}  // namespace diaphane::render
