// What the services do with good input.
#include <gmock/gmock.h>

#include <optional>
#include <set>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::MatchesRegex;

class ResourcesTest : public ServiceTest {};

TEST_F(ResourcesTest, CreatesASceneWithDefaults) {
  const v1::Scene scene = create_scene();
  EXPECT_THAT(scene.name(), MatchesRegex("scenes/[0-9a-f]{32}"));
  EXPECT_EQ(scene.millimetres_per_unit(), 1);
  EXPECT_EQ(scene.revision(), 1u);
}

TEST_F(ResourcesTest, UpdatesOnlyWhatTheMaskNames) {
  const v1::Scene before = create_scene();
  v1::UpdateSceneRequest request;
  *request.mutable_scene() = before;
  request.mutable_scene()->set_display_name("bust");
  request.mutable_scene()->set_millimetres_per_unit(25);
  request.mutable_update_mask()->add_paths("display_name");
  Context context;
  v1::Scene after;
  ASSERT_TRUE(scenes_->UpdateScene(&context, request, &after).ok());
  EXPECT_EQ(after.display_name(), "bust");
  EXPECT_EQ(after.millimetres_per_unit(), 1);
  EXPECT_EQ(after.revision(), 2u);
}

TEST_F(ResourcesTest, UpdatesALightFieldByField) {
  const std::string scene = create_scene().name();
  v1::CreateLightRequest create;
  create.set_parent(scene);
  create.mutable_light()->mutable_point()->mutable_position()->set_x(3);
  create.mutable_light()->mutable_point()->mutable_intensity()->set_x(7);
  v1::LightResponse light;
  {
    Context context;
    ASSERT_TRUE(scenes_->CreateLight(&context, create, &light).ok());
  }
  v1::UpdateLightRequest update;
  update.mutable_light()->set_name(light.light().name());
  update.mutable_light()->mutable_point()->mutable_position()->set_x(4);
  update.mutable_update_mask()->add_paths("point.position");
  Context context;
  ASSERT_TRUE(scenes_->UpdateLight(&context, update, &light).ok());
  EXPECT_EQ(light.light().point().position().x(), 4);
  EXPECT_EQ(light.light().point().intensity().x(), 7);
  EXPECT_EQ(light.scene_revision(), 3u);
}

TEST_F(ResourcesTest, ResolvesPresetsAndChangesMaterials) {
  const std::string name = create_material(create_scene().name(), "marble");
  v1::Material material;
  {
    Context context;
    v1::GetMaterialRequest request;
    request.set_name(name);
    ASSERT_TRUE(scenes_->GetMaterial(&context, request, &material).ok());
  }
  EXPECT_EQ(material.preset(), "marble");
  EXPECT_FLOAT_EQ(material.resolved().reduced_scattering_mm().x(), 2.19f);
  EXPECT_FLOAT_EQ(material.resolved().refractive_index(), 1.5f);
  v1::UpdateMaterialRequest update;
  update.mutable_material()->set_name(name);
  for (auto set : {&v1::Vec3::set_x, &v1::Vec3::set_y, &v1::Vec3::set_z}) {
    (update.mutable_material()->mutable_coefficients()->mutable_reduced_scattering_mm()->*set)(0.5f);
  }
  update.mutable_update_mask()->add_paths("coefficients");
  Context context;
  v1::MaterialResponse response;
  ASSERT_TRUE(scenes_->UpdateMaterial(&context, update, &response).ok());
  EXPECT_TRUE(response.material().has_coefficients());
  EXPECT_FLOAT_EQ(response.material().resolved().refractive_index(), 1.3f);
  EXPECT_EQ(response.scene_revision(), 3u);
}

TEST_F(ResourcesTest, ResolvesColoursAndWarnsOfThemInTheAnswer) {
  v1::CreateMaterialRequest request;
  request.set_parent(create_scene().name());
  v1::DiffuseColor& color = *request.mutable_material()->mutable_diffuse_color();
  color.mutable_color()->set_x(0.9f);
  color.mutable_color()->set_y(0.9f);
  color.mutable_color()->set_z(0.01f);
  for (auto set : {&v1::Vec3::set_x, &v1::Vec3::set_y, &v1::Vec3::set_z}) {
    (color.mutable_mean_free_path_mm()->*set)(0.5f);
  }
  v1::MaterialResponse created;
  {
    Context context;
    ASSERT_TRUE(scenes_->CreateMaterial(&context, request, &created).ok());
  }
  const v1::Material& material = created.material();
  EXPECT_TRUE(material.has_diffuse_color());
  EXPECT_EQ(material.profile(), v1::PROFILE_DIPOLE);
  const v1::Coefficients& resolved = material.resolved();
  EXPECT_NEAR(resolved.absorption_mm().x() + resolved.reduced_scattering_mm().x(), 2, 1e-4);
  ASSERT_EQ(material.warnings_size(), 1);
  EXPECT_NE(material.warnings(0).find("blue scatters too little"), std::string::npos) << material.warnings(0);

  // Only the profile changes; the coefficients follow, so that the colour stays.
  v1::UpdateMaterialRequest update;
  update.mutable_material()->set_name(material.name());
  update.mutable_material()->set_profile(v1::PROFILE_BETTER_DIPOLE);
  update.mutable_update_mask()->add_paths("profile");
  Context context;
  v1::MaterialResponse updated;
  ASSERT_TRUE(scenes_->UpdateMaterial(&context, update, &updated).ok());
  EXPECT_TRUE(updated.material().has_diffuse_color());
  EXPECT_EQ(updated.material().profile(), v1::PROFILE_BETTER_DIPOLE);
  EXPECT_NE(updated.material().resolved().absorption_mm().x(), resolved.absorption_mm().x());
}

