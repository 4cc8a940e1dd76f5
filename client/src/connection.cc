#include "connection.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <random>

#include "fmt/format.h"
#include "grpcpp/create_channel.h"
#include "grpcpp/security/credentials.h"
#include "grpcpp/support/channel_arguments.h"

namespace diaphane::internal {
namespace {

constexpr std::chrono::milliseconds kCleanUpTimeout{10'000};

grpc::ChannelArguments channel_arguments() {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);  // a frame may take gigabytes, and was asked for
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);                      // run_with_retries knows what may be repeated
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 4 << 20);  // a frame comes whole
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, 1 << 20);
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  return arguments;
}

bool is_local_address(std::string_view address) {
  constexpr std::array<std::string_view, 4> kLocal = {"unix:", "127.", "localhost:", "[::1]:"};
  return std::any_of(kLocal.begin(), kLocal.end(), [&](std::string_view local) { return address.starts_with(local); });
}

}  // namespace

absl::Status Connection::check_address(std::string_view address) {
  const auto refuse = [&] {
    return absl::InvalidArgumentError(fmt::format("server address: must be HOST:PORT or unix:PATH, got '{}'", address));
  };
  if (address.starts_with("unix:")) return address.size() > 5 ? absl::OkStatus() : refuse();
  const size_t colon = address.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return refuse();
  const std::string_view port = address.substr(colon + 1);
  uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc() || end != port.data() + port.size() || number == 0) return refuse();
  return absl::OkStatus();
}

std::shared_ptr<grpc::Channel> make_channel(const std::string& address) {
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), channel_arguments());
}

Connection::Connection(const std::string& address, ClientOptions options)
    : options_(std::move(options)), is_local_(is_local_address(address)), channel_(make_channel(address)) {
  scene_service_ = v1::SceneService::NewStub(channel_);
  render_service_ = v1::RenderService::NewStub(channel_);
  server_service_ = v1::ServerService::NewStub(channel_);
}

absl::Status Connection::run(const std::function<grpc::Status(grpc::ClientContext&)>& attempt) const {
  return run_with_retries({options_.call_timeout, options_.connect_timeout, options_.stop}, attempt);
}

absl::Status Connection::run_to_the_end(const std::function<grpc::Status(grpc::ClientContext&)>& attempt) const {
  const auto call_timeout = std::min(options_.call_timeout, kCleanUpTimeout);
  return run_with_retries({call_timeout, std::min(options_.connect_timeout, call_timeout), {}}, attempt);
}

std::string new_request_id() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", random(), random(), random(), random());
}

}  // namespace diaphane::internal
