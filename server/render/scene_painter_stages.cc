// What a frame's meshes need before they are drawn.
#include <algorithm>

#include "fmt/format.h"
#include "render/lights.h"
#include "render/scene_painter.h"

namespace diaphane::render {
namespace {

// Beyond this, meshes that the frame does not show lose what was kept of them.
constexpr size_t kMaxKeptBytes = size_t{2} << 30;

// What the expansions of the integral take in float.
constexpr float kLargestIntegral_mm = 1e7f;

bool beyond(const geometry::Bounds& bounds_mm, float limit_mm) {
  const glm::vec3 farthest = glm::max(glm::abs(bounds_mm.lowest), glm::abs(bounds_mm.highest));
  return !(std::max({farthest.x, farthest.y, farthest.z}) <= limit_mm);
}

/// Without texture coordinates there is nothing to look up.
scene::SurfaceTextures surface_textures(const scene::Material* material, const scene::Mesh& mesh) {
  if (material == nullptr || mesh.attributes == nullptr || mesh.attributes->texture_coordinates.empty()) return {};
  return material->textures;
}

}  // namespace

void ScenePainter::gather_meshes(Job& job) {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.placed.orphaned(); });
  coats_.forget_orphans();
  textures_.forget_orphans();
  const scene::SceneSnapshot& scene = *job.request.scene;
  for (const auto& mesh : scene.meshes) {
    MeshState& state = meshes_[mesh->name];
    state.placed.update(*mesh, scene.millimetres_per_unit, job.clock);
    const scene::Material* material = scene::material_of(scene, *mesh);
    job.meshes.push_back({mesh.get(), &state, material == nullptr ? optics::Coefficients{} : material->coefficients,
                          material == nullptr ? std::nullopt : material->coat, surface_textures(material, *mesh)});
  }
  job.bounds_mm = job.meshes.front().state->placed.bounds_mm();
  for (const DrawnMesh& drawn : job.meshes) {
    const geometry::Bounds& bounds = drawn.state->placed.bounds_mm();
    job.bounds_mm.lowest = glm::min(job.bounds_mm.lowest, bounds.lowest);
    job.bounds_mm.highest = glm::max(job.bounds_mm.highest, bounds.highest);
  }
  list_lights(scene, job.bounds_mm, job.lights);
  job.ambient = ambient_of(scene);
}

void ScenePainter::update_shadows(Job& job) {
  const bool refined = job.request.settings.technique == Technique::kIntegral;
  places_.clear();
  casters_.clear();
  for (const DrawnMesh& drawn : job.meshes) {
    const MeshState& state = *drawn.state;
    places_.push_back(refined ? state.refined.generation() : state.placed.generation());
    const geometry::MeshTopology& topology = refined ? *state.refined.topology() : *drawn.mesh->topology;
    const geometry::PlacedShape& shape = refined ? state.refined.shape() : state.placed.shape();
    casters_.push_back({topology.triangles, shape.positions_mm, topology.encloses_volume, shape.flipped});
  }
  if (!shadow_reads_.renew(places_)) return;
  shadows_.set_casters(casters_, job.bounds_mm);
  ++shadows_generation_;
}

