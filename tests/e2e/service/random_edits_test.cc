// Ten thousand random edits over streams that break.
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "tests/e2e/service/edit_fixture.h"

namespace diaphane::e2e {
namespace {

constexpr uint64_t kEdits = 10'000;

class RandomEditsTest : public EditTest {
 protected:
  /// Sends what `next` makes, over streams that break in the middle of it, each from the first edit on that is not
  /// known to be applied.
  void send_over_broken_streams(const std::function<v1::SceneChange()>& next) {
    struct Sent {
      uint64_t sequence;
      Changes changes;
    };
    std::vector<Sent> unconfirmed;
    uint64_t sequence = 0;
    while (sequence < kEdits || !unconfirmed.empty()) {
      grpc::ClientContext context;
      const auto stream = open(&context, "random");
      for (const Sent& sent : unconfirmed) send(*stream, sent.sequence, sent.changes);
      const bool last = sequence + 400 >= kEdits;
      for (int i = 0; i < 400 && sequence < kEdits; ++i) {
        unconfirmed.push_back({++sequence, {next()}});
        send(*stream, sequence, unconfirmed.back().changes);
      }
      const uint64_t until = last ? sequence : unconfirmed.front().sequence + random_() % 200;
      v1::EditSceneResponse response;
      uint64_t applied = 0;
      while (applied < until && stream->Read(&response)) applied = response.applied();
      std::erase_if(unconfirmed, [&](const Sent& sent) { return sent.sequence <= applied; });
      if (!last) context.TryCancel();
      const grpc::Status status = end(*stream);
      EXPECT_EQ(status.ok(), last) << status.error_message();
    }
  }

  std::mt19937 random_{5};
};

TEST_F(RandomEditsTest, BothSidesAgreeToTheBit) {
  std::vector<glm::vec3> here = server_positions();
  send_over_broken_streams([&] {
    const uint32_t vertex = random_() % 4;
    const glm::vec3 to(std::uniform_real_distribution<float>(-1, 1)(random_), random_() % 100,
                       1.0f / (1 + random_() % 7));
    here[vertex] = to;
    return moved({vertex}, {to.x, to.y, to.z});
  });
  EXPECT_EQ(server_positions(), here);
}

/// Edits in every form: float32 or 16 bit, plain or compressed, positions or displacements, of some vertices or of all.
class EditForms {
 public:
  EditForms(std::string mesh, std::vector<glm::vec3> rest, std::mt19937& random)
      : mesh_(std::move(mesh)), rest_(std::move(rest)), here_(rest_), within_(rest_.size(), 0), random_(random) {}

  v1::SceneChange next() {
    const auto form = random_();
    const bool quantized = (form & 1) != 0, compressed = (form & 2) != 0, displacements = (form & 4) != 0;
    const bool all = random_() % 50 == 0;
    const size_t count = all ? rest_.size() : 1 + random_() % 60;
    v1::SceneChange change;
    v1::VertexPositions& positions = *change.mutable_positions();
    positions.set_mesh(mesh_);
    positions.set_displacements(displacements);
    if (compressed) positions.set_meshopt_count(static_cast<uint32_t>(count));
    const float side = 1 + 9 * share_(random_);
    std::vector<float> values;
    std::vector<uint16_t> steps;
    for (size_t i = 0; i < count; ++i) {
      const auto vertex = all ? static_cast<uint32_t>(i) : static_cast<uint32_t>(random_() % rest_.size());
      if (!all) positions.add_indices(vertex);
      glm::vec3 to;
      for (int axis = 0; axis < 3; ++axis) {
        to[axis] = side * (share_(random_) - 0.5f);
        values.push_back(to[axis]);
        steps.push_back(static_cast<uint16_t>(std::lround(65535 * (to[axis] / double{side} + 0.5))));
      }
      if (compressed) steps.push_back(0);
      here_[vertex] = displacements ? rest_[vertex] + to : to;
      // Half a step, and the roundings of float32 at ±10.
      within_[vertex] = quantized ? 0.5f * side / 65535 + 2e-6f : 0;
    }
    if (!quantized) {
      positions.set_float32(compressed ? coded(values, count) : bytes_of(values));
      return change;
    }
    for (const auto set : {&v1::Vec3::set_x, &v1::Vec3::set_y, &v1::Vec3::set_z}) {
      (positions.mutable_quantized()->mutable_lowest()->*set)(-0.5f * side);
      (positions.mutable_quantized()->mutable_highest()->*set)(0.5f * side);
    }
    positions.mutable_quantized()->set_uint16(compressed ? coded(steps, count) : bytes_of(steps));
    return change;
  }

  void expect_near(const std::vector<glm::vec3>& found) const {
    ASSERT_EQ(found.size(), here_.size());
    size_t exact = 0;
    for (size_t v = 0; v < here_.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(found[v][axis], here_[v][axis], within_[v]) << v;
      exact += within_[v] == 0;
    }
    // Both kinds are there at the end.
    EXPECT_GT(exact, here_.size() / 10);
    EXPECT_LT(exact, here_.size() * 9 / 10);
  }

 private:
  const std::string mesh_;
  const std::vector<glm::vec3> rest_;
  std::vector<glm::vec3> here_;  // as the client has them
  std::vector<float> within_;    // how near the server's are
  std::mt19937& random_;
  std::uniform_real_distribution<float> share_{0, 1};
};

TEST_F(RandomEditsTest, OfEveryFormBothSidesAgreeToTheBitOrWithinTheStep) {
  // More than a block of the codec's.
  TestMesh data;
  data.triangles.clear();
  for (uint32_t i = 0; i < 600; ++i) {
    for (const uint32_t c : {i % 29, i / 29, i % 7}) data.positions.push_back(0.25f * static_cast<float>(c));
    data.triangles.insert(data.triangles.end(), {i, i + 1, i + 2});
  }
  v1::MeshResponse response;
  ASSERT_TRUE(upload(data.header(scene_, mesh_.material()), data.payload(), &response).ok());
  mesh_ = response.mesh();
  EditForms forms(mesh_.name(), server_positions(), random_);
  send_over_broken_streams([&] { return forms.next(); });
  forms.expect_near(server_positions());
}

}  // namespace
}  // namespace diaphane::e2e
