// What a server asks of its process.
#pragma once

namespace diaphane::app {

/// As many open files as the system allows: a gRPC listener that ran out of them does not come back.
void raise_file_limit();

/// Sends gRPC's own messages to the log.
void log_grpc_messages();

}  // namespace diaphane::app
