// Bad input: refused by name, value and range, and nothing has changed.
#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What a refusal must say.
struct Refusal {
  std::string field;
  std::string value;
  std::string range;  // a part of it
  grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT;
};

class BadRequestTest : public ServiceTest {
 protected:
  void SetUp() override {
    service::ServiceLimits limits;
    limits.max_pixels = 1 << 22;
    limits.scene.max_vertices_per_mesh = 1000;
    limits.scene.max_triangles_per_mesh = 1000;
    limits.scene.max_mesh_bytes = 20'000;
    start(limits);
    scene_ = create_scene().name();
    mesh_ = create_mesh(scene_);
    material_ = mesh_.material();
    bytes_ = server_->scenes().mesh_bytes();
  }

  void expect_refused(const grpc::Status& status, const Refusal& refusal) {
    SCOPED_TRACE(refusal.field);
    EXPECT_EQ(status.error_code(), refusal.code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(refusal.field + ": must be "));
    const google::rpc::ErrorInfo info = error_info(status);
    EXPECT_EQ(info.domain(), "diaphane");
    ASSERT_EQ(info.metadata().count("field"), 1u);
    EXPECT_EQ(info.metadata().at("field"), refusal.field);
    EXPECT_EQ(info.metadata().at("value"), refusal.value);
    EXPECT_THAT(info.metadata().at("range"), HasSubstr(refusal.range));
    // Nothing changed, nothing is kept, and the next request is served.
    EXPECT_EQ(server_->scenes().mesh_bytes(), bytes_);
    EXPECT_EQ(get_scene(scene_).revision(), 3u);
    v1::RenderFrameResponse frame;
    EXPECT_TRUE(render(frame_of(scene_), &frame).ok());
  }

  void expect_frame_refused(const std::function<void(v1::RenderFrameRequest&)>& spoil, const Refusal& refusal) {
    v1::RenderFrameRequest request = frame_of(scene_);
    spoil(request);
    v1::RenderFrameResponse response;
    expect_refused(render(request, &response), refusal);
  }

  void expect_upload_refused(const std::function<void(TestMesh&)>& spoil_mesh,
                             const std::function<void(v1::MeshHeader&)>& spoil_header, const Refusal& refusal) {
    TestMesh mesh;
    spoil_mesh(mesh);
    v1::MeshHeader header = mesh.header(scene_, material_);
    spoil_header(header);
    v1::MeshResponse response;
    expect_refused(upload(header, mesh.payload(), &response), refusal);
  }

  void expect_material_refused(const std::function<void(v1::Material&)>& spoil, const Refusal& refusal) {
    v1::CreateMaterialRequest request;
    request.set_parent(scene_);
    auto& coefficients = *request.mutable_material()->mutable_coefficients();
    for (v1::Vec3* rgb : {coefficients.mutable_absorption_mm(), coefficients.mutable_reduced_scattering_mm()}) {
      rgb->set_x(1);
      rgb->set_y(1);
      rgb->set_z(1);
    }
    spoil(*request.mutable_material());
    Context context;
    v1::MaterialResponse response;
    expect_refused(scenes_->CreateMaterial(&context, request, &response), refusal);
  }

  static void leave(const TestMesh&) {}
  static void leave_header(const v1::MeshHeader&) {}

  std::string scene_;
  std::string material_;
  v1::Mesh mesh_;
  uint64_t bytes_ = 0;
};

TEST_F(BadRequestTest, RefusesSizes) {
  expect_frame_refused([](auto& r) { r.mutable_size()->set_width_px(0); }, {"size.width_px", "0", "1..8192"});
  expect_frame_refused([](auto& r) { r.mutable_size()->set_height_px(8193); }, {"size.height_px", "8193", "1..8192"});
  expect_frame_refused([](auto& r) { r.mutable_size()->set_width_px(4294967295u); },
                       {"size.width_px", "4294967295", "1..8192"});
  expect_frame_refused(
      [](auto& r) {
        r.mutable_size()->set_width_px(8192);
        r.mutable_size()->set_height_px(8192);
      },
      {"size", "8192x8192", "at most 4194304 pixels"});
}

