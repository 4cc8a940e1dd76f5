#include "tests/support/relay.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <system_error>

namespace diaphane::testing {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

const sockaddr* as_address(const sockaddr_in& address) { return reinterpret_cast<const sockaddr*>(&address); }

int listen_on_any_port() {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(0);
  if (listener < 0 || bind(listener, as_address(address), sizeof address) != 0 || listen(listener, 16) != 0) {
    fail("relay: listen");
  }
  return listener;
}

/// Carries bytes, and counts them, until either side ends, and then ends both.
void carry(int from, int to, const std::atomic<bool>* muted, std::atomic<uint64_t>& count) {
  std::array<char, 1 << 14> bytes;
  while (true) {
    const ssize_t got = read(from, bytes.data(), bytes.size());
    if (got <= 0) break;
    count += static_cast<uint64_t>(got);
    ssize_t sent = muted != nullptr && *muted ? got : 0;
    while (sent < got) {
      const ssize_t more = send(to, bytes.data() + sent, static_cast<size_t>(got - sent), MSG_NOSIGNAL);
      if (more <= 0) break;
      sent += more;
    }
    if (sent < got) break;
  }
  shutdown(from, SHUT_RDWR);
  shutdown(to, SHUT_RDWR);
}

}  // namespace

Relay::Relay(const std::string& server)
    : port_(std::stoi(server.substr(server.rfind(':') + 1))),
      listener_(listen_on_any_port()),
      acceptor_([this] { accept_all(); }) {}

Relay::~Relay() {
  shutdown(listener_, SHUT_RDWR);
  acceptor_.join();
  close(listener_);
  cut();
  for (const auto& connection : connections_) {
    connection->there.join();
    connection->back.join();
    close(connection->client);
    close(connection->server);
  }
}

std::string Relay::address() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) fail("relay: getsockname");
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

void Relay::mute() {
  const std::lock_guard lock(mutex_);
  for (const auto& connection : connections_) connection->muted = true;
}

void Relay::cut() {
  const std::lock_guard lock(mutex_);
  for (const auto& connection : connections_) {
    shutdown(connection->client, SHUT_RDWR);
    shutdown(connection->server, SHUT_RDWR);
  }
}

void Relay::accept_all() {
  while (true) {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    auto connection = std::make_unique<Connection>();
    connection->client = client;
    connection->server = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    // Bytes go on as they come.
    const int on = 1;
    for (const int end : {connection->client, connection->server}) {
      setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    const sockaddr_in address = loopback(port_);
    // A server that is not there: both threads end at once.
    if (connect(connection->server, as_address(address), sizeof address) != 0) shutdown(client, SHUT_RDWR);
    Connection* c = connection.get();
    c->there = std::thread([this, c] { carry(c->client, c->server, nullptr, bytes_there_); });
    c->back = std::thread([c] {
      std::atomic<uint64_t> bytes_back = 0;
      carry(c->server, c->client, &c->muted, bytes_back);
    });
    const std::lock_guard lock(mutex_);
    connections_.push_back(std::move(connection));
  }
}

}  // namespace diaphane::testing
