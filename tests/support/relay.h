// A way to a server that can be cut.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace diaphane::testing {

/// Listens on loopback and carries bytes to another port there and back. Thread-safe.
class Relay {
 public:
  /// To an address such as 127.0.0.1:2011.
  explicit Relay(const std::string& server);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  std::string address() const;

  /// Carried to the server so far.
  uint64_t bytes_there() const { return bytes_there_; }

  /// Lets nothing more come back over the connections that are open.
  void mute();

  /// Breaks the connections that are open; new ones are taken.
  void cut();

 private:
  struct Connection {
    int client = -1, server = -1;
    std::atomic<bool> muted{false};
    std::thread there, back;
  };

  void accept_all();

  const int port_;
  const int listener_;
  std::atomic<uint64_t> bytes_there_ = 0;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Connection>> connections_;
  std::thread acceptor_;
};

}  // namespace diaphane::testing
