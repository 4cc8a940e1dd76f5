#include "diaphane/client.h"

#include <utility>

#include "connection.h"
#include "convert.h"
#include "fmt/format.h"

namespace diaphane {
namespace {

using internal::Connection;
using internal::SceneStub;

constexpr std::string_view kScenePrefix = "scenes/";

absl::StatusOr<ServerInfo> server_info(Connection& connection, const internal::RetryPolicy& policy) {
  v1::ServerInfo response;
  const absl::Status status = internal::run_with_retries(policy, [&](grpc::ClientContext& context) {
    return connection.server_service()->GetServerInfo(&context, {}, &response);
  });
  if (!status.ok()) return status;
  return internal::from_proto(response);
}

}  // namespace

Client::Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}

absl::StatusOr<Client> Client::connect(std::string_view address, const ClientOptions& options) {
  if (absl::Status status = Connection::check_address(address); !status.ok()) return status;
  auto connection = std::make_shared<Connection>(std::string(address), options);
  const absl::StatusOr<ServerInfo> info =
      server_info(*connection, {options.connect_timeout, options.connect_timeout, options.stop});
  if (info.ok()) return Client(std::move(connection));

  const std::string detail(info.status().message());
  switch (info.status().code()) {
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return absl::UnavailableError(fmt::format("server {}: no answer within {} s: {}", address,
                                                options.connect_timeout.count() / 1000.0, detail));
    case absl::StatusCode::kUnimplemented:
      return absl::FailedPreconditionError(fmt::format("server {}: not a Diaphane server: {}", address, detail));
    default:
      return absl::Status(info.status().code(), fmt::format("server {}: {}", address, detail));
  }
}

absl::StatusOr<ServerInfo> Client::info() const {
  const ClientOptions& options = connection_->options();
  return server_info(*connection_, {options.call_timeout, options.connect_timeout, options.stop});
}

absl::StatusOr<std::vector<MaterialPreset>> Client::material_presets() const {
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::ListMaterialPresets, {});
  if (!response.ok()) return response.status();
  std::vector<MaterialPreset> presets;
  for (const v1::MaterialPreset& preset : response->presets()) presets.push_back(internal::from_proto(preset));
  return presets;
}

absl::StatusOr<Scene> Client::create_scene(const SceneOptions& options) const {
  v1::CreateSceneRequest request;
  request.mutable_scene()->set_display_name(options.display_name);
  request.mutable_scene()->set_millimetres_per_unit(options.millimetres_per_unit);
  request.set_request_id(internal::new_request_id());
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::CreateScene, request);
  if (!response.ok()) return response.status();
  return Scene(connection_, response->name());
}

absl::StatusOr<std::vector<SceneInfo>> Client::scenes() const {
  std::vector<SceneInfo> scenes;
  v1::ListScenesRequest request;
  do {
    const auto response = connection_->call(connection_->scene_service(), &SceneStub::ListScenes, request);
    if (!response.ok()) return response.status();
    for (const v1::Scene& scene : response->scenes()) scenes.push_back(internal::from_proto(scene));
    request.set_page_token(response->next_page_token());
  } while (!request.page_token().empty());
  return scenes;
}

absl::StatusOr<Scene> Client::open_scene(std::string_view name) const {
  const std::string_view id = name.starts_with(kScenePrefix) ? name.substr(kScenePrefix.size()) : name;
  if (id.empty() || id.find('/') != std::string_view::npos) {
    return absl::InvalidArgumentError(fmt::format("scene: must be scenes/{{scene}} or {{scene}}, got '{}'", name));
  }
  v1::GetSceneRequest request;
  request.set_name(fmt::format("{}{}", kScenePrefix, id));
  const auto response = connection_->call(connection_->scene_service(), &SceneStub::GetScene, request);
  if (!response.ok()) return response.status();
  return Scene(connection_, response->name());
}

}  // namespace diaphane