TEST_F(ResourcesTest, PutsCoatsOnMaterialsAndTakesThemOff) {
  v1::CreateMaterialRequest request;
  request.set_parent(create_scene().name());
  request.mutable_material()->set_preset("porcelain");
  request.mutable_material()->mutable_coat()->set_roughness(0.25f);
  v1::MaterialResponse created;
  {
    Context context;
    ASSERT_TRUE(scenes_->CreateMaterial(&context, request, &created).ok());
  }
  ASSERT_TRUE(created.material().has_coat());
  EXPECT_EQ(created.material().coat().roughness(), 0.25f);
  const auto update = [&](const char* path, std::optional<float> roughness) {
    v1::UpdateMaterialRequest message;
    message.mutable_material()->set_name(created.material().name());
    message.mutable_material()->set_profile(v1::PROFILE_BETTER_DIPOLE);
    if (roughness) message.mutable_material()->mutable_coat()->set_roughness(*roughness);
    message.mutable_update_mask()->add_paths(path);
    Context context;
    v1::MaterialResponse updated;
    EXPECT_TRUE(scenes_->UpdateMaterial(&context, message, &updated).ok());
    return updated.material();
  };
  EXPECT_EQ(update("profile", std::nullopt).coat().roughness(), 0.25f);
  EXPECT_EQ(update("coat", 0.0f).coat().roughness(), 0);
  EXPECT_EQ(update("coat", 0.0f).preset(), "porcelain");
  EXPECT_FALSE(update("coat", std::nullopt).has_coat());
}

TEST_F(ResourcesTest, ListsEveryPresetWithItsSource) {
  Context context;
  v1::ListMaterialPresetsResponse response;
  ASSERT_TRUE(scenes_->ListMaterialPresets(&context, {}, &response).ok());
  EXPECT_EQ(response.presets_size(), 14);
  for (const auto& preset : response.presets()) EXPECT_FALSE(preset.source().empty()) << preset.name();
}

