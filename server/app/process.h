// What a server asks of its process.
#pragma once

namespace diaphane::app {

/// As many open files as the system allows: a gRPC listener that ran out of them does not come back.
void raise_file_limit();

/// Sends what gRPC and protobuf print by themselves to the log. Protobuf's goes to debug: a client's bytes can cause
/// it.
void log_library_messages();

}  // namespace diaphane::app
