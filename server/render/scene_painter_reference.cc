// Technique `reference`: brute force at every pixel of the G-buffer.
#include <algorithm>
#include <utility>

#include "render/brute_force.h"
#include "render/pixels.h"
#include "render/scene_painter.h"

namespace diaphane::render {
namespace {

/// The pixels of a tile that show one mesh, and what they show.
struct ShownPoints {
  std::vector<size_t> pixels;
  std::vector<glm::vec3> positions_mm;
  std::vector<glm::vec3> normals;
};

ShownPoints points_of(const ChannelTile& tile, size_t mesh_index) {
  ShownPoints points;
  for (size_t p = 0; p < tile.position_mm.size(); ++p) {
    if (tile.position_mm[p].w != static_cast<float>(mesh_index + 1)) continue;
    points.pixels.push_back(p);
    points.positions_mm.emplace_back(tile.position_mm[p]);
    points.normals.emplace_back(tile.normal[p]);
  }
  return points;
}

}  // namespace

absl::Status ScenePainter::draw_reference_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  draw_gbuffer(job, tile);
  const size_t count = size_t{tile.width_px} * tile.height_px;
  ChannelTile& channels = job.channels;
  if (job.needs.light) {
    channels.irradiance.assign(count, glm::vec4(0));
    channels.radiosity.assign(count, glm::vec4(0));
  }
  read_surface(job, tile);
  const bool shadowed = casts_shadows(job.request.settings);
  if (shadowed || job.ambient.occluded) shadows_.prepare_rays();
  const auto shown = static_cast<size_t>(std::count_if(channels.position_mm.begin(), channels.position_mm.end(),
                                                       [](const glm::vec4& p) { return p.w != 0; }));
  const double all_pixels = static_cast<double>(job.request.width_px) * job.request.height_px * job.passes;
  const glm::vec3 eye_mm(job.view.eye_mm);
  std::vector<glm::vec4> radiance(count, glm::vec4(0));
  size_t shown_before = 0;
  for (size_t i = 0; i < job.meshes.size(); ++i) {
    const DrawnMesh& drawn = job.meshes[i];
    const ShownPoints points = points_of(channels, i);
    const BruteForceBody body{*drawn.mesh->topology,
                              drawn.state->placed.shape(),
                              drawn.material,
                              job.lights,
                              job.ambient,
                              shadowed ? &shadows_ : nullptr,
                              job.ambient.occluded ? &shadows_ : nullptr,
                              job.request.settings.slab_correction};
    std::function<void(double)> progress;
    if (job.request.progress) {
      progress = [&](double share) {
        const double points_done =
            static_cast<double>(shown_before) + share * static_cast<double>(points.pixels.size());
        const double tile_done = static_cast<double>(count) * points_done / static_cast<double>(shown);
        job.request.progress((static_cast<double>(job.pixels_done) + tile_done) / all_pixels);
      };
    }
    const auto leaving = job.clock.run("brute_force", [&] {
      return brute_force_radiosity(body, points.positions_mm, points.normals, job.cancelled, std::move(progress));
    });
    if (!leaving.ok()) return leaving.status();
    std::vector<glm::vec3> entering;
    if (job.needs.irradiance) entering = brute_force_irradiance(body, points.positions_mm, points.normals);
    for (size_t k = 0; k < points.pixels.size(); ++k) {
      const size_t pixel = points.pixels[k];
      const glm::vec3 b = channels.albedo.empty() ? (*leaving)[k] : (*leaving)[k] * glm::vec3(channels.albedo[pixel]);
      if (job.needs.light) channels.radiosity[pixel] = glm::vec4(b, 1);
      if (job.needs.irradiance) channels.irradiance[pixel] = glm::vec4(entering[k], 1);
      radiance[pixel] = glm::vec4(
          leaving_radiance(b, drawn.material.refractive_index, points.positions_mm[k], points.normals[k], eye_mm), 1);
    }
    shown_before += points.pixels.size();
  }
  store_pixels(radiance, job.view.radiance_scale, job.format, pixels);
  return absl::OkStatus();
}

}  // namespace diaphane::render