TEST_F(ResourcesTest, ListsScenesPageByPage) {
  std::set<std::string> created;
  for (int i = 0; i < 5; ++i) created.insert(create_scene().name());
  std::set<std::string> listed;
  std::vector<int> sizes;
  v1::ListScenesRequest request;
  request.set_page_size(2);
  do {
    Context context;
    v1::ListScenesResponse page;
    ASSERT_TRUE(scenes_->ListScenes(&context, request, &page).ok());
    sizes.push_back(page.scenes_size());
    for (const auto& scene : page.scenes()) listed.insert(scene.name());
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(listed, created);
  EXPECT_THAT(sizes, ElementsAre(2, 2, 1));
}

TEST_F(ResourcesTest, ListsWhatASceneHolds) {
  const std::string scene = create_scene().name();
  const v1::Mesh mesh = create_mesh(scene);
  const std::string other = create_material(scene, "skin1");
  Context contexts[3];
  v1::ListMaterialsRequest materials_of;
  materials_of.set_parent(scene);
  v1::ListMaterialsResponse materials;
  ASSERT_TRUE(scenes_->ListMaterials(&contexts[0], materials_of, &materials).ok());
  ASSERT_EQ(materials.materials_size(), 2);
  EXPECT_EQ(materials.materials(1).name(), other);
  v1::ListMeshesRequest meshes_of;
  meshes_of.set_parent(scene);
  v1::ListMeshesResponse meshes;
  ASSERT_TRUE(scenes_->ListMeshes(&contexts[1], meshes_of, &meshes).ok());
  ASSERT_EQ(meshes.meshes_size(), 1);
  EXPECT_EQ(meshes.meshes(0).SerializeAsString(), mesh.SerializeAsString());
  v1::ListLightsRequest lights_of;
  lights_of.set_parent(scene);
  v1::ListLightsResponse lights;
  ASSERT_TRUE(scenes_->ListLights(&contexts[2], lights_of, &lights).ok());
  EXPECT_EQ(lights.lights_size(), 0);
}

TEST_F(ResourcesTest, GivesAMeshAnotherMaterial) {
  const std::string scene = create_scene().name();
  v1::UpdateMeshRequest request;
  *request.mutable_mesh() = create_mesh(scene);
  const uint64_t positions_revision = request.mesh().positions_revision();
  request.mutable_mesh()->set_material(create_material(scene, "skin1"));
  request.mutable_mesh()->set_scene_from_mesh(0, 9);
  request.mutable_update_mask()->add_paths("material");
  Context context;
  v1::MeshResponse response;
  ASSERT_TRUE(scenes_->UpdateMesh(&context, request, &response).ok());
  EXPECT_EQ(response.mesh().material(), request.mesh().material());
  EXPECT_EQ(response.mesh().scene_from_mesh(0), 1);
  EXPECT_EQ(response.mesh().positions_revision(), positions_revision);
  EXPECT_EQ(response.scene_revision(), 5u);
}

TEST_F(ResourcesTest, DeletesASceneWithAllThatIsInIt) {
  const std::string scene = create_scene().name();
  const v1::Mesh mesh = create_mesh(scene);
  EXPECT_GT(server_->scenes().mesh_bytes(), 0u);
  v1::DeleteSceneRequest request;
  request.set_name(scene);
  Context context;
  google::protobuf::Empty empty;
  ASSERT_TRUE(scenes_->DeleteScene(&context, request, &empty).ok());
  EXPECT_EQ(server_->scenes().mesh_bytes(), 0u);
  Context again;
  v1::GetMeshRequest get;
  get.set_name(mesh.name());
  v1::Mesh gone;
  EXPECT_EQ(scenes_->GetMesh(&again, get, &gone).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(ResourcesTest, AnswersARepeatedRequestAsTheFirst) {
  v1::CreateSceneRequest request;
  request.mutable_scene()->set_display_name("bust");
  request.set_request_id("one");
  std::set<std::string> names;
  for (int i = 0; i < 3; ++i) {
    Context context;
    v1::Scene scene;
    ASSERT_TRUE(scenes_->CreateScene(&context, request, &scene).ok());
    names.insert(scene.name());
  }
  EXPECT_EQ(names.size(), 1u);
  request.set_request_id("two");
  Context context;
  v1::Scene scene;
  ASSERT_TRUE(scenes_->CreateScene(&context, request, &scene).ok());
  EXPECT_EQ(names.count(scene.name()), 0u);
}

TEST_F(ResourcesTest, AppliesARepeatedUpdateOnce) {
  v1::UpdateSceneRequest request;
  request.mutable_scene()->set_name(create_scene().name());
  request.mutable_update_mask()->add_paths("display_name");
  request.set_request_id("rename");
  for (int i = 0; i < 3; ++i) {
    Context context;
    v1::Scene scene;
    ASSERT_TRUE(scenes_->UpdateScene(&context, request, &scene).ok());
    EXPECT_EQ(scene.revision(), 2u);
  }
}

TEST_F(ResourcesTest, RefusesARequestIdOfAnotherRequest) {
  v1::CreateSceneRequest request;
  request.set_request_id("one");
  v1::Scene scene;
  {
    Context context;
    ASSERT_TRUE(scenes_->CreateScene(&context, request, &scene).ok());
  }
  request.mutable_scene()->set_display_name("another");
  Context context;
  const grpc::Status status = scenes_->CreateScene(&context, request, &scene);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(error_info(status).metadata().at("field"), "request_id");
}

TEST_F(ResourcesTest, TriesARequestAgainThatFailed) {
  v1::CreateMaterialRequest request;
  request.set_parent(create_scene().name());
  request.set_request_id("again");
  v1::MaterialResponse response;
  for (const char* preset : {"granite", "marble"}) {
    request.mutable_material()->set_preset(preset);
    Context context;
    EXPECT_EQ(scenes_->CreateMaterial(&context, request, &response).ok(), std::string_view(preset) == "marble");
  }
}

TEST_F(ResourcesTest, ForgetsTheOldestReplyPastItsMemory) {
  service::ServiceLimits limits;
  limits.max_remembered_replies = 2;
  start(limits);
  const auto create = [&](const std::string& request_id) {
    v1::CreateSceneRequest request;
    request.set_request_id(request_id);
    Context context;
    v1::Scene scene;
    EXPECT_TRUE(scenes_->CreateScene(&context, request, &scene).ok());
    return scene.name();
  };
  const std::string a = create("a");
  const std::string b = create("b");
  EXPECT_EQ(create("a"), a);  // now b is the oldest
  create("c");
  EXPECT_EQ(create("a"), a);
  EXPECT_NE(create("b"), b);
}

TEST_F(ResourcesTest, TellsWhatTheServerIs) {
  Context context;
  v1::ServerInfo info;
  ASSERT_TRUE(info_->GetServerInfo(&context, {}, &info).ok());
  EXPECT_THAT(info.version(), MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(info.gl_renderer(), "fake renderer");
  EXPECT_TRUE(info.software_rendering());
  EXPECT_EQ(info.limits().max_chunk_bytes(), 1u << 20);
  EXPECT_EQ(info.limits().max_pixels(), service::ServiceLimits().max_pixels);
  std::vector<std::string> formats{"png", "jpeg", "exr", "webp"};
  if (!info.h264_encoder().empty()) formats.push_back("h264");
  EXPECT_THAT(info.image_formats(), ElementsAreArray(formats));
}

}  // namespace
}  // namespace diaphane::e2e
