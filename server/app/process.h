// What a server asks of its process.
#pragma once

namespace diaphane::app {

/// As many open files as the system allows: a gRPC listener that ran out of them does not come back.
void raise_file_limit();

/// Keeps memory that was freed for what is next: a frame's pixels and a mesh's positions are megabytes that come and go
/// thirty times a second, and pages that were given back must be cleared anew. Holds up to 256 MiB more than is in use.
void keep_freed_memory();

/// Sends what gRPC and protobuf print by themselves to the log. Protobuf's goes to debug: a client's bytes can cause
/// it.
void log_library_messages();

}  // namespace diaphane::app
