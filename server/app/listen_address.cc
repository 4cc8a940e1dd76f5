#include "app/listen_address.h"

#include <arpa/inet.h>
#include <sys/un.h>

#include <charconv>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::app {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr size_t kLongestUnixPath = sizeof(sockaddr_un::sun_path) - 1;

bool parse_port(std::string_view text, int& port) {
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), port);
  return parsed.ec == std::errc() && parsed.ptr == text.data() + text.size() && port >= 0 && port <= 65535;
}

}  // namespace

bool ListenAddress::is_local() const {
  if (!unix_path.empty() || host == "localhost") return true;
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

std::string ListenAddress::text() const {
  if (!unix_path.empty()) return fmt::format("{}{}", kUnix, unix_path);
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

absl::StatusOr<ListenAddress> parse_listen_address(std::string_view text) {
  ListenAddress address;
  if (text.starts_with(kUnix)) {
    address.unix_path = text.substr(kUnix.size());
    if (!address.unix_path.empty() && address.unix_path.size() <= kLongestUnixPath) return address;
    return base::invalid_field("--listen", fmt::format("unix:PATH with a path of 1..{} bytes", kLongestUnixPath), text);
  }
  const absl::Status refused = base::invalid_field("--listen", "HOST:PORT, [IPV6]:PORT or unix:PATH", text);
  const size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || !parse_port(text.substr(colon + 1), address.port)) return refused;
  std::string_view host = text.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (host.empty() || (host.find(':') != std::string_view::npos) != bracketed) return refused;
  address.host = host;
  return address;
}

}  // namespace diaphane::app
