// Edits whose positions lie in memory that the server shares.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "service/shared_buffers.h"
#include "tests/e2e/service/edit_fixture.h"

namespace diaphane::e2e {
namespace {

/// What a client makes of an offer.
class Mapped {
 public:
  explicit Mapped(const v1::SharedMemory& offer) : size_(offer.bytes()) {
    const std::string path =
        "/proc/" + std::to_string(offer.process_id()) + "/fd/" + std::to_string(offer.file_descriptor());
    file_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    bytes_ = static_cast<char*>(mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0));
  }
  ~Mapped() {
    munmap(bytes_, size_);
    close(file_);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;

  bool is_open() const { return file_ >= 0 && bytes_ != MAP_FAILED; }
  int file() const { return file_; }
  std::string nonce() const { return {bytes_, 16}; }

  template <typename T>
  void put(size_t offset, const std::vector<T>& values) {
    std::memcpy(bytes_ + offset, values.data(), values.size() * sizeof(T));
  }

 private:
  size_t size_;
  int file_ = -1;
  char* bytes_ = nullptr;
};

class SharedEditTest : public EditTest {
 protected:
  static void ask(Stream& stream, uint64_t bytes) {
    v1::EditSceneRequest request;
    request.set_shared_memory_bytes(bytes);
    stream.Write(request);
  }

  /// What the server shares when asked.
  static v1::SharedMemory offered(Stream& stream, uint64_t bytes) {
    ask(stream, bytes);
    v1::EditSceneResponse response;
    EXPECT_TRUE(stream.Read(&response) && response.has_shared_memory());
    return response.shared_memory();
  }

  /// Whether the server shares any before it applies edit `sequence`.
  bool is_offered(Stream& stream, uint64_t bytes, uint64_t sequence) const {
    ask(stream, bytes);
    send(stream, sequence, {moved({0}, {1, 1, 1})});
    bool found = false;
    v1::EditSceneResponse response;
    while (response.applied() < sequence && stream.Read(&response)) found |= response.has_shared_memory();
    return found;
  }

  /// A change of the tetrahedron's positions, which lie there.
  v1::SceneChange lying(uint32_t memory, uint64_t offset, uint64_t bytes) const {
    v1::SceneChange change;
    change.mutable_positions()->set_mesh(mesh_.name());
    change.mutable_positions()->mutable_float32();
    change.mutable_positions()->mutable_shared()->set_memory(memory);
    change.mutable_positions()->mutable_shared()->set_offset(offset);
    change.mutable_positions()->mutable_shared()->set_bytes(bytes);
    return change;
  }

