// Health and reflection, as load balancers and command-line tools use them.
#include <gmock/gmock.h>

#include "tests/e2e/service/raw_call.h"
#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

using ::testing::HasSubstr;

constexpr char kCheck[] = "/grpc.health.v1.Health/Check";
constexpr char kWatch[] = "/grpc.health.v1.Health/Watch";
constexpr char kReflect[] = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

// HealthCheckResponse: field 1, an enum.
constexpr char kServing[] = "\x08\x01";

// HealthCheckRequest: field 1, a string.
std::string health_of(const std::string& service) {
  return "\x0a" + std::string(1, static_cast<char>(service.size())) + service;
}

class ProtocolsTest : public ServiceTest {
 protected:
  std::shared_ptr<grpc::Channel> channel() {
    return grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
  }
};

TEST_F(ProtocolsTest, HealthSaysThatItServes) {
  for (const char* service :
       {"", "diaphane.v1.SceneService", "diaphane.v1.RenderService", "diaphane.v1.ServerService"}) {
    RawCall call(channel(), kCheck, health_of(service));
    EXPECT_EQ(call.first_answer(), kServing) << service;
    EXPECT_TRUE(call.status().ok()) << call.status().error_message();
  }
}

TEST_F(ProtocolsTest, HealthDoesNotKnowOtherServices) {
  RawCall call(channel(), kCheck, health_of("diaphane.v1.Nothing"));
  EXPECT_EQ(call.status().error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(ProtocolsTest, ReflectionListsTheServices) {
  // ServerReflectionRequest: field 7, list_services.
  RawCall call(channel(), kReflect, "\x3a\x01*");
  const std::string answer = call.first_answer();
  for (const char* service : {"diaphane.v1.SceneService", "diaphane.v1.RenderService", "diaphane.v1.ServerService"}) {
    EXPECT_THAT(answer, HasSubstr(service));
  }
}

TEST_F(ProtocolsTest, SurvivesBytesThatAreNoMessage) {
  for (const char* method : {"/diaphane.v1.SceneService/CreateScene", "/diaphane.v1.SceneService/UploadMesh",
                             "/diaphane.v1.RenderService/RenderFrame"}) {
    RawCall call(channel(), method, "\xff\xff\xff\xff");
    EXPECT_FALSE(call.status().ok()) << method;
  }
  EXPECT_EQ(create_scene().revision(), 1u);
}

TEST_F(ProtocolsTest, RefusesTextThatIsNotUtf8) {
  // CreateSceneRequest.scene.display_name of one byte.
  RawCall call(channel(), "/diaphane.v1.SceneService/CreateScene", "\x0a\x03\x12\x01\xff");
  EXPECT_FALSE(call.status().ok());
}

TEST_F(ProtocolsTest, StopsAtTheDrainsEndWithAWatcherConnected) {
  RawCall watch(channel(), kWatch, health_of(""));
  ASSERT_EQ(watch.first_answer(), kServing);
  server_->stop(absl::Milliseconds(10));
  EXPECT_FALSE(watch.status().ok());
}

}  // namespace
}  // namespace diaphane::e2e
