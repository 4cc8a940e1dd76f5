#include "service/scene_service.h"

#include "base/status.h"
#include "service/convert/check.h"
#include "service/edit_stream.h"
#include "service/unary.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kDefaultPageSize = 100;
constexpr uint32_t kLargestPageSize = 1000;

absl::Status list_scenes(const scene::SceneStore& store, const v1::ListScenesRequest& request,
                         v1::ListScenesResponse& response) {
  absl::Status size = check_range("page_size", request.page_size(), 0, kLargestPageSize);
  if (!size.ok()) return size;
  const uint32_t page_size = request.page_size() == 0 ? kDefaultPageSize : request.page_size();
  const absl::StatusOr<scene::ScenePage> page = store.scenes(page_size, {"page_token", request.page_token()});
  if (!page.ok()) return page.status();
  for (const scene::SnapshotPtr& scene : page->scenes) to_proto(scene, *response.add_scenes());
  response.set_next_page_token(page->next_page_token);
  return absl::OkStatus();
}

}  // namespace

SceneService::Unary* SceneService::CreateScene(Context* context, const v1::CreateSceneRequest* request,
                                               v1::Scene* response) {
  return answer(context,
                apply_once(replies_, "CreateScene", *request, *response, [&](v1::Scene& message) -> absl::Status {
                  const auto values = from_proto(request->scene());
                  if (!values.ok()) return values.status();
                  return fill(store_.create_scene(*values), message);
                }));
}

SceneService::Unary* SceneService::GetScene(Context* context, const v1::GetSceneRequest* request, v1::Scene* response) {
  return answer(context, fill(store_.scene({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::ListScenes(Context* context, const v1::ListScenesRequest* request,
                                              v1::ListScenesResponse* response) {
  return answer(context, list_scenes(store_, *request, *response));
}

SceneService::Unary* SceneService::UpdateScene(Context* context, const v1::UpdateSceneRequest* request,
                                               v1::Scene* response) {
  return answer(context,
                apply_once(replies_, "UpdateScene", *request, *response, [&](v1::Scene& message) -> absl::Status {
                  const auto patch = from_proto(request->scene(), request->update_mask());
                  if (!patch.ok()) return patch.status();
                  return fill(store_.update_scene({"scene.name", request->scene().name()}, *patch), message);
                }));
}

SceneService::Unary* SceneService::DeleteScene(Context* context, const v1::DeleteSceneRequest* request,
                                               google::protobuf::Empty* response) {
  return answer(context, apply_once(replies_, "DeleteScene", *request, *response, [&](google::protobuf::Empty&) {
                  return store_.delete_scene({"name", request->name()});
                }));
}

grpc::ServerBidiReactor<v1::EditSceneRequest, v1::EditSceneResponse>* SceneService::EditScene(Context* context) {
  return new EditStream(store_, render_thread_, editors_, open_streams_, shared_buffers_, context->peer());
}

}  // namespace diaphane::service