TEST_F(BadRequestTest, RefusesCameras) {
  expect_frame_refused([](auto& r) { r.mutable_camera()->mutable_eye()->set_x(kNan); },
                       {"camera.eye.x", "nan", "-1e+18..1e+18"});
  expect_frame_refused([](auto& r) { r.mutable_camera()->mutable_target()->set_y(kInfinity); },
                       {"camera.target.y", "inf", "-1e+18..1e+18"});
  expect_frame_refused([](auto& r) { r.mutable_camera()->mutable_target()->set_z(5); },
                       {"camera.eye", "0,0,5", "apart from camera.target"});
  expect_frame_refused([](auto& r) { r.mutable_camera()->clear_up(); }, {"camera.up", "0,0,0", "a direction"});
  expect_frame_refused(
      [](auto& r) {
        r.mutable_camera()->mutable_up()->set_y(0);
        r.mutable_camera()->mutable_up()->set_z(-2);
      },
      {"camera.up", "0,0,-2", "not parallel to the view"});
  expect_frame_refused([](auto& r) { r.mutable_camera()->set_fov_y_deg(180); }, {"camera.fov_y_deg", "180", "1..170"});
  expect_frame_refused([](auto& r) { r.clear_camera(); }, {"camera.eye", "0,0,0", "apart from camera.target"});
}

TEST_F(BadRequestTest, RefusesSettings) {
  expect_frame_refused([](auto& r) { r.mutable_settings()->set_technique(static_cast<v1::Technique>(99)); },
                       {"settings.technique", "99", "TECHNIQUE_PAPER"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->mutable_paper()->set_terms(static_cast<v1::Terms>(-1)); },
                       {"settings.paper.terms", "-1", "TERMS_BOTH"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->mutable_paper()->set_kernel_taps(7); },
                       {"settings.paper.kernel_taps", "7", "3..6"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->mutable_paper()->set_face_size_px(4096); },
                       {"settings.paper.face_size_px", "4096", "16..2048"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->mutable_paper()->set_global_gain(-1); },
                       {"settings.paper.global_gain", "-1", "0..1000"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->set_shadows(static_cast<v1::Shadows>(3)); },
                       {"settings.shadows", "3", "SHADOWS_ON"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->set_exposure_ev(kNan); },
                       {"settings.exposure_ev", "nan", "-32..32"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->set_samples(65); }, {"settings.samples", "65", "1..64"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->set_tone_mapping(static_cast<v1::ToneMapping>(7)); },
                       {"settings.tone_mapping", "7", "TONE_MAPPING_NEUTRAL"});
  expect_frame_refused([](auto& r) { r.mutable_settings()->mutable_background()->mutable_color()->set_y(-1); },
                       {"settings.background.color.y", "-1", "0..1000000"});
}

TEST_F(BadRequestTest, CountsEverySampleOfTheReference) {
  expect_frame_refused(
      [](auto& r) {
        r.mutable_settings()->set_technique(v1::TECHNIQUE_REFERENCE);
        r.mutable_settings()->set_samples(64);
        r.mutable_size()->set_width_px(129);
        r.mutable_size()->set_height_px(128);
      },
      {"size", "129x128", "at most 16384 pixels"});
}

TEST_F(BadRequestTest, RefusesEncodings) {
  expect_frame_refused([](auto& r) { r.mutable_encoding()->set_format(static_cast<v1::ImageFormat>(9)); },
                       {"encoding.format", "9", "IMAGE_FORMAT_PNG"});
  expect_frame_refused([](auto& r) { r.mutable_encoding()->set_quality(101); }, {"encoding.quality", "101", "1..100"});
}

