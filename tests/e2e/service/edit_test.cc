// Live changes of a scene, by gRPC.
#include <gmock/gmock.h>

#include <atomic>
#include <set>
#include <thread>

#include "glm/geometric.hpp"
#include "tests/e2e/service/edit_fixture.h"

namespace diaphane::e2e {
namespace {

TEST_F(EditTest, AppliesEveryKindOfChangeOfAnEditAsOneRevision) {
  v1::SceneChange material;
  material.mutable_material()->mutable_material()->set_name(mesh_.material());
  material.mutable_material()->mutable_material()->set_preset("skin1");
  material.mutable_material()->mutable_update_mask()->add_paths("preset");
  v1::SceneChange placed;
  placed.mutable_mesh()->mutable_mesh()->set_name(mesh_.name());
  for (int i = 0; i < 16; ++i)
    placed.mutable_mesh()->mutable_mesh()->add_scene_from_mesh(i % 5 == 0 ? (i < 15 ? 2 : 1) : 0);
  placed.mutable_mesh()->mutable_update_mask()->add_paths("scene_from_mesh");
  const uint64_t before = get_scene(scene_).revision();
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 40, {moved({2}, {7, 8, 9}), material, placed});
  EXPECT_EQ(wait_for(*stream, 40), before + 1);
  EXPECT_EQ(server_positions()[2], glm::vec3(7, 8, 9));
  const auto mesh = server_->scenes().mesh({"mesh", mesh_.name()});
  EXPECT_EQ(mesh->scene_from_mesh[0][0], 2);
  EXPECT_EQ(mesh->positions_revision, before + 1);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditTest, TakesPositionsInStepsOfABox) {
  v1::SceneChange change;
  v1::VertexPositions& positions = *change.mutable_positions();
  positions.set_mesh(mesh_.name());
  positions.mutable_quantized()->mutable_lowest()->set_x(-3);
  positions.mutable_quantized()->mutable_highest()->set_x(5);
  positions.mutable_quantized()->mutable_highest()->set_y(1);
  positions.mutable_quantized()->set_uint16(
      bytes_of(std::vector<uint16_t>{0, 0, 0, 65535, 65535, 65535, 32768, 0, 1, 1, 1, 1}));
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {change});
  wait_for(*stream, 1);
  const std::vector<glm::vec3> found = server_positions();
  EXPECT_EQ(found[0], glm::vec3(-3, 0, 0));
  EXPECT_EQ(found[1], glm::vec3(5, 1, 0));
  EXPECT_NEAR(found[2].x, 1, 8.0 / 65535);
  EXPECT_FLOAT_EQ(found[3].y, 1.0f / 65535);
  EXPECT_TRUE(end(*stream).ok());
}

/// All positions of a mesh through the codec.
v1::SceneChange compressed(const std::string& mesh, const std::vector<float>& positions) {
  v1::SceneChange change;
  const size_t count = positions.size() / 3;
  change.mutable_positions()->set_mesh(mesh);
  change.mutable_positions()->set_float32(coded(positions, count));
  change.mutable_positions()->set_meshopt_count(static_cast<uint32_t>(count));
  return change;
}

