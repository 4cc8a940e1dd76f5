#include "session.h"

#include <string>
#include <utility>

#include "status.h"

namespace diaphane::cli {

absl::StatusOr<Session> open_session(const GlobalOptions& options) {
  const ClientOptions client_options{.stop = options.stop};
  if (!options.server.empty()) {
    absl::StatusOr<Client> client = Client::connect(options.server, client_options);
    if (client.ok()) return Session{std::nullopt, *std::move(client)};
    if (!absl::IsInvalidArgument(client.status())) return with_exit_code(client.status(), kExitUnavailable);
    return usage_error("--server", std::string(client.status().message()));
  }
  absl::StatusOr<PrivateServer> server = PrivateServer::start({.verbose = options.verbose, .stop = options.stop});
  if (!server.ok()) return with_exit_code(server.status(), kExitUnavailable);
  absl::StatusOr<Client> client = Client::connect(server->address(), client_options);
  if (!client.ok()) return with_exit_code(client.status(), kExitUnavailable);
  return Session{*std::move(server), *std::move(client)};
}

}  // namespace diaphane::cli