  /// Sends a change on a stream that shares 4096 bytes, which must be refused.
  void expect_shared_refused(const v1::SceneChange& change, const std::string& field) {
    const uint64_t before = get_scene(scene_).revision();
    grpc::ClientContext context;
    const auto stream = open(&context);
    const Mapped mapped(offered(*stream, 4096));
    ASSERT_TRUE(mapped.is_open());
    send(*stream, 1, {change});
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field) << status.error_message();
    EXPECT_EQ(get_scene(scene_).revision(), before);
  }
};

const std::vector<float> kTwelve = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

TEST_F(SharedEditTest, IsReadWhereItLies) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  const v1::SharedMemory offer = offered(*stream, 1000);
  Mapped mapped(offer);
  ASSERT_TRUE(mapped.is_open());
  EXPECT_EQ(mapped.nonce(), offer.nonce());
  EXPECT_GE(offer.bytes(), 1000u);
  mapped.put(64, kTwelve);
  send(*stream, 1, {lying(offer.id(), 64, 48)});
  wait_for(*stream, 1);
  EXPECT_THAT(server_positions(), ::testing::ElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6), glm::vec3(7, 8, 9),
                                                         glm::vec3(10, 11, 12)));
  // Steps of one, of two vertices.
  v1::SceneChange steps = lying(offer.id(), 200, 12);
  steps.mutable_positions()->mutable_quantized()->mutable_highest()->set_x(65535);
  steps.mutable_positions()->add_indices(2);
  steps.mutable_positions()->add_indices(0);
  mapped.put(200, std::vector<uint16_t>{300, 0, 0, 400, 0, 0});
  send(*stream, 2, {steps});
  wait_for(*stream, 2);
  EXPECT_THAT(server_positions(), ::testing::ElementsAre(glm::vec3(400, 0, 0), glm::vec3(4, 5, 6), glm::vec3(300, 0, 0),
                                                         glm::vec3(10, 11, 12)));
  const std::string bytes = coded(kTwelve, 4);
  v1::SceneChange compressed = lying(offer.id(), 300, bytes.size());
  compressed.mutable_positions()->set_meshopt_count(4);
  mapped.put(300, std::vector<char>(bytes.begin(), bytes.end()));
  send(*stream, 3, {compressed});
  wait_for(*stream, 3);
  EXPECT_EQ(server_positions()[2], glm::vec3(7, 8, 9));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(SharedEditTest, GoesBesideOneThatFollows) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  const v1::SharedMemory offer = offered(*stream, 1000);
  Mapped mapped(offer);
  ASSERT_TRUE(mapped.is_open());
  mapped.put(64, kTwelve);
  v1::SceneChange follows = moved({1}, {});
  follows.mutable_positions()->set_payload_bytes(12);
  send(*stream, 1, {lying(offer.id(), 64, 48), follows});
  v1::EditSceneRequest payload;
  payload.set_payload(bytes_of(std::vector<float>{70, 80, 90}));
  stream->Write(payload);
  wait_for(*stream, 1);
  EXPECT_EQ(server_positions()[1], glm::vec3(70, 80, 90));
  EXPECT_EQ(server_positions()[3], glm::vec3(10, 11, 12));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(SharedEditTest, IsRefusedWhereItDoesNotLieInTheMemory) {
  const uint64_t size = 4096 + 16;
  expect_shared_refused(lying(1, 64, 48), "changes[0].positions.shared.memory");
  expect_shared_refused(lying(0, size + 4, 48), "changes[0].positions.shared.offset");
  expect_shared_refused(lying(0, UINT64_MAX - 3, 48), "changes[0].positions.shared.offset");
  expect_shared_refused(lying(0, 66, 48), "changes[0].positions.shared.offset");
  expect_shared_refused(lying(0, size - 36, 48), "changes[0].positions.shared.bytes");
  expect_shared_refused(lying(0, 64, 0), "changes[0].positions.shared.bytes");
  expect_shared_refused(lying(0, 64, 47), "changes[0].positions.shared.bytes");
  v1::SceneChange both = lying(0, 64, 48);
  both.mutable_positions()->set_float32(bytes_of(kTwelve));
  expect_shared_refused(both, "changes[0].positions.shared");
  v1::SceneChange follows = lying(0, 64, 48);
  follows.mutable_positions()->set_payload_bytes(48);
  expect_shared_refused(follows, "changes[0].positions.payload_bytes");
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {lying(0, 64, uint64_t{12} << 50)});
  EXPECT_EQ(end(*stream).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(SharedEditTest, IsCheckedAsItWasReadHoweverItIsWrittenMeanwhile) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  const v1::SharedMemory offer = offered(*stream, 1000);
  Mapped mapped(offer);
  ASSERT_TRUE(mapped.is_open());
  std::atomic<bool> done = false;
  std::thread writer([&] {
    const std::vector<float> wrong(12, NAN);
    while (!done) {
      mapped.put(64, wrong);
      mapped.put(64, kTwelve);
    }
  });
  grpc::Status status;
  for (uint64_t sequence = 1; sequence <= 300; ++sequence) {
    if (!send(*stream, sequence, {lying(offer.id(), 64, 48)})) break;
  }
  status = end(*stream);
  done = true;
  writer.join();
  if (!status.ok()) {
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_THAT(error_info(status).metadata().at("field"), ::testing::StartsWith("changes[0].positions.float32["));
  }
  for (const glm::vec3& p : server_positions()) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
}

