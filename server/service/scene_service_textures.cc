// Textures of the SceneService.
#include <memory>

#include "service/convert/deletion.h"
#include "service/convert/texture.h"
#include "service/scene_service.h"
#include "service/texture_upload.h"
#include "service/unary.h"
#include "service/upload_reactor.h"

namespace diaphane::service {

SceneService::Reads<v1::UploadTextureRequest>* SceneService::UploadTexture(Context* context,
                                                                           v1::TextureResponse* response) {
  return new UploadReactor<TextureUpload>(std::make_unique<TextureUpload>(store_), {limits_, workers_, replies_},
                                          context, response);
}

SceneService::Unary* SceneService::GetTexture(Context* context, const v1::GetTextureRequest* request,
                                              v1::Texture* response) {
  return answer(context, fill(store_.texture({"name", request->name()}), *response));
}

SceneService::Unary* SceneService::ListTextures(Context* context, const v1::ListTexturesRequest* request,
                                                v1::ListTexturesResponse* response) {
  const auto scene = store_.scene({"parent", request->parent()});
  if (!scene.ok()) return answer(context, scene.status());
  for (const scene::Texture& texture : (*scene)->textures) to_proto(texture, *response->add_textures());
  return answer(context, absl::OkStatus());
}

SceneService::Unary* SceneService::DeleteTexture(Context* context, const v1::DeleteTextureRequest* request,
                                                 v1::DeleteResponse* response) {
  const auto apply = [&](v1::DeleteResponse& message) {
    return fill(store_.delete_texture({"name", request->name()}), message);
  };
  return answer(context, apply_once(replies_, "DeleteTexture", *request, *response, apply));
}

}  // namespace diaphane::service
