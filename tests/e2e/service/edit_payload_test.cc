// Edits whose positions follow them.
#include <gmock/gmock.h>

#include "tests/e2e/service/edit_fixture.h"

namespace diaphane::e2e {
namespace {

class EditPayloadTest : public EditTest {
 protected:
  /// A change of the tetrahedron's positions that come later.
  v1::SceneChange announced(uint64_t payload_bytes) const {
    v1::SceneChange change;
    change.mutable_positions()->set_mesh(mesh_.name());
    change.mutable_positions()->mutable_float32();
    change.mutable_positions()->set_payload_bytes(payload_bytes);
    return change;
  }

  static bool send_payload(Stream& stream, const std::string& bytes) {
    v1::EditSceneRequest request;
    request.set_payload(bytes);
    return stream.Write(request);
  }

  /// Sends an edit and what follows it, which must be refused, and leave the scene as it is.
  void expect_payload_refused(const Changes& changes, const std::vector<std::string>& payloads,
                              const std::string& field) {
    const uint64_t before = get_scene(scene_).revision();
    grpc::ClientContext context;
    const auto stream = open(&context);
    send(*stream, 1, changes);
    for (const std::string& payload : payloads) send_payload(*stream, payload);
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field) << status.error_message();
    EXPECT_EQ(get_scene(scene_).revision(), before);
  }
};

TEST_F(EditPayloadTest, IsAppliedWithItsLastBytesAndNotBefore) {
  const std::vector<float> first = {1, 2, 3, 4, 5, 6}, second = {7, 8, 9, 10, 11, 12};
  v1::SceneChange quantized = announced(12);
  v1::VertexPositions& steps = *quantized.mutable_positions();
  steps.mutable_quantized()->mutable_highest()->set_x(65535);
  steps.add_indices(3);
  steps.add_indices(0);
  const uint64_t before = get_scene(scene_).revision();
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 5, {announced(48), moved({1}, {50, 60, 70}), quantized});
  send_payload(*stream, bytes_of(first));
  send_payload(*stream, bytes_of(second));
  send_payload(*stream, bytes_of(std::vector<uint16_t>{300, 0, 0}));
  EXPECT_EQ(get_scene(scene_).revision(), before);
  send_payload(*stream, bytes_of(std::vector<uint16_t>{200, 0, 0}));
  EXPECT_EQ(wait_for(*stream, 5), before + 1);
  EXPECT_THAT(server_positions(), ::testing::ElementsAre(glm::vec3(200, 0, 0), glm::vec3(50, 60, 70),
                                                         glm::vec3(7, 8, 9), glm::vec3(300, 0, 0)));
  send(*stream, 6, {moved({0}, {1, 1, 1})});
  EXPECT_EQ(wait_for(*stream, 6), before + 2);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditPayloadTest, OfTheCodecMayBreakAnywhere) {
  const std::vector<float> positions = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string bytes = coded(positions, 4);
  v1::SceneChange change = announced(bytes.size());
  change.mutable_positions()->set_meshopt_count(4);
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {change});
  for (size_t at = 0; at < bytes.size(); at += 7) send_payload(*stream, bytes.substr(at, 7));
  wait_for(*stream, 1);
  EXPECT_EQ(server_positions()[3], glm::vec3(10, 11, 12));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditPayloadTest, IsRefusedWhereItIsNotWhatWasSaid) {
  const std::string whole(48, '\0'), half(24, '\0');
  expect_payload_refused({announced(48)}, {half, whole}, "changes[0].payload");
  expect_payload_refused({announced(48)}, {half.substr(1)}, "changes[0].payload");
  expect_payload_refused({announced(48)}, {half, ""}, "changes[0].payload");
  expect_payload_refused({announced(24), announced(24)}, {whole}, "changes[0].payload");
  expect_payload_refused({announced(47)}, {}, "changes[0].positions.payload_bytes");
  expect_payload_refused({announced(24)}, {half}, "changes[0].positions");
  expect_payload_refused({announced(uint64_t{12} << 18)}, {std::string((1 << 20) + 12, '\0')}, "payload");
  v1::SceneChange both = moved({}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  both.mutable_positions()->set_payload_bytes(48);
  expect_payload_refused({both}, {whole}, "changes[0].positions.payload_bytes");
  v1::SceneChange indexed = announced(24);
  indexed.mutable_positions()->add_indices(1);
  expect_payload_refused({indexed}, {half}, "changes[0].positions.payload_bytes");
  expect_payload_refused({announced(48)}, {half, bytes_of(std::vector<float>{1, 2, 3, 4, NAN, 6})},
                         "changes[0].positions.float32[3].y");
}

TEST_F(EditPayloadTest, ComesBeforeAnythingElseAndOnlyWhereItWasAnnounced) {
  {
    grpc::ClientContext context;
    const auto stream = open(&context);
    send_payload(*stream, "123456789012");
    const grpc::Status status = end(*stream);
    EXPECT_EQ(error_info(status).metadata().at("field"), "part") << status.error_message();
  }
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {announced(48)});
  send_payload(*stream, std::string(12, '\0'));
  send(*stream, 2, {moved({0}, {1, 1, 1})});
  const grpc::Status status = end(*stream);
  EXPECT_EQ(error_info(status).metadata().at("field"), "part");
  EXPECT_THAT(status.error_message(), ::testing::HasSubstr("36 more bytes"));
}

TEST_F(EditPayloadTest, OfMoreThanThereIsMemoryForIsRefusedBeforeItIsAllocated) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {announced(uint64_t{12} << 50)});
  EXPECT_EQ(end(*stream).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

}  // namespace
}  // namespace diaphane::e2e
