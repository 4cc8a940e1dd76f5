// grpc.health.v1 without its generated code: whoever links this library may have that code already, and twice is once
// too often for protobuf.
#include <future>

#include "connection.h"
#include "diaphane/client.h"
#include "fmt/format.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/support/byte_buffer.h"

namespace diaphane {
namespace {

constexpr char kCheck[] = "/grpc.health.v1.Health/Check";
// HealthCheckResponse{status: SERVING}
constexpr std::string_view kServing("\x08\x01", 2);

grpc::Status check(grpc::GenericStub& stub, grpc::ClientContext& context, grpc::ByteBuffer& answer) {
  const grpc::ByteBuffer all_services(nullptr, 0);
  std::promise<grpc::Status> status;
  stub.UnaryCall(&context, kCheck, {}, &all_services, &answer,
                 [&status](grpc::Status result) { status.set_value(std::move(result)); });
  return status.get_future().get();
}

}  // namespace

absl::Status check_health(std::string_view address, const ClientOptions& options) {
  if (absl::Status status = internal::Connection::check_address(address); !status.ok()) return status;
  grpc::GenericStub stub(internal::make_channel(std::string(address)));
  grpc::ByteBuffer answer;
  const absl::Status status =
      internal::run_with_retries({options.connect_timeout, options.connect_timeout, options.stop},
                                 [&](grpc::ClientContext& context) { return check(stub, context, answer); });
  if (absl::IsUnimplemented(status)) {
    return absl::FailedPreconditionError(fmt::format("server {}: tells no health", address));
  }
  if (!status.ok()) {
    return absl::Status(status.code(), fmt::format("server {}: {}", address, std::string(status.message())));
  }
  grpc::Slice bytes;
  if (answer.DumpToSingleSlice(&bytes).ok() &&
      std::string_view(reinterpret_cast<const char*>(bytes.begin()), bytes.size()) == kServing) {
    return absl::OkStatus();
  }
  return absl::UnavailableError(fmt::format("server {}: does not serve now", address));
}

}  // namespace diaphane
