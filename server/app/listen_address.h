#pragma once

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace diaphane::app {

/// Where a server listens.
struct ListenAddress {
  std::string unix_path;  ///< not empty: a Unix socket, and nothing below counts
  std::string host;       ///< a name or a number; IPv6 without brackets
  int port = 0;           ///< 0: any that is free

  /// Only this machine can connect: a Unix socket, 127.0.0.0/8, ::1 or localhost.
  bool is_local() const;

  /// unix:PATH, HOST:PORT or [HOST]:PORT, which is also gRPC's form.
  std::string text() const;
};

/// INVALID_ARGUMENT unless `text` is HOST:PORT, [IPV6]:PORT or unix:PATH with a path of at most 107 bytes.
absl::StatusOr<ListenAddress> parse_listen_address(std::string_view text);

}  // namespace diaphane::app
