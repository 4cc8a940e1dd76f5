#include "diaphane/scene.h"

#include <optional>
#include <utility>

#include "connection.h"
#include "convert.h"
#include "fmt/format.h"
#include "upload.h"

namespace diaphane {
namespace {

using internal::from_proto;
using internal::new_request_id;
using internal::RenderStub;
using internal::SceneStub;
using internal::to_proto;
using internal::vec3_from_proto;

template <typename Response>
absl::StatusOr<uint64_t> revision_of(const absl::StatusOr<Response>& response) {
  if (!response.ok()) return response.status();
  return response->scene_revision();
}

}  // namespace

Scene::Scene(std::shared_ptr<internal::Connection> connection, std::string name)
    : connection_(std::move(connection)), name_(std::move(name)) {}

const std::string& Scene::name() const { return name_; }

absl::StatusOr<MaterialHandle> Scene::add_material(const Material& material) const {
  v1::CreateMaterialRequest request;
  request.set_parent(name_);
  *request.mutable_material() = to_proto(material);
  request.set_request_id(new_request_id());
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::CreateMaterial, request);
  if (!response.ok()) return response.status();
  return MaterialHandle{response->material().name()};
}

absl::StatusOr<MaterialInfo> Scene::material(const MaterialHandle& handle) const {
  v1::GetMaterialRequest request;
  request.set_name(handle.name);
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::GetMaterial, request);
  if (!response.ok()) return response.status();
  return internal::info_from_proto(*response);
}

absl::StatusOr<uint64_t> Scene::update_material(const MaterialHandle& handle, const Material& material) const {
  v1::UpdateMaterialRequest request;
  *request.mutable_material() = to_proto(material);
  request.mutable_material()->set_name(handle.name);
  for (const char* path : {"model", "profile", "coat", "textures"}) request.mutable_update_mask()->add_paths(path);
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::UpdateMaterial, request));
}

absl::StatusOr<uint64_t> Scene::remove_material(const MaterialHandle& handle) const {
  v1::DeleteMaterialRequest request;
  request.set_name(handle.name);
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::DeleteMaterial, request));
}

absl::StatusOr<TextureHandle> Scene::add_texture(const TextureData& texture) const {
  return internal::upload_texture(*connection_, name_, texture);
}

absl::StatusOr<uint64_t> Scene::remove_texture(const TextureHandle& handle) const {
  v1::DeleteTextureRequest request;
  request.set_name(handle.name);
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::DeleteTexture, request));
}

absl::StatusOr<LightHandle> Scene::add_light(const Light& light) const {
  v1::CreateLightRequest request;
  request.set_parent(name_);
  *request.mutable_light() = to_proto(light);
  request.set_request_id(new_request_id());
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::CreateLight, request);
  if (!response.ok()) return response.status();
  return LightHandle{response->light().name()};
}

absl::StatusOr<uint64_t> Scene::update_light(const LightHandle& handle, const Light& light) const {
  v1::UpdateLightRequest request;
  *request.mutable_light() = to_proto(light);
  request.mutable_light()->set_name(handle.name);
  request.mutable_update_mask()->add_paths(internal::kind_of(light));
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::UpdateLight, request));
}

absl::StatusOr<uint64_t> Scene::remove_light(const LightHandle& handle) const {
  v1::DeleteLightRequest request;
  request.set_name(handle.name);
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::DeleteLight, request));
}

absl::StatusOr<uint64_t> Scene::set_environment(const EnvironmentMap& map, const EnvironmentOptions& options) const {
  return internal::upload_environment(*connection_, name_, map, options);
}

absl::StatusOr<uint64_t> Scene::update_environment(const EnvironmentOptions& options) const {
  v1::UpdateEnvironmentRequest request;
  request.mutable_environment()->set_name(name_ + "/environment");
  request.mutable_environment()->set_rotation_deg(options.rotation_deg);
  request.mutable_environment()->set_intensity(options.intensity);
  request.mutable_update_mask()->add_paths("rotation_deg");
  request.mutable_environment()->set_occlusion(options.occlusion);
  request.mutable_update_mask()->add_paths("intensity");
  request.mutable_update_mask()->add_paths("occlusion");
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::UpdateEnvironment, request));
}

absl::StatusOr<uint64_t> Scene::remove_environment() const {
  v1::DeleteEnvironmentRequest request;
  request.set_name(name_ + "/environment");
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::DeleteEnvironment, request));
}

absl::StatusOr<MeshHandle> Scene::add_mesh(const MeshData& mesh, const MeshOptions& options) const {
  return internal::upload_mesh(*connection_, name_, mesh, options);
}