TEST_F(BadRequestTest, RefusesChannels) {
  expect_frame_refused([](auto& r) { r.mutable_encoding()->add_channels(v1::CHANNEL_DEPTH); },
                       {"encoding.channels", "1", "none, but of IMAGE_FORMAT_EXR"});
  const auto exr = [](std::vector<int> channels) {
    return [=](v1::RenderFrameRequest& r) {
      r.mutable_encoding()->set_format(v1::IMAGE_FORMAT_EXR);
      for (const int channel : channels) r.mutable_encoding()->add_channels(static_cast<v1::Channel>(channel));
    };
  };
  expect_frame_refused(exr({v1::CHANNEL_DEPTH, v1::CHANNEL_NORMAL, v1::CHANNEL_DEPTH}),
                       {"encoding.channels[2]", "CHANNEL_DEPTH", "given once"});
  expect_frame_refused(exr({0}), {"encoding.channels[0]", "0", "CHANNEL_IRRADIANCE"});
  expect_frame_refused(exr({v1::CHANNEL_POSITION, 99}), {"encoding.channels[1]", "99", "CHANNEL_POSITION"});
  expect_frame_refused(
      [&](auto& r) {
        exr({v1::CHANNEL_DEPTH})(r);
        r.mutable_size()->set_width_px(1024);
        r.mutable_size()->set_height_px(1025);
      },
      {"size", "1024x1025", "at most 1048576 pixels"});
}

TEST_F(BadRequestTest, RefusesStreamsAsItRefusesFrames) {
  v1::RenderFrameRequest request = frame_of(scene_);
  request.mutable_camera()->set_fov_y_deg(180);
  Context context;
  v1::RenderFrameWithProgressResponse part;
  const auto reader = frames_->RenderFrameWithProgress(&context, request);
  EXPECT_FALSE(reader->Read(&part));
  expect_refused(reader->Finish(), {"camera.fov_y_deg", "180", "1..170"});
}

TEST_F(BadRequestTest, RefusesScenesThatCannotBeDrawn) {
  expect_frame_refused([](auto& r) { r.set_scene("scenes/0"); },
                       {"scene", "scenes/0", "existing scene", grpc::StatusCode::NOT_FOUND});
  expect_frame_refused([](auto& r) { r.set_scene("../etc"); }, {"scene", "../etc", "scenes/{scene}"});
  const std::string empty = create_scene().name();
  expect_frame_refused([&](auto& r) { r.set_scene(empty); },
                       {"scene", empty, "a mesh in it", grpc::StatusCode::FAILED_PRECONDITION});
}

