// What lies on top of the bodies of a tile.
#include <algorithm>

#include "render/scene_painter.h"

namespace diaphane::render {

bool ScenePainter::has_coats(const FrameRequest& request) {
  if (request.settings.technique == Technique::kLambert) return false;
  const scene::SceneSnapshot& scene = *request.scene;
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const auto& mesh) {
    const scene::Material* material = scene::material_of(scene, *mesh);
    return material != nullptr && material->coat.has_value();
  });
}

void ScenePainter::add_coats(Job& job, std::span<glm::vec4> radiance) {
  const scene::SceneSnapshot& scene = *job.request.scene;
  job.clock.run("coat", [&] {
    const bool shadowed = casts_shadows(job.request.settings);
    if (shadowed) shadows_.prepare_rays();
    const size_t lamps = scene.environment == nullptr ? 0 : scene.environment->light->lamps.size();
    const CoatLight light{std::span(job.lights).first(job.lights.size() - lamps), scene.environment.get(),
                          shadowed ? &shadows_ : nullptr};
    for (size_t i = 0; i < job.meshes.size(); ++i) {
      const DrawnMesh& drawn = job.meshes[i];
      if (!drawn.coat.has_value()) continue;
      coats_.add(*drawn.coat, drawn.material.refractive_index, static_cast<float>(i + 1), light,
                 glm::vec3(job.view.eye_mm), job.channels, radiance);
    }
  });
}

}  // namespace diaphane::render
