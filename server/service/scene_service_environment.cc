// The environment of a scene, of the SceneService.
#include "service/environment_upload.h"
#include "service/scene_service.h"
#include "service/unary.h"
#include "service/upload_reactor.h"

namespace diaphane::service {

SceneService::Reads<v1::UploadEnvironmentRequest>* SceneService::UploadEnvironment(Context* context,
                                                                                   v1::EnvironmentResponse* response) {
  return new UploadReactor<EnvironmentUpload>(std::make_unique<EnvironmentUpload>(store_),
                                              {limits_, workers_, replies_}, context, response);
}

SceneService::Unary* SceneService::GetEnvironment(Context* context, const v1::GetEnvironmentRequest* request,
                                                  v1::Environment* response) {
  return answer(context, fill(store_.environment({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::UpdateEnvironment(Context* context, const v1::UpdateEnvironmentRequest* request,
                                                     v1::EnvironmentResponse* response) {
  const auto apply = [&](v1::EnvironmentResponse& message) -> absl::Status {
    const auto patch = from_proto(request->environment(), request->update_mask());
    if (!patch.ok()) return patch.status();
    return fill(store_.update_environment({"environment.name", request->environment().name()}, *patch), message);
  };
  return answer(context, apply_once(replies_, "UpdateEnvironment", *request, *response, apply));
}

SceneService::Unary* SceneService::DeleteEnvironment(Context* context, const v1::DeleteEnvironmentRequest* request,
                                                     v1::DeleteResponse* response) {
  const auto apply = [&](v1::DeleteResponse& message) {
    return fill(store_.delete_environment({"name", request->name()}), message);
  };
  return answer(context, apply_once(replies_, "DeleteEnvironment", *request, *response, apply));
}

}  // namespace diaphane::service