TEST_F(BadRequestTest, RefusesMaterials) {
  expect_material_refused([](auto& m) { m.mutable_coefficients()->mutable_absorption_mm()->set_y(-0.5f); },
                          {"material.coefficients.absorption_mm.y", "-0.5", "0..1000"});
  expect_material_refused([](auto& m) { m.mutable_coefficients()->mutable_reduced_scattering_mm()->set_z(0); },
                          {"material.coefficients.reduced_scattering_mm.z", "0", "above 0, up to 1000"});
  expect_material_refused([](auto& m) { m.mutable_coefficients()->mutable_reduced_scattering_mm()->set_x(kNan); },
                          {"material.coefficients.reduced_scattering_mm.x", "nan", "above 0, up to 1000"});
  expect_material_refused([](auto& m) { m.mutable_coefficients()->set_refractive_index(3.5f); },
                          {"material.coefficients.refractive_index", "3.5", "1..3"});
  expect_material_refused([](auto& m) { m.set_preset("granite"); },
                          {"material.preset", "granite", "ListMaterialPresets"});
  expect_material_refused([](auto& m) { m.clear_model(); }, {"material.model", "none", "preset, coefficients"});
  const auto set_rgb = [](v1::Vec3* rgb, float r, float g, float b) {
    rgb->set_x(r);
    rgb->set_y(g);
    rgb->set_z(b);
  };
  const auto with_color = [&](float green, float l, float index) {
    return [&, green, l, index](auto& m) {
      set_rgb(m.mutable_diffuse_color()->mutable_color(), 0.5f, green, 0.5f);
      set_rgb(m.mutable_diffuse_color()->mutable_mean_free_path_mm(), 1, 1, l);
      m.mutable_diffuse_color()->set_refractive_index(index);
    };
  };
  expect_material_refused(with_color(0.9999f, 1, 0), {"material.diffuse_color.color.y", "0.9999", "0..0.999"});
  expect_material_refused(with_color(kNan, 1, 0), {"material.diffuse_color.color.y", "nan", "0..0.999"});
  expect_material_refused(with_color(0.5f, 0, 0), {"material.diffuse_color.mean_free_path_mm.z", "0", "0.001..1000"});
  expect_material_refused(with_color(0.5f, 1, 0.5f), {"material.diffuse_color.refractive_index", "0.5", "1..3"});
  const auto with_volume = [&](float attenuation, float distance, float scatter, float anisotropy) {
    return [&, attenuation, distance, scatter, anisotropy](auto& m) {
      set_rgb(m.mutable_volume()->mutable_attenuation_color(), attenuation, attenuation, attenuation);
      set_rgb(m.mutable_volume()->mutable_multiscatter_color(), scatter, scatter, scatter);
      m.mutable_volume()->set_attenuation_distance_mm(distance);
      m.mutable_volume()->set_scatter_anisotropy(anisotropy);
    };
  };
  expect_material_refused(with_volume(0, 1, 0.5f, 0), {"material.volume.attenuation_color.x", "0", "above 0, up to 1"});
  expect_material_refused(with_volume(1, 1, 0.5f, 0), {"material.volume.attenuation_color", "1, 1, 1", "below 1"});
  expect_material_refused(with_volume(0.5f, 0, 0.5f, 0),
                          {"material.volume.attenuation_distance_mm", "0", "1e-06..1000000"});
  expect_material_refused(with_volume(0.5f, 1, 0, 0), {"material.volume.multiscatter_color", "0, 0, 0", "above 0"});
  expect_material_refused(with_volume(0.5f, 1, 0.5f, 1), {"material.volume.scatter_anisotropy", "1", "-0.99..0.99"});
  expect_material_refused([](auto& m) { m.mutable_coat()->set_roughness(1.5f); },
                          {"material.coat.roughness", "1.5", "0..1"});
  expect_material_refused([](auto& m) { m.mutable_coat()->set_roughness(kNan); },
                          {"material.coat.roughness", "nan", "0..1"});
  expect_material_refused([](auto& m) { m.set_profile(static_cast<v1::Profile>(9)); },
                          {"material.profile", "9", "a value of Profile"});
}

TEST_F(BadRequestTest, RefusesLights) {
  const auto create = [&](const v1::Light& light) {
    v1::CreateLightRequest request;
    request.set_parent(scene_);
    *request.mutable_light() = light;
    Context context;
    v1::LightResponse response;
    return scenes_->CreateLight(&context, request, &response);
  };
  expect_refused(create({}), {"light.kind", "none", "point"});
  v1::Light light;
  light.mutable_point()->mutable_intensity()->set_x(-1);
  expect_refused(create(light), {"light.point.intensity.x", "-1", "0..1000000000000"});
  light.mutable_point()->mutable_position()->set_z(kInfinity);
  expect_refused(create(light), {"light.point.position.z", "inf", "-1e+18..1e+18"});
}

TEST_F(BadRequestTest, RefusesScenes) {
  const auto create = [&](const v1::Scene& scene, const std::string& request_id) {
    v1::CreateSceneRequest request;
    *request.mutable_scene() = scene;
    request.set_request_id(request_id);
    Context context;
    v1::Scene response;
    return scenes_->CreateScene(&context, request, &response);
  };
  v1::Scene scene;
  scene.set_display_name(std::string(257, 'x'));
  expect_refused(create(scene, ""), {"scene.display_name", "257 bytes", "at most 256 bytes"});
  scene.clear_display_name();
  scene.set_millimetres_per_unit(-1);
  expect_refused(create(scene, ""), {"scene.millimetres_per_unit", "-1", "1e-06..1000000"});
  expect_refused(create({}, std::string(65, 'x')), {"request_id", "65 bytes", "at most 64 bytes"});
}

TEST_F(BadRequestTest, RefusesMasks) {
  v1::UpdateSceneRequest request;
  request.mutable_scene()->set_name(scene_);
  v1::Scene response;
  {
    Context context;
    expect_refused(scenes_->UpdateScene(&context, request, &response),
                   {"update_mask", "none", "display_name, millimetres_per_unit"});
  }
  request.mutable_update_mask()->add_paths("revision");
  Context context;
  expect_refused(scenes_->UpdateScene(&context, request, &response),
                 {"update_mask", "revision", "display_name, millimetres_per_unit"});
}