TEST_F(SharedEditTest, MemoryCannotBeMadeShorterUnderTheServer) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  const v1::SharedMemory offer = offered(*stream, 1 << 20);
  const Mapped mapped(offer);
  ASSERT_TRUE(mapped.is_open());
  EXPECT_NE(ftruncate(mapped.file(), 0), 0);
  EXPECT_NE(ftruncate(mapped.file(), 2 << 20), 0);
  EXPECT_NE(fallocate(mapped.file(), FALLOC_FL_COLLAPSE_RANGE, 0, 1 << 16), 0);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(SharedEditTest, MemoryIsGivenInBounds) {
  for (const uint64_t bytes : {uint64_t{0}, (uint64_t{64} << 20) + 1, UINT64_MAX}) {
    grpc::ClientContext context;
    const auto stream = open(&context);
    ask(*stream, bytes);
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), "shared_memory_bytes");
  }
  // Eight of a stream; a ninth has no answer, and harms nobody.
  grpc::ClientContext context;
  const auto stream = open(&context);
  for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(offered(*stream, 100).id(), i);
  ask(*stream, 100);
  send(*stream, 1, {moved({0}, {1, 1, 1})});
  EXPECT_GT(wait_for(*stream, 1), 0u);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(SharedEditTest, MemoryIsThatOfAllMeshesAndComesBack) {
  service::ServiceLimits limits;
  limits.scene.max_mesh_bytes = 40 << 20;
  start(limits);
  scene_ = create_scene().name();
  mesh_ = create_mesh(scene_);
  for (int round = 0; round < 3; ++round) {
    grpc::ClientContext context;
    const auto stream = open(&context);
    uint64_t sequence = 0;
    // The stream before may have been told of its end before it gave back what it had.
    while (!is_offered(*stream, 30 << 20, ++sequence)) {
      ASSERT_LT(sequence, 500u);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(is_offered(*stream, 30 << 20, ++sequence));
    EXPECT_TRUE(end(*stream).ok());
  }
}

TEST_F(SharedEditTest, MemoryIsNotAskedForInTheMiddleOfAnEdit) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  v1::SceneChange follows = moved({1}, {});
  follows.mutable_positions()->set_payload_bytes(12);
  send(*stream, 1, {follows});
  ask(*stream, 100);
  const grpc::Status status = end(*stream);
  EXPECT_EQ(error_info(status).metadata().at("field"), "part") << status.error_message();
}

TEST_F(SharedEditTest, MemoryIsGivenOverLoopbackOfTheSixthVersionToo) {
  auto server = app::Server::start({.listen = "[::1]:0"}, fakes::fake_renderers(control_));
  if (!server.ok()) GTEST_SKIP() << "no such loopback here: " << server.status();
  server_ = *std::move(server);
  scenes_ = v1::SceneService::NewStub(grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials()));
  scene_ = create_scene().name();
  grpc::ClientContext context;
  const auto stream = open(&context);
  EXPECT_TRUE(Mapped(offered(*stream, 1000)).is_open());
  EXPECT_TRUE(end(*stream).ok());
}

TEST(IsOnThisMachine, IsWhatSpeaksOverASocketFileOrLoopback) {
  for (const char* peer :
       {"unix:", "unix:/run/diaphane", "ipv4:127.0.0.1:2011", "ipv4:127.1.2.3:1", "ipv6:%5B::1%5D:7"}) {
    EXPECT_TRUE(service::is_on_this_machine(peer)) << peer;
  }
  for (const char* peer : {"", "ipv4:10.0.0.1:7", "ipv4:12.7.0.1:7", "ipv6:%5B2001:db8::1%5D:7", "ipv6:%5B::%5D:7"}) {
    EXPECT_FALSE(service::is_on_this_machine(peer)) << peer;
  }
}

}  // namespace
}  // namespace diaphane::e2e
