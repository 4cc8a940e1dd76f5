// The options that every command has.
#pragma once

#include <stop_token>
#include <string>

namespace diaphane::cli {

struct GlobalOptions {
  std::string server;    ///< empty: a private one
  bool json = false;     ///< machine-readable data on stdout
  bool verbose = false;  ///< more on stderr, a private server's log included
  std::stop_token stop;  ///< requested by Ctrl-C
};

}  // namespace diaphane::cli