absl::StatusOr<uint64_t> Scene::update_mesh(const MeshHandle& handle, const MeshUpdate& update) const {
  v1::UpdateMeshRequest request;
  request.mutable_mesh()->set_name(handle.name);
  if (update.material) {
    request.mutable_mesh()->set_material(update.material->name);
    request.mutable_update_mask()->add_paths("material");
  }
  if (update.scene_from_mesh) {
    request.mutable_mesh()->mutable_scene_from_mesh()->Assign(update.scene_from_mesh->begin(),
                                                              update.scene_from_mesh->end());
    request.mutable_update_mask()->add_paths("scene_from_mesh");
  }
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::UpdateMesh, request));
}

absl::StatusOr<uint64_t> Scene::update_positions(const MeshHandle& handle, std::span<const Vec3> positions,
                                                 std::span<const Vec3> normals) const {
  return internal::upload_positions(*connection_, handle, positions, normals);
}

absl::StatusOr<uint64_t> Scene::remove_mesh(const MeshHandle& handle) const {
  v1::DeleteMeshRequest request;
  request.set_name(handle.name);
  request.set_request_id(new_request_id());
  return revision_of(connection_->call(connection_->scene_service(), &SceneStub::DeleteMesh, request));
}

absl::StatusOr<SceneDescription> Scene::describe() const {
  v1::GetSceneRequest scene;
  scene.set_name(name_);
  v1::ListMaterialsRequest materials;
  materials.set_parent(name_);
  v1::ListLightsRequest lights;
  lights.set_parent(name_);
  v1::ListMeshesRequest meshes;
  meshes.set_parent(name_);
  const auto& service = connection_->scene_service();
  const auto scene_answer = connection_->call(service, &SceneStub::GetScene, scene);
  if (!scene_answer.ok()) return scene_answer.status();
  const auto material_answer = connection_->call(service, &SceneStub::ListMaterials, materials);
  if (!material_answer.ok()) return material_answer.status();
  const auto light_answer = connection_->call(service, &SceneStub::ListLights, lights);
  if (!light_answer.ok()) return light_answer.status();
  const auto mesh_answer = connection_->call(service, &SceneStub::ListMeshes, meshes);
  if (!mesh_answer.ok()) return mesh_answer.status();

  SceneDescription description{from_proto(*scene_answer)};
  for (const v1::Material& material : material_answer->materials()) {
    description.materials.push_back(internal::info_from_proto(material));
  }
  for (const v1::Light& light : light_answer->lights()) {
    description.lights.push_back({{light.name()}, from_proto(light)});
  }
  for (const v1::Mesh& mesh : mesh_answer->meshes()) description.meshes.push_back(from_proto(mesh));
  return description;
}

absl::StatusOr<std::optional<PickedPoint>> Scene::pick(const Camera& camera, const Size& size, float x_px,
                                                       float y_px) const {
  v1::PickRequest request;
  const v1::RenderFrameRequest frame = to_proto(RenderOptions{camera, size});
  request.set_scene(name_);
  *request.mutable_camera() = frame.camera();
  *request.mutable_size() = frame.size();
  request.set_x_px(x_px);
  request.set_y_px(y_px);
  const auto response = connection_->call(connection_->render_service(), &RenderStub::Pick, request);
  if (!response.ok()) return response.status();
  if (!response->has_point()) return std::optional<PickedPoint>();
  const v1::PickedPoint& point = response->point();
  return PickedPoint{MeshHandle{point.mesh()},
                     point.triangle(),
                     vec3_from_proto(point.barycentric()),
                     vec3_from_proto(point.position()),
                     vec3_from_proto(point.facet_normal()),
                     point.distance(),
                     response->scene_revision()};
}

absl::StatusOr<RenderedFrame> Scene::render(const RenderOptions& options) const {
  v1::RenderFrameRequest request = to_proto(options);
  request.set_scene(name_);
  auto response = connection_->call(connection_->render_service(), &RenderStub::RenderFrame, request);
  if (!response.ok()) return response.status();
  return from_proto(*std::move(response));
}

absl::StatusOr<RenderedFrame> Scene::render(const RenderOptions& options,
                                            const std::function<void(double)>& progress) const {
  v1::RenderFrameRequest request = to_proto(options);
  request.set_scene(name_);
  std::optional<RenderedFrame> frame;
  const absl::Status status = connection_->run([&](grpc::ClientContext& context) {
    const auto reader = connection_->render_service()->RenderFrameWithProgress(&context, request);
    v1::RenderFrameWithProgressResponse part;
    while (reader->Read(&part)) {
      if (part.has_frame()) {
        frame = from_proto(std::move(*part.mutable_frame()));
      } else if (progress) {
        progress(part.progress());
      }
    }
    return reader->Finish();
  });
  if (!status.ok()) return status;
  if (!frame) return absl::InternalError("the server ended its answer without a frame");
  return *std::move(frame);
}

absl::Status Scene::remove() const {
  v1::DeleteSceneRequest request;
  request.set_name(name_);
  request.set_request_id(new_request_id());
  google::protobuf::Empty response;
  return connection_->run_to_the_end([&](grpc::ClientContext& context) {
    return connection_->scene_service()->DeleteScene(&context, request, &response);
  });
}

}  // namespace diaphane
