#include "render/surface_light.h"

namespace diaphane::render {

void SurfaceLight::update(const Inputs& inputs, StageClock& clock) {
  const std::shared_ptr<const diffusion::SurfaceTopology>& surface = inputs.mesh.surface();
  if (integral_ == nullptr || &integral_->topology() != surface.get()) {
    integral_ = std::make_unique<diffusion::DipoleIntegral>(surface);
    radiosity_.assign(surface->mesh->vertex_count, glm::vec3(0));
    refit_reads_.forget();
    light_reads_.forget();
    flux_reads_.forget();
    material_reads_.forget();
    gather_reads_.forget();
  }
  const uint64_t placed = inputs.mesh.generation();
  const geometry::PlacedShape& shape = inputs.mesh.shape();
  const float refractive_index = inputs.material.refractive_index;
  const optics::Coefficients& material = inputs.material;
  const auto stage = [&](std::string_view name, bool stale, auto&& work) {
    if (stale) {
      clock.run(name, work);
    } else {
      clock.sleep(name);
    }
  };

  const bool moved = refit_reads_.renew(placed);
  stage("normals", moved, [&] {
    inputs.mesh.fill_normals(
        [&](std::span<glm::vec3> normals) { integral_->update_positions(shape.positions_mm, normals); });
  });
  stage("refit", moved, [&] { integral_->refit_geometry(); });
  std::vector<LightStorage> lights(inputs.lights.begin(), inputs.lights.end());
  const bool relit =
      light_reads_.renew({placed, std::move(lights), inputs.ambient, refractive_index, inputs.shadows_generation});
  stage("irradiance", relit, [&] {
    irradiance_.run(integral_->topology(), shape, inputs.lights, inputs.ambient, refractive_index, inputs.shadows);
    ++irradiance_generation_;
  });
  stage("flux", flux_reads_.renew({placed, irradiance_generation_}), [&] {
    integral_->set_irradiance(irradiance_.result().of_triangle, irradiance_.result().of_vertex);
    integral_->refit_flux();
  });
  if (material_reads_.renew(material)) integral_->set_material(inputs.material);
  stage("gather", gather_reads_.renew({placed, irradiance_generation_, material, inputs.quality}), [&] {
    integral_->gather(inputs.quality, radiosity_);
    ++generation_;
  });
}

}  // namespace diaphane::render