absl::Status ScenePainter::refine(Job& job) {
  for (const DrawnMesh& drawn : job.meshes) {
    if (absl::Status status = check_cancelled(job); !status.ok()) return status;
    absl::Status status = drawn.state->refined.update(*drawn.mesh, drawn.state->placed, drawn.material,
                                                      job.request.settings.quality, job.clock);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

void ScenePainter::bound_memory(const Job& job) {
  const auto bytes_of = [](const MeshState& state) {
    return state.light.bytes() + state.vertex_light.bytes() + state.native_paper.cube.bytes() +
           (state.atlas.has_value() ? state.atlas->bytes() : 0);
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

/// `refined`: what the last GpuMesh::update() was of; null: the mesh itself.
void ScenePainter::update_surface(const DrawnMesh& drawn, const RefinedMesh* refined, Job& job) {
  if (!job.variant.textured) return;
  textures_.update(*job.request.scene, drawn.textures, job.clock);
  drawn.state->gpu.update_attributes(
      drawn.mesh->attributes,
      [&](const geometry::SurfaceAttributes& attributes) {
        return refined == nullptr ? attributes : refined->carry(attributes);
      },
      job.clock);
}

const AtlasKey& ScenePainter::atlas_key(const DrawnMesh& drawn, const Job& job) {
  atlas_key_ = {drawn.state->placed.generation(), std::move(atlas_key_.lights), drawn.material.refractive_index,
                job.request.settings.paper.face_size_px, job.variant.lit ? drawn.state->vertex_light.generation() : 0};
  atlas_key_.lights = job.lights;
  return atlas_key_;
}

void ScenePainter::update_atlas(const DrawnMesh& drawn, Job& job) {
  const uint32_t face_size_px = job.request.settings.paper.face_size_px;
  const AtlasKey& key = atlas_key(drawn, job);
  if (drawn.state->atlas.has_value() && drawn.state->atlas->key() == key) {
    job.clock.sleep("atlas");
    return;
  }
  job.clock.run("atlas", [&] {
    const BoxUniforms box = fit_box(drawn.state->placed.bounds_mm(), face_size_px);
    std::optional<CubeAtlas>& atlas = drawn.state->atlas;
    if (atlas.has_value() && atlas->key().face_size_px == key.face_size_px) {
      atlas->renew(key, box);
    } else {
      atlas.emplace(key, box);
    }
    shading_.bind(box);
    shading_.bind(material_uniforms(drawn.material));
    // The outermost surface of a closed body faces outwards.
    drawn.state->atlas->render(shading_.atlas(job.variant), [&](bool mirrored) {
      drawn.state->gpu.draw(drawn.mesh->topology->encloses_volume, mirrored);
    });
    glFinish();
  });
}

void ScenePainter::update_integral(const DrawnMesh& drawn, bool shadowed, Job& job) {
  MeshState& state = *drawn.state;
  RefinedMesh& refined = state.refined;
  state.light.update({refined, job.lights, job.ambient, drawn.material, job.request.settings.quality,
                      shadowed ? &shadows_ : nullptr, job.ambient.occluded ? &shadows_ : nullptr,
                      shadowed || job.ambient.occluded ? shadows_generation_ : 0, job.request.settings.slab_correction},
                     job.clock);
  if (job.native) return;
  state.gpu.update(refined.topology(), refined.shape(), refined.generation(), job.clock);
  update_surface(drawn, &refined, job);
  state.gpu.update_radiosity(state.light.radiosity(), state.light.generation(), job.clock);
  if (!job.needs.irradiance) return;
  state.gpu.update_irradiance(state.light.irradiance().of_vertex, &state.light, state.light.irradiance_generation(),
                              job.clock);
}

absl::Status ScenePainter::update_lit(const DrawnMesh& drawn, bool shadowed, Job& job) {
  MeshState& state = *drawn.state;
  state.placed.complete_normals(job.clock);
  absl::Status status =
      state.lit.update(*drawn.mesh, state.placed, drawn.material, diffusion::Quality::kNormal, job.clock);
  if (!status.ok()) return status;
  // Lambert's E is without Fresnel.
  const float refractive_index =
      job.request.settings.technique == Technique::kLambert ? 1.0f : drawn.material.refractive_index;
  state.vertex_light.update(
      {*state.lit.topology(), state.lit.shape(), state.lit.generation(), job.lights, job.ambient, refractive_index,
       shadowed ? &shadows_ : nullptr, job.ambient.occluded ? &shadows_ : nullptr,
       shadowed || job.ambient.occluded ? shadows_generation_ : 0},
      job.clock);
  if (job.native) return absl::OkStatus();
  state.gpu.update(state.lit.topology(), state.lit.shape(), state.lit.generation(), job.clock);
  update_surface(drawn, &state.lit, job);
  state.gpu.update_irradiance(state.vertex_light.irradiance(), &state.vertex_light, state.vertex_light.generation(),
                              job.clock);
  return absl::OkStatus();
}

absl::Status ScenePainter::update_mesh(const DrawnMesh& drawn, bool shadowed, Job& job) {
  MeshState& state = *drawn.state;
  if (job.request.settings.technique == Technique::kIntegral) {
    update_integral(drawn, shadowed, job);
    return absl::OkStatus();
  }
  if (job.variant.lit) {
    if (absl::Status status = update_lit(drawn, shadowed, job); !status.ok()) return status;
  } else {
    state.placed.complete_normals(job.clock);
    if (!job.native) {
      state.gpu.update(drawn.mesh->topology, state.placed.shape(), state.placed.generation(), job.clock);
      update_surface(drawn, nullptr, job);
    }
  }
  if (job.request.settings.technique != Technique::kPaper) return absl::OkStatus();
  job.native ? update_native_atlas(drawn, job) : update_atlas(drawn, job);
  return absl::OkStatus();
}

absl::Status ScenePainter::update(Job& job) {
  const RenderSettings& settings = job.request.settings;
  const bool shadowed = casts_shadows(settings);
  if (settings.technique == Technique::kIntegral && beyond(job.bounds_mm, kLargestIntegral_mm)) {
    return absl::FailedPreconditionError(fmt::format("{}: the integral takes bodies within ±{:g} mm of the origin",
                                                     job.request.scene->name, kLargestIntegral_mm));
  }
  if (absl::Status status = shading_.prepare(settings.technique, job.variant); !status.ok()) return status;
  if (settings.technique == Technique::kIntegral) {
    if (absl::Status refined = refine(job); !refined.ok()) return refined;
  }
  if (shadowed || job.ambient.occluded) update_shadows(job);
  if (!job.native) shading_.bind(std::span<const LightStorage>(job.lights));
  for (const DrawnMesh& drawn : job.meshes) {
    if (absl::Status status = check_cancelled(job); !status.ok()) return status;
    if (absl::Status status = update_mesh(drawn, shadowed, job); !status.ok()) return status;
  }
  bound_memory(job);
  return absl::OkStatus();
}

}  // namespace diaphane::render
