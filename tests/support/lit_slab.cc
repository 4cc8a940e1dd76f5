#include "tests/support/lit_slab.h"

#include <algorithm>

#include "diffusion/dipole_integral.h"
#include "diffusion/kernel_table.h"
#include "render/slab_correction.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"

namespace diaphane::testing {

LitSlab light_slab(const optics::Coefficients& material, float thickness_mm) {
  const glm::vec3 smooth = diffusion::smooth_distance_mm(optics::make_profile(material));
  const glm::vec3 l = 1.0f / (material.absorption_mm + material.reduced_scattering_mm);
  Mesh slab = make_graded_disc(0.2f * std::min({smooth.x, smooth.y, smooth.z}), 1500 * std::max({l.x, l.y, l.z}), 160);
  const auto count = static_cast<uint32_t>(slab.positions_mm.size());
  const size_t triangles = slab.triangles.size();
  for (uint32_t v = 0; v < count; ++v) {
    slab.positions_mm.push_back(slab.positions_mm[v] - thickness_mm * slab.normals[v]);
    slab.normals.push_back(-slab.normals[v]);
  }
  for (size_t t = 0; t < triangles; ++t) {
    const glm::uvec3& front = slab.triangles[t];
    slab.triangles.emplace_back(front.x + count, front.z + count, front.y + count);
  }
  const glm::vec3 lit = slab.normals.front();
  diffusion::DipoleIntegral integral(
      diffusion::build_surface_topology(*geometry::build_topology(slab.positions_mm, slab.triangles)));
  const SurfaceIrradiance light = light_surface(
      integral.topology(), slab.positions_mm, slab.normals,
      [&](const auto&, const glm::vec3& normal) { return glm::vec3(glm::dot(normal, lit) > 0 ? 1.0f : 0.0f); });
  integral.update_positions(slab.positions_mm);
  integral.refit_geometry();
  integral.set_irradiance(light.at_triangles, light.at_vertices);
  integral.refit_flux();
  integral.set_material(material);
  std::vector<glm::vec3> radiosity(slab.positions_mm.size()), corrected(slab.positions_mm.size());
  integral.gather(diffusion::Quality::kFine, radiosity);

  render::ThicknessField thickness;
  const geometry::PlacedShape shape{.positions_mm = slab.positions_mm, .normals = slab.normals};
  thickness.update(slab.triangles, shape);
  const auto opposites = thickness.find(slab.positions_mm, slab.normals);
  render::correct_slabs(render::SlabGains(material), opposites, slab.triangles, radiosity, corrected);
  return {{radiosity[0], radiosity[count]}, {corrected[0], corrected[count]}};
}

}  // namespace diaphane::testing