TEST_F(EditTest, DecodesWhatIsCompressedAndRefusesWhatIsNot) {
  const std::vector<float> to{1, 2, 3, 4, 5, 6, 7, 8, 9, 0.1f, 0.2f, 0.3f};
  {
    grpc::ClientContext context;
    const auto stream = open(&context);
    send(*stream, 1, {compressed(mesh_.name(), to)});
    wait_for(*stream, 1);
    EXPECT_TRUE(end(*stream).ok());
  }
  EXPECT_EQ(server_positions()[3], glm::vec3(0.1f, 0.2f, 0.3f));
  v1::SceneChange change = compressed(mesh_.name(), to);
  change.mutable_positions()->set_meshopt_count(4'000'000'000u);
  expect_refused({change}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions.meshopt_count");
  change = compressed(mesh_.name(), to);
  change.mutable_positions()->set_meshopt_count(5);
  expect_refused({change}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions");
  change = compressed(mesh_.name(), to);
  change.mutable_positions()->mutable_float32()->resize(20);
  expect_refused({change}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions.float32");
  change = compressed(mesh_.name(), to);
  change.mutable_positions()->add_indices(0);
  expect_refused({change}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions.meshopt_count");
  EXPECT_EQ(server_positions()[0], glm::vec3(1, 2, 3));
}

TEST_F(EditTest, TakesTheMemoryOfWhatItDecodesFromTheBudget) {
  start({.scene = {.max_mesh_bytes = 1 << 20}});
  scene_ = create_scene().name();
  mesh_ = create_mesh(scene_);
  const v1::SceneChange right = moved({0}, {1, 1, 1});
  const v1::SceneChange small = compressed(mesh_.name(), std::vector<float>(3 * 50'000));
  const v1::SceneChange large = compressed(mesh_.name(), std::vector<float>(3 * 100'000));
  EXPECT_LT(large.positions().float32().size(), 1u << 15);
  expect_refused({right, small}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].positions");
  expect_refused({right, large}, grpc::StatusCode::RESOURCE_EXHAUSTED, "mesh_bytes");
  expect_refused({right, small, small}, grpc::StatusCode::RESOURCE_EXHAUSTED, "mesh_bytes");
  EXPECT_EQ(server_positions()[0], glm::vec3(0));
}

TEST_F(EditTest, DisplacementsAreFromTheUploadedPositionsHoweverOftenTheyCome) {
  v1::SceneChange change = moved({1}, {10, 0, 0.5f});
  change.mutable_positions()->set_displacements(true);
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {moved({}, std::vector<float>(12, 9))});
  send(*stream, 2, {change});
  send(*stream, 3, {change});
  wait_for(*stream, 3);
  EXPECT_EQ(server_positions()[0], glm::vec3(9));
  EXPECT_EQ(server_positions()[1], glm::vec3(11, 0, 0.5f));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditTest, WeightsDriveTheMorphTargetsOfAMesh) {
  TestMesh data;
  data.morph_targets = {std::vector<float>(12, 1), std::vector<float>(12, 0)};
  data.morph_targets[1][3] = 8;  // x of vertex 1
  v1::MeshResponse response;
  ASSERT_TRUE(upload(data.header(scene_, mesh_.material()), data.payload(), &response).ok());
  mesh_ = response.mesh();
  EXPECT_EQ(mesh_.morph_target_count(), 2u);
  const auto weighted = [&](std::initializer_list<float> weights) {
    v1::SceneChange change;
    change.mutable_weights()->set_mesh(mesh_.name());
    for (const float weight : weights) change.mutable_weights()->add_weights(weight);
    return change;
  };
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {moved({0}, {5, 5, 5}), weighted({2, 0.5f})});
  wait_for(*stream, 1);
  EXPECT_EQ(server_positions()[0], glm::vec3(2));
  EXPECT_EQ(server_positions()[1], glm::vec3(7, 2, 2));
  EXPECT_TRUE(end(*stream).ok());
  expect_refused({weighted({1})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].weights.weights");
  expect_refused({weighted({1, NAN})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].weights.weights[1]");
  expect_refused({weighted({1, 2e6f})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].weights.weights[1]");
  mesh_ = create_mesh(scene_);
  expect_refused({weighted({})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].weights.mesh");
  mesh_.set_name(scene_ + "/meshes/99");
  expect_refused({weighted({})}, grpc::StatusCode::NOT_FOUND, "changes[0].weights.mesh");
}

TEST_F(EditTest, RefusesMorphTargetsThatAreTooManyOrNotFinite) {
  TestMesh data;
  data.morph_targets = {std::vector<float>(12, INFINITY)};
  v1::MeshResponse response;
  const grpc::Status infinite = upload(data.header(scene_, mesh_.material()), data.payload(), &response);
  EXPECT_EQ(error_info(infinite).metadata().at("field"), "morph_targets[0].x");
  data.morph_targets.assign(257, std::vector<float>(12, 0));
  const grpc::Status many = upload(data.header(scene_, mesh_.material()), data.payload(), &response);
  EXPECT_EQ(many.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(error_info(many).metadata().at("field"), "morph_target_count");
}

TEST_F(EditTest, MorphsToTheBoundingSphereAndBack) {
  const std::vector<glm::vec3> rest = server_positions();
  const auto morphed = [&](float amount) {
    v1::SceneChange change;
    change.mutable_sphere()->set_mesh(mesh_.name());
    change.mutable_sphere()->set_amount(amount);
    return change;
  };
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {morphed(1)});
  wait_for(*stream, 1);
  for (const glm::vec3& p : server_positions()) EXPECT_NEAR(glm::distance(p, glm::vec3(0.5f)), std::sqrt(0.75f), 1e-6);
  send(*stream, 2, {morphed(0)});
  wait_for(*stream, 2);
  EXPECT_EQ(server_positions(), rest);
  EXPECT_TRUE(end(*stream).ok());
  expect_refused({morphed(1.5f)}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].sphere.amount");
}

TEST_F(EditTest, RefusesWhatLeadsBeyondTheLargestCoordinate) {
  TestMesh data;
  // The sphere's radius over the last vertex's way from the middle is no float.
  data.positions = {-1e18f, 0, 0, 1e18f, 0, 0, 0, 1e-21f, 0, 0, 0, 0};
  data.morph_targets = {std::vector<float>(12, 1e18f)};
  v1::MeshResponse response;
  ASSERT_TRUE(upload(data.header(scene_, mesh_.material()), data.payload(), &response).ok());
  mesh_ = response.mesh();
  const std::vector<glm::vec3> rest = server_positions();
  const v1::SceneChange right = moved({0}, {1, 1, 1});
  v1::SceneChange some = moved({2, 1}, {0, 0, 0, 1e18f, 0, 0});
  some.mutable_positions()->set_displacements(true);
  expect_refused({right, some}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].positions");
  v1::SceneChange all = moved({}, std::vector<float>(12, 1e18f));
  all.mutable_positions()->set_displacements(true);
  expect_refused({right, all}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].positions");
  v1::SceneChange sphere;
  sphere.mutable_sphere()->set_mesh(mesh_.name());
  sphere.mutable_sphere()->set_amount(1);
  expect_refused({right, sphere}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].sphere");
  v1::SceneChange weights;
  weights.mutable_weights()->set_mesh(mesh_.name());
  weights.mutable_weights()->add_weights(1e6f);
  expect_refused({right, weights}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].weights");
  EXPECT_EQ(server_positions(), rest);
}

TEST_F(EditTest, RefusesAWholeEditForOneWrongChangeAndNamesIt) {
  const v1::SceneChange right = moved({0}, {1, 1, 1});
  expect_refused({right, moved({4}, {0, 0, 0})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].positions.indices[0]");
  expect_refused({right, moved({0}, {0, 0, NAN})}, grpc::StatusCode::INVALID_ARGUMENT,
                 "changes[1].positions.float32[0].z");
  expect_refused({moved({0, 1}, {0, 0, 0})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions.float32");
  expect_refused({moved({}, {0, 0, 0})}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].positions");
  v1::SceneChange elsewhere = right;
  elsewhere.mutable_positions()->set_mesh(scene_ + "/meshes/99");
  expect_refused({right, elsewhere}, grpc::StatusCode::NOT_FOUND, "changes[1].positions.mesh");
  v1::SceneChange material;
  material.mutable_material()->mutable_material()->set_name(mesh_.material());
  material.mutable_material()->mutable_material()->set_preset("mud");
  material.mutable_material()->mutable_update_mask()->add_paths("preset");
  expect_refused({right, material}, grpc::StatusCode::INVALID_ARGUMENT, "changes[1].material.preset");
  expect_refused({}, grpc::StatusCode::INVALID_ARGUMENT, "changes");
  expect_refused({v1::SceneChange()}, grpc::StatusCode::INVALID_ARGUMENT, "changes[0].change");
  EXPECT_EQ(server_positions()[0], glm::vec3(0));
}

TEST_F(EditTest, NothingOfAStreamIsAppliedOnceAnotherTookItsPlace) {
  // A client whose connection broke comes back before the server has noticed, and while it is busy with the old edits.
  grpc::ClientContext broken, unbroken;
  const auto old_stream = open(&broken, "an editor");
  std::atomic<bool> is_open{true};
  std::thread old_edits([&] {
    for (uint64_t i = 1; is_open; ++i) is_open = send(*old_stream, i, {moved({0}, {1, 1, 1})});
  });
  v1::EditSceneResponse response;
  ASSERT_TRUE(old_stream->Read(&response));
  const auto stream = open(&unbroken, "an editor");
  constexpr uint64_t kEdits = 500;
  for (uint64_t i = 1; i <= kEdits; ++i) send(*stream, i, {moved({0}, {2, 2, 2})});
  std::set<uint64_t> revisions_before;
  while (response.applied() != kEdits || revisions_before.empty()) {
    ASSERT_TRUE(stream->Read(&response));
    revisions_before.insert(response.scene_revision() - response.applied());
  }
  EXPECT_THAT(revisions_before, ::testing::SizeIs(1));
  old_edits.join();
  EXPECT_EQ(end(*old_stream).error_code(), grpc::StatusCode::ABORTED);
  EXPECT_EQ(get_scene(scene_).revision(), response.scene_revision());
  EXPECT_EQ(server_positions()[0], glm::vec3(2));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditTest, StreamsOfSeveralEditorsGoOnBesideEachOther) {
  grpc::ClientContext contexts[4];
  std::vector<std::unique_ptr<Stream>> streams;
  for (const char* editor : {"", "", "a", "b"}) streams.push_back(open(&contexts[streams.size()], editor));
  for (uint64_t i = 1; i <= 20; ++i) {
    for (const auto& stream : streams) {
      send(*stream, i, {moved({0}, {float(i), 0, 0})});
      wait_for(*stream, i);
    }
  }
  for (const auto& stream : streams) EXPECT_TRUE(end(*stream).ok());
  grpc::ClientContext context;
  EXPECT_EQ(error_info(end(*open(&context, std::string(65, 'a')))).metadata().at("field"), "opening.editor_id");
}

TEST_F(EditTest, RefusesSequencesThatDoNotFollowAndStreamsWithoutAnOpening) {
  {
    grpc::ClientContext context;
    const auto stream = open(&context);
    send(*stream, 3, {moved({0}, {1, 1, 1})});
    send(*stream, 5, {moved({0}, {2, 2, 2})});
    const grpc::Status status = end(*stream);
    EXPECT_EQ(error_info(status).metadata().at("field"), "edit.sequence");
    EXPECT_EQ(server_positions()[0], glm::vec3(1));
  }
  grpc::ClientContext context;
  const auto stream = scenes_->EditScene(&context);
  send(*stream, 1, {moved({0}, {1, 1, 1})});
  EXPECT_EQ(error_info(end(*stream)).metadata().at("field"), "part");
}

TEST_F(EditTest, TellsWhatIsAppliedBeforeTheErrorThatEndsIt) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  for (uint64_t i = 1; i <= 10; ++i) send(*stream, i, {moved({0}, {float(i), 0, 0})});
  send(*stream, 11, {moved({9}, {0, 0, 0})});
  v1::EditSceneResponse response;
  uint64_t applied = 0;
  while (stream->Read(&response)) applied = response.applied();
  EXPECT_EQ(applied, 10u);
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(server_positions()[0], glm::vec3(10, 0, 0));
}

}  // namespace
}  // namespace diaphane::e2e
