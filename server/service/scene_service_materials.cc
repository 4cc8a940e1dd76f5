// Materials of the SceneService.
#include "service/scene_service.h"
#include "service/unary.h"

namespace diaphane::service {

SceneService::Unary* SceneService::CreateMaterial(Context* context, const v1::CreateMaterialRequest* request,
                                                  v1::MaterialResponse* response) {
  const auto apply = [&](v1::MaterialResponse& message) -> absl::Status {
    const auto material = from_proto(request->material());
    if (!material.ok()) return material.status();
    return fill(store_.create_material({"parent", request->parent()}, *material), message);
  };
  return answer(context, apply_once(replies_, "CreateMaterial", *request, *response, apply));
}

SceneService::Unary* SceneService::GetMaterial(Context* context, const v1::GetMaterialRequest* request,
                                               v1::Material* response) {
  return answer(context, fill(store_.material({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::ListMaterials(Context* context, const v1::ListMaterialsRequest* request,
                                                 v1::ListMaterialsResponse* response) {
  const auto scene = store_.scene({"parent", request->parent()});
  if (!scene.ok()) return answer(context, scene.status());
  for (const scene::Material& material : (*scene)->materials) to_proto(material, *response->add_materials());
  return answer(context, absl::OkStatus());
}

SceneService::Unary* SceneService::UpdateMaterial(Context* context, const v1::UpdateMaterialRequest* request,
                                                  v1::MaterialResponse* response) {
  const auto apply = [&](v1::MaterialResponse& message) -> absl::Status {
    const auto patch = from_proto(*request);
    if (!patch.ok()) return patch.status();
    return fill(store_.update_material({"material.name", request->material().name()}, *patch), message);
  };
  return answer(context, apply_once(replies_, "UpdateMaterial", *request, *response, apply));
}

SceneService::Unary* SceneService::DeleteMaterial(Context* context, const v1::DeleteMaterialRequest* request,
                                                  v1::DeleteResponse* response) {
  const auto apply = [&](v1::DeleteResponse& message) {
    return fill(store_.delete_material({"name", request->name()}), message);
  };
  return answer(context, apply_once(replies_, "DeleteMaterial", *request, *response, apply));
}

SceneService::Unary* SceneService::ListMaterialPresets(Context* context, const v1::ListMaterialPresetsRequest*,
                                                       v1::ListMaterialPresetsResponse* response) {
  for (const optics::MaterialPreset& preset : optics::material_presets()) to_proto(preset, *response->add_presets());
  return answer(context, absl::OkStatus());
}

}  // namespace diaphane::service
