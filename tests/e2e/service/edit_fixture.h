// Streams of edits for tests.
#pragma once

#include "meshoptimizer.h"
#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {

using Stream = grpc::ClientReaderWriter<v1::EditSceneRequest, v1::EditSceneResponse>;
using Changes = std::vector<v1::SceneChange>;

/// `values` as they lie.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// `values` through meshoptimizer's codec, as so many elements.
template <typename T>
std::string coded(const std::vector<T>& values, size_t count) {
  const size_t each = values.size() * sizeof(T) / count;
  std::string bytes(meshopt_encodeVertexBufferBound(count, each), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), values.data(),
                                          count, each));
  return bytes;
}

/// A scene with a tetrahedron, and streams of edits to it.
class EditTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    scene_ = create_scene().name();
    mesh_ = create_mesh(scene_);
  }

  std::unique_ptr<Stream> open(grpc::ClientContext* context, const std::string& editor_id = "") {
    auto stream = scenes_->EditScene(context);
    v1::EditSceneRequest request;
    request.mutable_opening()->set_scene(scene_);
    request.mutable_opening()->set_editor_id(editor_id);
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

}  // namespace diaphane::e2e
