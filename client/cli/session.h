// A server to talk to: the one that was asked for, or a private one.
#pragma once

#include <optional>

#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "diaphane/private_server.h"
#include "global_options.h"

namespace diaphane::cli {

/// A private server ends with this object.
struct Session {
  std::optional<PrivateServer> server;
  Client client;
};

/// Connects to options.server, or starts a private server and connects to that. Errors: kExitUsage for an address that
/// is none; kExitUnavailable when no server could be had.
absl::StatusOr<Session> open_session(const GlobalOptions& options);

}  // namespace diaphane::cli
