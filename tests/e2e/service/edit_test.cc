// Live changes of a scene, by gRPC.
#include <gmock/gmock.h>

#include <random>

#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using Stream = grpc::ClientReaderWriter<v1::EditSceneRequest, v1::EditSceneResponse>;
using Changes = std::vector<v1::SceneChange>;

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

class EditTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    mesh_ = create_mesh(scene_);
  }

  std::unique_ptr<Stream> open(grpc::ClientContext* context) {
    auto stream = scenes_->EditScene(context);
    v1::EditSceneRequest request;
    request.mutable_opening()->set_scene(scene_);
    stream->Write(request);
    return stream;
  }

  static bool send(Stream& stream, uint64_t sequence, const Changes& changes) {
    v1::EditSceneRequest request;
    request.mutable_edit()->set_sequence(sequence);
    for (const v1::SceneChange& change : changes) *request.mutable_edit()->add_changes() = change;
    return stream.Write(request);
  }

  /// Reads until `sequence` is applied; the scene's revision then.
  static uint64_t wait_for(Stream& stream, uint64_t sequence) {
    v1::EditSceneResponse response;
    while (stream.Read(&response)) {
      if (response.applied() == sequence) return response.scene_revision();
    }
    ADD_FAILURE() << "the stream ended before " << sequence;
    return 0;
  }

  static grpc::Status end(Stream& stream) {
    stream.WritesDone();
    v1::EditSceneResponse response;
    while (stream.Read(&response)) {
    }
    return stream.Finish();
  }

  v1::SceneChange moved(const std::vector<uint32_t>& indices, const std::vector<float>& positions) const {
    v1::SceneChange change;
    change.mutable_positions()->set_mesh(mesh_.name());
    change.mutable_positions()->mutable_indices()->Add(indices.begin(), indices.end());
    change.mutable_positions()->set_float32(bytes_of(positions));
    return change;
  }

  std::vector<glm::vec3> server_positions() {
    const auto mesh = server_->scenes().mesh({"mesh", mesh_.name()});
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh->shape->positions;
  }

  /// Sends one edit on a stream of its own, which must refuse it, and leave the scene as it is.
  void expect_refused(const Changes& changes, grpc::StatusCode code, const std::string& field) {
    const uint64_t before = get_scene(scene_).revision();
    grpc::ClientContext context;
    const auto stream = open(&context);
    send(*stream, 1, changes);
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field);
    EXPECT_EQ(get_scene(scene_).revision(), before);
  }

  std::string scene_;
  v1::Mesh mesh_;
};

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

TEST_F(EditTest, AfterRandomSparseEditsAndBrokenStreamsBothSidesAgreeToTheBit) {
  std::mt19937 random(5);
  std::vector<glm::vec3> here = server_positions();
  struct Sent {
    uint64_t sequence;
    Changes changes;
  };
  std::vector<Sent> unconfirmed;
  uint64_t sequence = 0;
  constexpr uint64_t kEdits = 10'000;
  while (sequence < kEdits || !unconfirmed.empty()) {
    grpc::ClientContext context;
    const auto stream = open(&context);
    for (const Sent& sent : unconfirmed) send(*stream, sent.sequence, sent.changes);
    const bool last = sequence + 400 >= kEdits;
    for (int i = 0; i < 400 && sequence < kEdits; ++i) {
      const uint32_t vertex = random() % 4;
      const glm::vec3 to(std::uniform_real_distribution<float>(-1, 1)(random), random() % 100,
                         1.0f / (1 + random() % 7));
      here[vertex] = to;
      unconfirmed.push_back({++sequence, {moved({vertex}, {to.x, to.y, to.z})}});
      send(*stream, sequence, unconfirmed.back().changes);
    }
    // All but the last stream break in the middle of what they sent.
    const uint64_t until = last ? sequence : unconfirmed.front().sequence + random() % 200;
    v1::EditSceneResponse response;
    uint64_t applied = 0;
    while (applied < until && stream->Read(&response)) applied = response.applied();
    std::erase_if(unconfirmed, [&](const Sent& sent) { return sent.sequence <= applied; });
    if (!last) context.TryCancel();
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.ok(), last) << status.error_message();
  }
  EXPECT_EQ(server_positions(), here);
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