TEST_F(BadRequestTest, RefusesPages) {
  v1::ListScenesRequest request;
  request.set_page_size(1001);
  v1::ListScenesResponse response;
  {
    Context context;
    expect_refused(scenes_->ListScenes(&context, request, &response), {"page_size", "1001", "0..1000"});
  }
  request.set_page_size(1);
  request.set_page_token("-1");
  Context context;
  expect_refused(scenes_->ListScenes(&context, request, &response), {"page_token", "-1", "next_page_token"});
}

TEST_F(BadRequestTest, RefusesToDeleteAMaterialInUse) {
  v1::DeleteMaterialRequest request;
  request.set_name(material_);
  Context context;
  v1::DeleteResponse response;
  expect_refused(scenes_->DeleteMaterial(&context, request, &response),
                 {"name", material_, mesh_.name(), grpc::StatusCode::FAILED_PRECONDITION});
}

TEST_F(BadRequestTest, RefusesTransforms) {
  const auto update = [&](std::vector<float> matrix) {
    v1::UpdateMeshRequest request;
    request.mutable_mesh()->set_name(mesh_.name());
    request.mutable_mesh()->mutable_scene_from_mesh()->Add(matrix.begin(), matrix.end());
    request.mutable_update_mask()->add_paths("scene_from_mesh");
    Context context;
    v1::MeshResponse response;
    return scenes_->UpdateMesh(&context, request, &response);
  };
  expect_refused(update({1, 0, 0, 0, 1}), {"mesh.scene_from_mesh", "5", "16 numbers, or none"});
  expect_refused(update({1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1}), {"mesh.scene_from_mesh", "0", "invertible"});
  expect_refused(update({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                 {"mesh.scene_from_mesh", "0", "invertible: column 1"});
  expect_refused(update({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1}),
                 {"mesh.scene_from_mesh[11]", "0.5", "0, as in every affine matrix"});
  expect_refused(update({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, kNan, 0, 0, 1}),
                 {"mesh.scene_from_mesh[12]", "nan", "-1e+18..1e+18"});
}

TEST_F(BadRequestTest, RefusesHeaders) {
  expect_upload_refused(leave, [](auto& h) { h.set_triangle_count(0); }, {"triangle_count", "0", "at least 1"});
  expect_upload_refused(leave, [](auto& h) { h.set_vertex_count(0); }, {"vertex_count", "0", "at least 1"});
  expect_upload_refused(leave, [](auto& h) { h.set_total_bytes(7); }, {"total_bytes", "7", "96"});
  expect_upload_refused(leave, [](auto& h) { h.set_has_normals(true); }, {"total_bytes", "96", "144"});
  expect_upload_refused(leave, [](auto& h) { h.set_sha256("short"); }, {"sha256", "5 bytes", "32 bytes"});
  expect_upload_refused(leave, [](auto& h) { h.mutable_mesh()->set_material(h.parent() + "/materials/77"); },
                        {"mesh.material", scene_ + "/materials/77", "existing material", grpc::StatusCode::NOT_FOUND});
  const std::string foreign = create_material(create_scene().name());
  expect_upload_refused(leave, [&](auto& h) { h.mutable_mesh()->set_material(foreign); },
                        {"mesh.material", foreign, "a material of " + scene_});
  expect_upload_refused(leave, [](auto& h) { h.set_parent("scenes/0"); },
                        {"parent", "scenes/0", "existing scene", grpc::StatusCode::NOT_FOUND});
}

TEST_F(BadRequestTest, RefusesMeshesOverTheLimits) {
  const auto grow = [](uint32_t vertices, uint32_t triangles) {
    return [=](v1::MeshHeader& h) {
      h.set_vertex_count(vertices);
      h.set_triangle_count(triangles);
      h.set_total_bytes(uint64_t{12} * vertices + uint64_t{12} * triangles);
    };
  };
  const auto exhausted = grpc::StatusCode::RESOURCE_EXHAUSTED;
  expect_upload_refused(leave, grow(4'000'000'000u, 1), {"vertex_count", "4000000000", "at most 1000", exhausted});
  expect_upload_refused(leave, grow(3, 4'000'000'000u), {"triangle_count", "4000000000", "at most 1000", exhausted});
  expect_upload_refused(leave, grow(1000, 1), {"mesh_bytes", "88040", "limit 20000", exhausted});
}

TEST_F(BadRequestTest, RefusesPayloads) {
  expect_upload_refused([](auto& m) { m.triangles[4] = 4; }, leave_header, {"indices[4]", "4", "below vertex_count 4"});
  expect_upload_refused([](auto& m) { m.positions[7] = kNan; }, leave_header, {"positions[2].y", "nan", "finite"});
  expect_upload_refused(
      [](auto& m) {
        m.normals.assign(12, 1);
        m.normals[11] = kInfinity;
      },
      leave_header, {"normals[3].z", "inf", "finite"});
  expect_upload_refused([](auto& m) { m.triangles[0] = ~0u; }, leave_header,
                        {"indices[0]", "4294967295", "below vertex_count 4"});
}

TEST_F(BadRequestTest, RefusesPayloadsThatAreNotTheHeaders) {
  const TestMesh mesh;
  const v1::MeshHeader header = mesh.header(scene_, material_);
  v1::MeshResponse response;
  std::string changed = mesh.payload();
  changed[0] ^= 1;
  expect_refused(upload(header, changed, &response),
                 {"sha256", service::hex(header.sha256()), service::hex(service::sha256(changed))});
  expect_refused(upload(header, mesh.payload().substr(0, 90), &response), {"chunk", "90 bytes", "96 bytes in all"});
  expect_refused(upload(header, mesh.payload() + "x", &response), {"chunk", "97 bytes", "at most the 96 bytes"});
  expect_refused(upload(header, std::string((1 << 20) + 1, 'x'), &response, 1 << 21),
                 {"chunk", "1048577 bytes", "at most 1048576 bytes"});
}

TEST_F(BadRequestTest, RefusesPartsOutOfOrder) {
  const TestMesh mesh;
  const auto send = [&](const std::vector<v1::UploadMeshRequest>& parts) {
    Context context;
    v1::MeshResponse response;
    const auto stream = scenes_->UploadMesh(&context, &response);
    for (const auto& part : parts) stream->Write(part);
    stream->WritesDone();
    return stream->Finish();
  };
  v1::UploadMeshRequest header, chunk;
  *header.mutable_header() = mesh.header(scene_, material_);
  chunk.set_chunk("abc");
  expect_refused(send({}), {"part", "no message", "a header first"});
  expect_refused(send({chunk}), {"part", "no header", "a header first"});
  expect_refused(send({header, header}), {"part", "a second header", "one header"});
  expect_refused(send({header, {}}), {"part", "nothing", "a chunk"});
}

TEST_F(BadRequestTest, RefusesPositionsOfAnotherMesh) {
  const std::string payload(60, '\0');
  v1::PositionsHeader header;
  header.set_name(mesh_.name());
  header.set_vertex_count(5);
  header.set_total_bytes(payload.size());
  header.set_sha256(service::sha256(payload));
  v1::MeshResponse response;
  expect_refused(update_positions(header, payload, &response), {"vertex_count", "5", "the mesh's 4"});
  header.set_name(scene_ + "/meshes/99");
  expect_refused(update_positions(header, payload, &response),
                 {"name", scene_ + "/meshes/99", "existing mesh", grpc::StatusCode::NOT_FOUND});
}

TEST_F(BadRequestTest, RefusesMessagesThatAreTooBigToRead) {
  v1::CreateSceneRequest request;
  request.mutable_scene()->set_display_name(std::string(5 << 20, 'x'));
  Context context;
  v1::Scene response;
  EXPECT_EQ(scenes_->CreateScene(&context, request, &response).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(get_scene(scene_).revision(), 3u);
}

}  // namespace
}  // namespace diaphane::e2e
