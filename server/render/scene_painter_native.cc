// Tiles whose triangles are found on the CPU: where OpenGL is software, its small triangles are dear.
#include <algorithm>
#include <cstring>

#include "render/native_taps.h"
#include "render/scene_painter.h"

namespace diaphane::render {
RasterMesh ScenePainter::raster_mesh(const Job& job, size_t mesh_index) const {
  const DrawnMesh& drawn = job.meshes[mesh_index];
  const MeshState& state = *drawn.state;
  RasterMesh mesh;
  const auto fill = [&](const geometry::MeshTopology& topology, const geometry::PlacedShape& shape) {
    mesh.triangles = topology.triangles;
    mesh.positions_mm = shape.positions_mm;
    mesh.normals = shape.normals;
    mesh.facing_only = topology.encloses_volume;
    mesh.flipped = shape.flipped;
  };
  if (job.request.settings.technique == Technique::kIntegral) {
    fill(*state.refined.topology(), state.refined.shape());
    mesh.values = state.light.radiosity();
  } else if (job.variant.lit) {
    fill(*state.lit.topology(), state.lit.shape());
    mesh.values = state.vertex_light.irradiance();
  } else {
    fill(*drawn.mesh->topology, state.placed.shape());
  }
  return mesh;
}

void ScenePainter::update_native_atlas(const DrawnMesh& drawn, Job& job) {
  NativePaper& paper = drawn.state->native_paper;
  const AtlasKey& key = atlas_key(drawn, job);
  const auto mesh_index = static_cast<size_t>(&drawn - job.meshes.data());
  if (paper.cube.size_px() > 0 && paper.cube.key() == key) {
    job.clock.sleep("atlas");
  } else {
    job.clock.run("atlas", [&] {
      const BoxUniforms box = fit_box(drawn.state->placed.bounds_mm(), key.face_size_px);
      // The outermost surface of a closed body faces outwards.
      paper.cube.draw(key, box, raster_mesh(job, mesh_index));
    });
  }
  paper.prepare_kernels(drawn.material);
}

/// B of a mesh's pixels.
void ScenePainter::shade_batch(const Job& job, size_t mesh_index, const PointBatch& points,
                               EnteringLight& radiosity) const {
  const DrawnMesh& drawn = job.meshes[mesh_index];
  if (job.request.settings.technique == Technique::kIntegral) {
    for (int c = 0; c < 3; ++c) std::copy_n(points.value[c], points.count, radiosity.channel[c]);
    return;
  }
  const NativePaper& paper = drawn.state->native_paper;
  const MaterialUniforms material = material_uniforms(drawn.material);
  const std::span<const LightStorage> lights =
      job.variant.lit ? drawn.state->vertex_light.lights() : std::span<const LightStorage>(job.lights);
  scatter({paper.cube, material, paper.kernels, lights, job.variant.lit, job.request.settings.paper}, points,
          radiosity);
}

void ScenePainter::store_batch(Job& job, size_t mesh_index, const PointBatch& points, const EnteringLight& radiosity,
                               uint8_t* pixels) const {
  const DrawnMesh& drawn = job.meshes[mesh_index];
  alignas(64) float gain[PointBatch::kCapacity];
  leave(drawn.material.refractive_index, glm::vec3(job.view.eye_mm), points, gain);
  for (size_t i = 0; i < points.count; ++i) {
    const float scaled = job.view.radiance_scale * gain[i];
    const glm::vec3 radiance =
        scaled * glm::vec3(radiosity.channel[0][i], radiosity.channel[1][i], radiosity.channel[2][i]);
    if (job.format == PixelFormat::kSrgb8) {
      const uint8_t pixel[] = {srgb_.byte_of(radiance.r), srgb_.byte_of(radiance.g), srgb_.byte_of(radiance.b), 255};
      std::memcpy(pixels + sizeof pixel * points.cell[i], pixel, sizeof pixel);
    } else {
      const glm::vec4 pixel(radiance, 1);
      std::memcpy(pixels + sizeof pixel * points.cell[i], &pixel, sizeof pixel);
    }
  }
  ChannelTile& channels = job.channels;
  const SurfacePoints& surface = points.surface;
  if (job.needs.surface || job.coated) {
    for (size_t i = 0; i < points.count; ++i) {
      channels.position_mm[points.cell[i]] = {surface.x[i], surface.y[i], surface.z[i], mesh_index + 1};
      channels.normal[points.cell[i]] = {surface.normal_x[i], surface.normal_y[i], surface.normal_z[i],
                                         points.facet_sine[i]};
    }
  }
  if (!job.needs.light) return;
  for (size_t i = 0; i < points.count; ++i) {
    channels.radiosity[points.cell[i]] = {radiosity.channel[0][i], radiosity.channel[1][i], radiosity.channel[2][i], 1};
  }
}

/// E of a tile's pixels, after the pass that shades.
void ScenePainter::store_irradiance(Job& job) {
  const bool integral = job.request.settings.technique == Technique::kIntegral;
  const bool at_vertices = integral || job.variant.lit;
  if (integral) {
    for (size_t i = 0; i < job.meshes.size(); ++i) {
      raster_meshes_[i].values = job.meshes[i].state->light.irradiance().of_vertex;
    }
  }
  view_.for_each_batch(raster_meshes_, [&](size_t mesh_index, const PointBatch& points) {
    EnteringLight sum{};
    for (const LightStorage& light : at_vertices ? std::span<const LightStorage>() : job.lights) {
      add_entering_light(light, job.meshes[mesh_index].material.refractive_index, points.surface, points.count, nullptr,
                         sum);
    }
    for (size_t i = 0; i < points.count; ++i) {
      // The vertices know what falls on the outside alone.
      const float share = !at_vertices ? 1.0f : job.variant.lit ? points.outside[i] : 1.0f;
      const auto& entering = at_vertices ? points.value : sum.channel;
      job.channels.irradiance[points.cell[i]] =
          glm::vec4(share * glm::vec3(entering[0][i], entering[1][i], entering[2][i]), 1);
    }
  });
}

void ScenePainter::draw_native_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  const size_t count = size_t{tile.width_px} * tile.height_px;
  const bool linear = job.format == PixelFormat::kLinearFloat;
  raster_meshes_.clear();
  for (size_t i = 0; i < job.meshes.size(); ++i) {
    raster_meshes_.push_back(raster_mesh(job, i));
    raster_meshes_.back().facing_only = shows_outside_alone(job, i);
  }
  job.clock.run("raster", [&] {
    view_.draw({job.view.clip_from_world, glm::vec3(job.view.eye_mm), job.request.width_px, job.request.height_px},
               tile, raster_meshes_);
  });
  job.clock.run("shade", [&] {
    std::memset(pixels, 0, count * (linear ? sizeof(glm::vec4) : 4));
    ChannelTile& channels = job.channels;
    if (job.needs.surface || job.coated) {
      channels.position_mm.assign(count, glm::vec4(0));
      channels.normal.assign(count, glm::vec4(0));
      channels.albedo.clear();
      channels.coat.clear();
    }
    if (job.needs.light) {
      channels.irradiance.assign(count, glm::vec4(0));
      channels.radiosity.assign(count, glm::vec4(0));
    }
    view_.for_each_batch(raster_meshes_, [&](size_t mesh_index, const PointBatch& points) {
      EnteringLight radiosity;
      shade_batch(job, mesh_index, points, radiosity);
      store_batch(job, mesh_index, points, radiosity, pixels);
    });
  });
  if (job.needs.irradiance) job.clock.run("shade", [&] { store_irradiance(job); });
}

}  // namespace diaphane::render
