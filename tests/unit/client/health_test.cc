#include <gmock/gmock.h>

#include "diaphane/client.h"
#include "fake_server.h"
#include "grpcpp/grpcpp.h"
#include "grpcpp/health_check_service_interface.h"

namespace diaphane {
namespace {

using testing::HasSubstr;

class HealthTest : public testing::Test {
 protected:
  void start(bool with_health) {
    grpc::EnableDefaultHealthCheckService(with_health);
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&scenes_);  // gRPC starts no server without one
    server_ = builder.BuildAndStart();
    address_ = "127.0.0.1:" + std::to_string(port);
  }

  testing_support::FakeScenes scenes_;
  std::unique_ptr<grpc::Server> server_;
  std::string address_;
};

TEST_F(HealthTest, IsOkWhileTheServerServes) {
  start(true);
  EXPECT_EQ(check_health(address_), absl::OkStatus());
}

TEST_F(HealthTest, TellsThatTheServerDoesNotServe) {
  start(true);
  server_->GetHealthCheckService()->SetServingStatus(false);
  const absl::Status status = check_health(address_);
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("does not serve"));
}

TEST_F(HealthTest, TellsThatTheServerHasNoHealth) {
  start(false);
  EXPECT_EQ(check_health(address_).code(), absl::StatusCode::kFailedPrecondition);
}

TEST_F(HealthTest, TellsThatNothingAnswers) {
  const absl::Status status = check_health("unix:/nowhere/server", {.connect_timeout = std::chrono::milliseconds(200)});
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("/nowhere/server"));
}

TEST_F(HealthTest, RefusesWhatIsNoAddress) {
  EXPECT_EQ(check_health("nowhere").code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace diaphane
