#include "tests/support/error_parts.h"

#include <stdexcept>

#include "render/refined_mesh.h"
#include "tests/support/rays.h"
#include "tests/support/views.h"

namespace diaphane::testing {
namespace {

/// So narrow that a third less changes nothing.
constexpr diffusion::Openings kAllOpen{0.06f, 0.1f};

}  // namespace

Mesh as_served(const Mesh& mesh, const optics::Coefficients& material, diffusion::Quality quality) {
  const auto scene = make_scene(mesh, material, {});
  render::StageClock clock;
  render::PlacedMesh placed;
  placed.update(*scene->meshes.front(), 1, clock);
  render::RefinedMesh refined;
  if (const absl::Status status = refined.update(*scene->meshes.front(), placed, material, quality, clock);
      !status.ok()) {
    throw std::runtime_error(std::string(status.message()));
  }
  return {refined.shape().positions_mm, refined.shape().normals, refined.topology()->triangles};
}

std::vector<glm::vec3> integral_radiosity(diffusion::DipoleIntegral& integral, const Mesh& mesh, const Cell& cell,
                                          const diffusion::Openings& openings) {
  const SurfaceIrradiance light = light_surface(integral.topology(), mesh.positions_mm, mesh.normals, cell.irradiance);
  integral.update_positions(mesh.positions_mm);
  integral.refit_geometry();
  integral.set_irradiance(light.at_triangles, light.at_vertices);
  integral.refit_flux();
  integral.set_material(cell.material);
  std::vector<glm::vec3> radiosity(mesh.positions_mm.size());
  integral.gather(openings, radiosity);
  return radiosity;
}

std::vector<ErrorParts> error_parts(const Cell& cell, diffusion::Quality quality, std::span<const glm::vec3> points_mm,
                                    std::span<const glm::vec3> normals) {
  const Mesh fine = as_served(cell.mesh, cell.material, quality);
  diffusion::DipoleIntegral integral(
      diffusion::build_surface_topology(*geometry::build_topology(fine.positions_mm, fine.triangles)));
  const auto grouped = integral_radiosity(integral, fine, cell, diffusion::openings_of(quality, cell.material));
  const auto opened = integral_radiosity(integral, fine, cell, kAllOpen);
  const MeshRays rays(fine);
  std::vector<SurfacePoint> found;
  std::vector<glm::vec3> receivers(points_mm.begin(), points_mm.end());
  std::vector<glm::vec3> receiver_normals(normals.begin(), normals.end());
  for (size_t i = 0; i < points_mm.size(); ++i) {
    const auto point = rays.locate(points_mm[i], normals[i]);
    if (!point) throw std::runtime_error("a point of the surface was not found on the finer surface");
    found.push_back(*point);
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = fine.triangles[point->triangle][k];
      receivers.push_back(fine.positions_mm[vertex]);
      receiver_normals.push_back(fine.normals[vertex]);
    }
  }
  const auto truth = true_radiosity(cell.mesh, cell.material, cell.irradiance, receivers, receiver_normals);
  std::vector<ErrorParts> parts;
  for (size_t i = 0; i < found.size(); ++i) {
    glm::vec3 exact(0);
    for (int k = 0; k < 3; ++k) exact += found[i].weights[k] * truth[points_mm.size() + 3 * i + static_cast<size_t>(k)];
    const glm::vec3 near = interpolate(fine, opened, found[i]), far = interpolate(fine, grouped, found[i]);
    parts.push_back({exact - truth[i], near - exact, far - near});
  }
  return parts;
}

}  // namespace diaphane::testing
