// Lights of the SceneService.
#include "service/scene_service.h"
#include "service/unary.h"

namespace diaphane::service {

SceneService::Unary* SceneService::CreateLight(Context* context, const v1::CreateLightRequest* request,
                                               v1::LightResponse* response) {
  const auto apply = [&](v1::LightResponse& message) -> absl::Status {
    const auto light = from_proto(request->light());
    if (!light.ok()) return light.status();
    return fill(store_.create_light({"parent", request->parent()}, *light), message);
  };
  return answer(context, apply_once(replies_, "CreateLight", *request, *response, apply));
}

SceneService::Unary* SceneService::GetLight(Context* context, const v1::GetLightRequest* request, v1::Light* response) {
  return answer(context, fill(store_.light({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::ListLights(Context* context, const v1::ListLightsRequest* request,
                                              v1::ListLightsResponse* response) {
  const auto scene = store_.scene({"parent", request->parent()});
  if (!scene.ok()) return answer(context, scene.status());
  for (const scene::Light& light : (*scene)->lights) to_proto(light, *response->add_lights());
  return answer(context, absl::OkStatus());
}

SceneService::Unary* SceneService::UpdateLight(Context* context, const v1::UpdateLightRequest* request,
                                               v1::LightResponse* response) {
  const auto apply = [&](v1::LightResponse& message) -> absl::Status {
    const auto patch = from_proto(request->light(), request->update_mask());
    if (!patch.ok()) return patch.status();
    return fill(store_.update_light({"light.name", request->light().name()}, *patch), message);
  };
  return answer(context, apply_once(replies_, "UpdateLight", *request, *response, apply));
}

SceneService::Unary* SceneService::DeleteLight(Context* context, const v1::DeleteLightRequest* request,
                                               v1::DeleteResponse* response) {
  const auto apply = [&](v1::DeleteResponse& message) {
    return fill(store_.delete_light({"name", request->name()}), message);
  };
  return answer(context, apply_once(replies_, "DeleteLight", *request, *response, apply));
}

}  // namespace diaphane::service
