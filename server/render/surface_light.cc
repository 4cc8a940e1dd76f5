#include "render/surface_light.h"

namespace diaphane::render {

void SurfaceLight::update(const Inputs& inputs, StageClock& clock) {
  const std::shared_ptr<const diffusion::SurfaceTopology>& surface = inputs.mesh.surface();
  if (integral_ == nullptr || &integral_->topology() != surface.get()) {
    integral_ = std::make_unique<diffusion::DipoleIntegral>(surface);
    radiosity_.assign(surface->mesh->vertex_count, glm::vec3(0));
    refit_reads_.forget();
    light_reads_.forget();
    occlusion_reads_.forget();
    flux_reads_.forget();
    material_reads_.forget();
    gather_reads_.forget();
    opposite_reads_.forget();
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
  std::get<1>(light_key_).assign(inputs.lights.begin(), inputs.lights.end());
  std::get<0>(light_key_) = placed;
  std::get<2>(light_key_) = inputs.ambient;
  std::get<3>(light_key_) = refractive_index;
  std::get<4>(light_key_) = inputs.shadows_generation;
  const bool relit = light_reads_.renew(light_key_);
  const bool occluded = inputs.occluders != nullptr && inputs.ambient.light != nullptr;
  const std::vector<glm::uvec3>& triangles = integral_->topology().triangles;
  if (occluded) {
    stage("occlusion", occlusion_reads_.renew({placed, inputs.shadows_generation}),
          [&] { occlusion_.look(triangles, shape, *inputs.occluders); });
  }
  stage("irradiance", relit, [&] {
    if (occluded) occlusion_.weigh(triangles, shape, inputs.ambient, refractive_index);
    irradiance_.run(integral_->topology(), shape, inputs.lights, inputs.ambient, refractive_index, inputs.shadows,
                    occluded ? &occlusion_ : nullptr);
    ++irradiance_generation_;
  });
  stage("flux", flux_reads_.renew({placed, irradiance_generation_}), [&] {
    integral_->set_irradiance(irradiance_.result().of_triangle, irradiance_.result().of_vertex);
    integral_->refit_flux();
  });
  if (material_reads_.renew(material)) integral_->set_material(inputs.material);
  stage("gather", gather_reads_.renew({placed, irradiance_generation_, material, inputs.quality}), [&] {
    integral_->gather(inputs.quality, radiosity_);
    ++gather_generation_;
    ++generation_;
  });
  correct_slabs_of(inputs, clock);
}

void SurfaceLight::correct_slabs_of(const Inputs& inputs, StageClock& clock) {
  const bool stale = slab_reads_.renew({gather_generation_, inputs.material, inputs.slab_correction});
  if (!inputs.slab_correction) {
    if (corrects_) ++generation_;
    corrects_ = false;
    return;
  }
  corrects_ = true;
  if (!stale) {
    clock.sleep("slab");
    return;
  }
  clock.run("slab", [&] {
    const geometry::PlacedShape& shape = inputs.mesh.shape();
    const std::vector<glm::uvec3>& triangles = inputs.mesh.topology()->triangles;
    if (opposite_reads_.renew(inputs.mesh.generation())) {
      if (thickness_ == nullptr) thickness_ = std::make_unique<ThicknessField>();
      thickness_->update(triangles, shape);
      opposites_ = thickness_->find(shape.positions_mm, shape.normals);
    }
    if (gain_reads_.renew(inputs.material)) gains_.emplace(inputs.material);
    corrected_.resize(radiosity_.size());
    correct_slabs(*gains_, opposites_, triangles, radiosity_, corrected_);
    ++generation_;
  });
}

size_t SurfaceLight::bytes() const {
  const size_t slabs = thickness_ == nullptr ? 0 : thickness_->bytes() + opposites_.size() * sizeof(OppositePoint);
  return (integral_ == nullptr ? 0 : integral_->bytes()) + slabs + occlusion_.bytes();
}

}  // namespace diaphane::render
