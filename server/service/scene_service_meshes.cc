// Meshes of the SceneService; what they are made of comes through upload.h.
#include "service/mesh_upload.h"
#include "service/positions_upload.h"
#include "service/scene_service.h"
#include "service/unary.h"
#include "service/upload_reactor.h"

namespace diaphane::service {

SceneService::Reads<v1::UploadMeshRequest>* SceneService::UploadMesh(Context* context, v1::MeshResponse* response) {
  return new UploadReactor<MeshUpload>(std::make_unique<MeshUpload>(store_), {limits_, workers_, replies_}, context,
                                       response);
}

SceneService::Reads<v1::UpdatePositionsRequest>* SceneService::UpdatePositions(Context* context,
                                                                               v1::MeshResponse* response) {
  return new UploadReactor<PositionsUpload>(std::make_unique<PositionsUpload>(store_), {limits_, workers_, replies_},
                                            context, response);
}

SceneService::Unary* SceneService::GetMesh(Context* context, const v1::GetMeshRequest* request, v1::Mesh* response) {
  return answer(context, fill(store_.mesh({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::ListMeshes(Context* context, const v1::ListMeshesRequest* request,
                                              v1::ListMeshesResponse* response) {
  const auto scene = store_.scene({"parent", request->parent()});
  if (!scene.ok()) return answer(context, scene.status());
  for (const auto& mesh : (*scene)->meshes) to_proto(*mesh, *response->add_meshes());
  return answer(context, absl::OkStatus());
}

SceneService::Unary* SceneService::UpdateMesh(Context* context, const v1::UpdateMeshRequest* request,
                                              v1::MeshResponse* response) {
  const auto apply = [&](v1::MeshResponse& message) -> absl::Status {
    const auto patch = from_proto(request->mesh(), request->update_mask());
    if (!patch.ok()) return patch.status();
    return fill(store_.update_mesh({"mesh.name", request->mesh().name()}, *patch), message);
  };
  return answer(context, apply_once(replies_, "UpdateMesh", *request, *response, apply));
}

SceneService::Unary* SceneService::DeleteMesh(Context* context, const v1::DeleteMeshRequest* request,
                                              v1::DeleteResponse* response) {
  const auto apply = [&](v1::DeleteResponse& message) {
    return fill(store_.delete_mesh({"name", request->name()}), message);
  };
  return answer(context, apply_once(replies_, "DeleteMesh", *request, *response, apply));
}

}  // namespace diaphane::service
