#pragma once

#include "base/worker_pool.h"
#include "diaphane/v1/scene_service.grpc.pb.h"
#include "scene/scene_store.h"
#include "service/editors.h"
#include "service/limits.h"
#include "service/open_streams.h"
#include "service/reply_memory.h"
#include "service/shared_buffers.h"
#include "session/render_thread.h"

namespace diaphane::service {

/// Scenes and what is in them. Thread-safe. What it borrows outlives it, and the server that serves it.
class SceneService final : public v1::SceneService::CallbackService {
 public:
  /// `workers` hash, check and index what was uploaded: too long for a gRPC thread.
  SceneService(const ServiceLimits& limits, scene::SceneStore& store, const session::RenderThread& render_thread,
               base::WorkerPool& workers, OpenStreams& open_streams)
      : limits_(limits),
        store_(store),
        render_thread_(render_thread),
        workers_(workers),
        open_streams_(open_streams),
        replies_(limits.max_remembered_replies) {}

 private:
  template <typename Request>
  using Reads = grpc::ServerReadReactor<Request>;
  using Context = grpc::CallbackServerContext;
  using Unary = grpc::ServerUnaryReactor;

  Unary* CreateScene(Context*, const v1::CreateSceneRequest*, v1::Scene*) override;
  Unary* GetScene(Context*, const v1::GetSceneRequest*, v1::Scene*) override;
  Unary* ListScenes(Context*, const v1::ListScenesRequest*, v1::ListScenesResponse*) override;
  Unary* UpdateScene(Context*, const v1::UpdateSceneRequest*, v1::Scene*) override;
  Unary* DeleteScene(Context*, const v1::DeleteSceneRequest*, google::protobuf::Empty*) override;

  Unary* CreateMaterial(Context*, const v1::CreateMaterialRequest*, v1::MaterialResponse*) override;
  Unary* GetMaterial(Context*, const v1::GetMaterialRequest*, v1::Material*) override;
  Unary* ListMaterials(Context*, const v1::ListMaterialsRequest*, v1::ListMaterialsResponse*) override;
  Unary* UpdateMaterial(Context*, const v1::UpdateMaterialRequest*, v1::MaterialResponse*) override;
  Unary* DeleteMaterial(Context*, const v1::DeleteMaterialRequest*, v1::DeleteResponse*) override;
  Unary* ListMaterialPresets(Context*, const v1::ListMaterialPresetsRequest*,
                             v1::ListMaterialPresetsResponse*) override;

  Unary* CreateLight(Context*, const v1::CreateLightRequest*, v1::LightResponse*) override;
  Unary* GetLight(Context*, const v1::GetLightRequest*, v1::Light*) override;
  Unary* ListLights(Context*, const v1::ListLightsRequest*, v1::ListLightsResponse*) override;
  Unary* UpdateLight(Context*, const v1::UpdateLightRequest*, v1::LightResponse*) override;
  Unary* DeleteLight(Context*, const v1::DeleteLightRequest*, v1::DeleteResponse*) override;

  Reads<v1::UploadMeshRequest>* UploadMesh(Context*, v1::MeshResponse*) override;
  Unary* GetMesh(Context*, const v1::GetMeshRequest*, v1::Mesh*) override;
  Unary* ListMeshes(Context*, const v1::ListMeshesRequest*, v1::ListMeshesResponse*) override;
  Unary* UpdateMesh(Context*, const v1::UpdateMeshRequest*, v1::MeshResponse*) override;
  Unary* DeleteMesh(Context*, const v1::DeleteMeshRequest*, v1::DeleteResponse*) override;
  Reads<v1::UpdatePositionsRequest>* UpdatePositions(Context*, v1::MeshResponse*) override;

  grpc::ServerBidiReactor<v1::EditSceneRequest, v1::EditSceneResponse>* EditScene(Context*) override;

  Reads<v1::UploadTextureRequest>* UploadTexture(Context*, v1::TextureResponse*) override;
  Unary* GetTexture(Context*, const v1::GetTextureRequest*, v1::Texture*) override;
  Unary* ListTextures(Context*, const v1::ListTexturesRequest*, v1::ListTexturesResponse*) override;
  Unary* DeleteTexture(Context*, const v1::DeleteTextureRequest*, v1::DeleteResponse*) override;

  Reads<v1::UploadEnvironmentRequest>* UploadEnvironment(Context*, v1::EnvironmentResponse*) override;
  Unary* GetEnvironment(Context*, const v1::GetEnvironmentRequest*, v1::Environment*) override;
  Unary* UpdateEnvironment(Context*, const v1::UpdateEnvironmentRequest*, v1::EnvironmentResponse*) override;
  Unary* DeleteEnvironment(Context*, const v1::DeleteEnvironmentRequest*, v1::DeleteResponse*) override;

  const ServiceLimits limits_;
  scene::SceneStore& store_;
  const session::RenderThread& render_thread_;
  base::WorkerPool& workers_;
  Editors editors_;
  SharedBufferCount shared_buffers_;
  OpenStreams& open_streams_;
  ReplyMemory replies_;
};

}  // namespace diaphane::service
